#include "core/motion/machine/machine.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace tubecut::motion {
namespace {

using Names = std::vector<std::string_view>;

struct AxisNames {
  Names required = {}, optional = {};
};

AxisNames axis_names(const Machine& machine) {
  struct Of {
    AxisNames operator()(const FiveAxisCutter&) const { return {{"C", "Y", "Z1", "B"}, {"Z2"}}; }
    AxisNames operator()(const Crawler&) const { return {{"S", "E", "B"}}; }
    AxisNames operator()(const ConeMill&) const { return {{"C", "X", "Z", "B"}}; }
    AxisNames operator()(const Generic&) const { return {}; }
    AxisNames operator()(const TubeTable&) const { return {{"A", "X", "Y", "Z"}, {"B"}}; }
  };
  return std::visit(Of{}, machine.kinematics);
}

class Findings {
 public:
  void add(ErrorCode code, std::string member, Shown got = {}, Shown limit = {},
           std::string hint = {}) {
    issues_.push_back({code,
                       "machine/" + std::move(member),
                       std::move(got),
                       std::move(limit),
                       {},
                       std::move(hint)});
  }
  void positive(const std::string& member, double value) {
    if (!std::isfinite(value)) return add(ErrorCode::bad_number, member);
    if (value == 0.0) return add(ErrorCode::zero_limit, member, value);
    if (value < 0.0) add(ErrorCode::out_of_range, member, value, 0.0);
  }
  void within(const std::string& member, double value, double least, double most) {
    if (!std::isfinite(value)) return add(ErrorCode::bad_number, member);
    if (value < least) add(ErrorCode::out_of_range, member, value, least);
    if (value > most) add(ErrorCode::out_of_range, member, value, most);
  }
  [[nodiscard]] Result<void> result() { return no_issues(std::move(issues_)); }

 private:
  std::vector<Issue> issues_;
};

constexpr double kMaxLength = 1e6;  // mm; a longer value is a unit error

void check_axis(const Axis& axis, const std::string& at, Findings& found) {
  if (axis.name.empty()) found.add(ErrorCode::bad_text, at + "/name");
  if (axis.pulses_per_turn < 0) found.add(ErrorCode::out_of_range, at + "/pulses_per_turn");
  if (axis.pulses_per_turn == 0) found.positive(at + "/pulses_per_unit", axis.pulses_per_unit);
  if (axis.pulses_per_turn != 0 && axis.pulses_per_unit != 0.0) {
    found.add(ErrorCode::exclusive_fields, at + "/pulses_per_unit");
  }
  if (axis.pulses_per_turn != 0 && axis.unit != AxisUnit::deg) {
    found.add(ErrorCode::unsupported_combination, at + "/pulses_per_turn");
  }
  found.positive(at + "/v_max", axis.v_max);
  found.positive(at + "/a_max", axis.a_max);
  if (axis.j_max) found.positive(at + "/j_max", *axis.j_max);
  if (axis.n_max) found.positive(at + "/n_max", static_cast<double>(*axis.n_max));
  if (axis.soft_min) found.within(at + "/soft_min", *axis.soft_min, -kMaxLength, kMaxLength);
  if (axis.soft_max) found.within(at + "/soft_max", *axis.soft_max, -kMaxLength, kMaxLength);
}

void check_names(const Machine& machine, Findings& found) {
  const auto [required, optional] = axis_names(machine);
  const auto named = [&](std::string_view name) {
    return std::count_if(machine.axes.begin(), machine.axes.end(),
                         [&](const Axis& axis) { return axis.name == name; });
  };
  for (const auto name : required) {
    if (named(name) == 0) {
      found.add(ErrorCode::wrong_count, "axes", {}, {},
                "axis " + std::string(name) + " is missing");
    }
  }
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const std::string& name = machine.axes[a].name;
    const std::string at = "axes/" + std::to_string(a) + "/name";
    if (named(name) > 1) found.add(ErrorCode::wrong_count, at, name, {}, "duplicate name");
    const bool known = required.empty() || std::ranges::count(required, name) > 0 ||
                       std::ranges::count(optional, name) > 0;
    if (!known) found.add(ErrorCode::bad_choice, at, name);
  }
}

struct KinematicsCheck {
  const Machine& machine;
  Findings& found;

