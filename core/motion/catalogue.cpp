#include <type_traits>

#include "core/motion/machine.hpp"

namespace tubecut::motion {
namespace {

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

Machine crawler() {
  return {.name = "crawler",
          .kinematics = Crawler{.wheel_offset = 60.0,
                                .swing_center = SwingCenter::pivot,
                                .pivot_length = 20.0,
                                .standoff_max = 10.0},
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

/// The source whose machine has these axes; empty where the type is our own.
std::string source_of(const Machine& machine) {
  struct Of {
    std::string operator()(const FiveAxisCutter&) const { return "source 000, section 2.2"; }
    std::string operator()(const Crawler&) const { return "source 002"; }
    std::string operator()(const ConeMill&) const { return "source 001"; }
    std::string operator()(const Generic&) const { return {}; }
  };
  return std::visit(Of{}, machine.kinematics);
}

std::vector<std::string> kinematic_members(const Machine& machine) {
  struct Of {
    std::vector<std::string> operator()(const FiveAxisCutter&) const {
      return {"pivot_length", "standoff", "z2_share"};
    }
    std::vector<std::string> operator()(const Crawler&) const {
      return {"wheel_offset", "swing_center", "pivot_length", "standoff_max"};
    }
    std::vector<std::string> operator()(const ConeMill&) const { return {}; }
    std::vector<std::string> operator()(const Generic&) const { return {"maps"}; }
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

std::vector<CatalogueEntry> catalogue() {
  return {entry(five_axis_cutter()), entry(crawler()), entry(cone_mill()), entry(generic())};
}

}  // namespace tubecut::motion
