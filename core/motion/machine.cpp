#include "core/motion/machine.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tubecut::motion {
namespace {

using Names = std::vector<std::string_view>;

struct Kind {
  std::string_view type;
  Names required;
  Names optional;
};

const Kind& kind_of(const Machine& machine) {
  static const std::array<Kind, 4> kinds{{{"five_axis_cutter", {"C", "Y", "Z1", "B"}, {"Z2"}},
                                          {"crawler", {"S", "E", "B"}, {}},
                                          {"cone_mill", {"C", "X", "Z", "B"}, {}},
                                          {"generic", {}, {}}}};
  return kinds.at(machine.kinematics.index());
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
  [[nodiscard]] Result<void> result() {
    if (issues_.empty()) return {};
    return tl::unexpected<Error>(Error{std::move(issues_)});
  }

 private:
  std::vector<Issue> issues_;
};

constexpr double kMostLength = 1e6;  // mm; anything longer is a unit mistake

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
  if (axis.soft_min) found.within(at + "/soft_min", *axis.soft_min, -kMostLength, kMostLength);
  if (axis.soft_max) found.within(at + "/soft_max", *axis.soft_max, -kMostLength, kMostLength);
}

void check_names(const Machine& machine, Findings& found) {
  const Kind& kind = kind_of(machine);
  const auto named = [&](std::string_view name) {
    return std::count_if(machine.axes.begin(), machine.axes.end(),
                         [&](const Axis& axis) { return axis.name == name; });
  };
  for (const auto name : kind.required) {
    if (named(name) == 0) {
      found.add(ErrorCode::wrong_count, "axes", {}, {},
                "axis " + std::string(name) + " is missing");
    }
  }
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const std::string& name = machine.axes[a].name;
    const std::string at = "axes/" + std::to_string(a) + "/name";
    if (named(name) > 1) found.add(ErrorCode::wrong_count, at, name, {}, "the name is there twice");
    const bool known = kind.required.empty() || std::ranges::count(kind.required, name) > 0 ||
                       std::ranges::count(kind.optional, name) > 0;
    if (!known) found.add(ErrorCode::bad_choice, at, name);
  }
}

struct KinematicsCheck {
  const Machine& machine;
  Findings& found;

  void operator()(const FiveAxisCutter& cutter) const {
    found.within("pivot_length", cutter.pivot_length, 0.0, kMostLength);
    found.within("standoff", cutter.standoff, 0.0, kMostLength);
    found.within("z2_share", cutter.z2_share, 0.0, 1.0);
    const bool has_z2 = std::ranges::count(machine.axes, "Z2", &Axis::name) > 0;
    if (cutter.z2_share > 0.0 && !has_z2) {
      found.add(ErrorCode::unsupported_combination, "z2_share", cutter.z2_share, {}, "no axis Z2");
    }
  }
  void operator()(const Crawler& crawler) const {
    found.within("wheel_offset", crawler.wheel_offset, 0.0, kMostLength);
    found.within("pivot_length", crawler.pivot_length, 0.0, kMostLength);
    if (crawler.standoff_max) found.within("standoff_max", *crawler.standoff_max, 0.0, kMostLength);
  }
  void operator()(const ConeMill&) const {}
  void operator()(const Generic& generic) const {
    if (!generic.maps.empty() && generic.maps.size() != machine.axes.size()) {
      found.add(ErrorCode::wrong_count, "maps", static_cast<double>(generic.maps.size()),
                static_cast<double>(machine.axes.size()));
    }
    for (const LinearMap& map : generic.maps) {
      for (const double k : {map.k_phi, map.k_z, map.k_b, map.k_0}) {
        found.within("maps", k, -kMostLength, kMostLength);
      }
    }
  }
};

}  // namespace

std::string_view name_of(AxisUnit unit) { return unit == AxisUnit::deg ? "deg" : "mm"; }

std::string_view type_name(const Machine& machine) { return kind_of(machine).type; }

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

}  // namespace tubecut::motion