  void operator()(const FiveAxisCutter& cutter) const {
    found.within("pivot_length", cutter.pivot_length, 0.0, kMaxLength);
    found.within("standoff", cutter.standoff, 0.0, kMaxLength);
    found.within("z2_share", cutter.z2_share, 0.0, 1.0);
    const bool has_z2 = std::ranges::count(machine.axes, "Z2", &Axis::name) > 0;
    if (cutter.z2_share > 0.0 && !has_z2) {
      found.add(ErrorCode::unsupported_combination, "z2_share", cutter.z2_share, {}, "no axis Z2");
    }
  }
  void operator()(const Crawler& crawler) const {
    found.within("wheel_offset", crawler.wheel_offset, 0.0, kMaxLength);
    found.within("pivot_length", crawler.pivot_length, 0.0, kMaxLength);
    if (crawler.standoff_max) found.within("standoff_max", *crawler.standoff_max, 0.0, kMaxLength);
  }
  void operator()(const ConeMill&) const {}
  void operator()(const TubeTable& table) const {
    found.within("pivot_length", table.pivot_length, 0.0, kMaxLength);
    found.within("standoff", table.standoff, 0.0, kMaxLength);
  }
  void operator()(const Generic& generic) const {
    if (!generic.maps.empty() && generic.maps.size() != machine.axes.size()) {
      found.add(ErrorCode::wrong_count, "maps", static_cast<double>(generic.maps.size()),
                static_cast<double>(machine.axes.size()));
    }
    for (const LinearMap& map : generic.maps) {
      for (const double k : {map.k_phi, map.k_z, map.k_b, map.k_0}) {
        found.within("maps", k, -kMaxLength, kMaxLength);
      }
    }
  }
};

constexpr std::int64_t kMostPulses = 800;  // 200 kHz at 4 ms

Axis rotary(std::string name, std::int64_t per_turn, double v, double a, double j) {
  return {.name = std::move(name),
          .unit = AxisUnit::deg,
          .pulses_per_turn = per_turn,
          .v_max = v,
          .a_max = a,
          .j_max = j,
          .n_max = kMostPulses};
}

Axis counted(std::string name, AxisUnit unit, double v, double a, double j) {
  return {.name = std::move(name),
          .unit = unit,
          .pulses_per_unit = 1000.0,
          .v_max = v,
          .a_max = a,
          .j_max = j,
          .n_max = kMostPulses};
}

Axis swing() {
  Axis axis = counted("B", AxisUnit::deg, 45, 300, 6000);
  axis.soft_min = -80.0;
  axis.soft_max = 80.0;
  return axis;
}

Axis slide(std::string name, double v, double a, double j) {
  return counted(std::move(name), AxisUnit::mm, v, a, j);
}

Machine five_axis_cutter() {
  return {.name = "five_axis_cutter",
          .kinematics = FiveAxisCutter{.pivot_length = 150.0},
          .axes = {rotary("C", 360000, 60, 300, 6000), slide("Y", 200, 1000, 20000),
                   slide("Z1", 100, 800, 16000), slide("Z2", 20, 200, 4000), swing()}};
}

/// Without an axis for the torch's height, the standoff is kept at a B that varies by 60 deg only
/// if the torch swings about the point that it cuts, as on the source's own pair.
Machine crawler() {
  return {.name = "crawler",
          .kinematics = Crawler{.wheel_offset = 60.0, .swing_center = SwingCenter::remote},
          .axes = {slide("S", 50, 200, 4000), slide("E", 100, 500, 10000), swing()}};
}

Machine cone_mill() {
  return {.name = "cone_mill",
          .kinematics = ConeMill{},
          .axes = {rotary("C", 360000, 60, 300, 6000), slide("X", 100, 500, 10000),
                   slide("Z", 100, 500, 10000), counted("B", AxisUnit::deg, 45, 300, 6000)}};
}

Machine generic() {
  return {.name = "generic",
          .kinematics = Generic{.maps = {{.k_phi = 1.0}, {.k_z = 1.0}, {.k_b = 1.0}}},
          .axes = {rotary("C", 360000, 60, 300, 6000), slide("Z", 200, 1000, 20000), swing()}};
}

/// Without a swing: it cuts square. The turn of such tables is fast, because a corner of a tube
/// that is not round takes a quarter of a turn.
Machine tube_table() {
  return {.name = "tube_table",
          .kinematics = TubeTable{.standoff = 1.0},
          .axes = {rotary("A", 360000, 180, 1800, 90000), slide("X", 200, 2000, 100000),
                   slide("Y", 200, 2000, 100000), slide("Z", 200, 2000, 100000)}};
}

/// Returns the source whose machine has these axes; empty when the type is our own.
std::string source_of(const Machine& machine) {
  struct Of {
    std::string operator()(const FiveAxisCutter&) const { return "source 000, section 2.2"; }
    std::string operator()(const Crawler&) const { return "source 002"; }
    std::string operator()(const ConeMill&) const { return "source 001"; }
    std::string operator()(const Generic&) const { return {}; }
    std::string operator()(const TubeTable&) const { return {}; }
  };
  return std::visit(Of{}, machine.kinematics);
}

std::vector<std::string> kinematic_members(const Machine& machine) {
  struct Of {
    std::vector<std::string> operator()(const FiveAxisCutter&) const {
      return {"pivot_length", "standoff", "z2_share"};
    }
    std::vector<std::string> operator()(const Crawler&) const {
      return {"wheel_offset", "swing_center"};
    }
    std::vector<std::string> operator()(const ConeMill&) const { return {}; }
    std::vector<std::string> operator()(const Generic&) const { return {"maps"}; }
    std::vector<std::string> operator()(const TubeTable&) const {
      return {"pivot_length", "standoff"};
    }
  };
  return std::visit(Of{}, machine.kinematics);
}

void mark_axis(const Axis& axis, const std::string& at, const std::string& source,
               std::vector<Provenance>& values) {
  values.push_back({at + "/name", source.empty(), source});
  values.push_back({at + "/unit", true, {}});
  values.push_back(
      {at + (axis.pulses_per_turn > 0 ? "/pulses_per_turn" : "/pulses_per_unit"), true, {}});
  for (const char* const member : {"/v_max", "/a_max", "/j_max", "/n_max"}) {
    values.push_back({at + member, true, {}});
  }
  if (axis.soft_min) values.push_back({at + "/soft_min", true, {}});
  if (axis.soft_max) values.push_back({at + "/soft_max", true, {}});
}

CatalogueEntry entry(Machine machine) {
  const std::string source = source_of(machine);
  std::vector<Provenance> values{
      {"type", source.empty(), source}, {"period", true, {}}, {"b_positive", true, {}}};
  for (const std::string& member : kinematic_members(machine)) {
    values.push_back({member, true, {}});
  }
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    mark_axis(machine.axes[a], "axes/" + std::to_string(a), source, values);
  }
  return {std::move(machine), std::move(values)};
}

}  // namespace

std::string_view type_name(const Machine& machine) {
  return std::visit([]<class Kind>(const Kind&) { return Kind::kName; }, machine.kinematics);
}

std::optional<Lift> lift_of(const Machine& machine) {
  if (const auto* const cutter = std::get_if<FiveAxisCutter>(&machine.kinematics))
    return Lift{"Z1", "Z2", cutter->pivot_length, cutter->standoff};
  if (const auto* const table = std::get_if<TubeTable>(&machine.kinematics))
    return Lift{"Z", "", table->pivot_length, table->standoff};
  return std::nullopt;
}

void set_standoff(Machine& machine, double standoff) {
  if (auto* const cutter = std::get_if<FiveAxisCutter>(&machine.kinematics))
    cutter->standoff = standoff;
  if (auto* const table = std::get_if<TubeTable>(&machine.kinematics)) table->standoff = standoff;
}

bool crosses(const Machine& machine) {
  return std::holds_alternative<TubeTable>(machine.kinematics);
}

Result<void> check(const Machine& machine) {
  Findings found;
  found.within("period", machine.period, 1e-5, 1.0);
  if (machine.axes.empty() || machine.axes.size() > 8) {
    found.add(ErrorCode::wrong_count, "axes", static_cast<double>(machine.axes.size()), 8.0);
  }
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    check_axis(machine.axes[a], "axes/" + std::to_string(a), found);
  }
  check_names(machine, found);
  std::visit(KinematicsCheck{machine, found}, machine.kinematics);
  return found.result();
}

double velocity_limit(const Axis& axis, double period) {
  if (!axis.n_max) return axis.v_max;
  const double overflow = static_cast<double>(*axis.n_max) / (axis.pulses_per_axis_unit() * period);
  return std::min(axis.v_max, overflow);
}

std::vector<CatalogueEntry> catalogue() {
  return {entry(five_axis_cutter()), entry(crawler()), entry(cone_mill()), entry(generic()),
          entry(tube_table())};
}

}  // namespace tubecut::motion
