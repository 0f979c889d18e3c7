#include "tests/core/motion/jobs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "tests/support/golden.hpp"

namespace tubecut::motion::testing {
namespace {

const api::Json& corpus() {
  static const api::Json json = tubecut::testing::golden("pulse-schedules.json");
  return json;
}

std::vector<double> radians(std::vector<double> degrees) {
  for (double& value : degrees) value *= kRadPerDeg;
  return degrees;
}

}  // namespace

Machine source_machine() {
  Machine machine = catalogue().front().machine;
  machine.b_positive = BPositive::outer_edge_to_waste;
  return machine;
}

ScheduleSpec table1(int transition_points, double speed) {
  const api::Json& columns = tubecut::testing::at(corpus(), "table1_contour");
  const std::string b = "b_deg_by_transition_points/" + std::to_string(transition_points);
  ScheduleSpec spec;
  CutPath contour;
  contour.phi = radians(tubecut::testing::numbers(columns, "phi_deg"));
  contour.z = tubecut::testing::numbers(columns, "z_mm");
  contour.b = radians(tubecut::testing::numbers(columns, b));
  contour.outer_radius = 35.0;
  spec.cut = contour;
  spec.machine = source_machine();
  spec.motion.speed = speed;
  return spec;
}

const api::Json& golden_case(std::string_view name) {
  for (std::size_t i = 0;; ++i) {
    const api::Json& entry = tubecut::testing::at(corpus(), "cases/" + std::to_string(i));
    if (tubecut::testing::text(entry, "name") == name) return entry;
  }
}

ScheduleSpec straight_line(const Axis& axis, double length, double speed, double period) {
  ScheduleSpec spec;
  CutPath contour;
  contour.phi = {0.0, 0.0, 0.0};
  contour.z = {0.0, 0.5 * length, length};
  contour.b = {0.0, 0.0, 0.0};
  contour.outer_radius = 50.0;
  contour.closed = false;
  spec.cut = contour;
  spec.machine.name = "line";
  spec.machine.kinematics = Generic{{{.k_z = 1.0}}};
  spec.machine.period = period;
  spec.machine.axes = {axis};
  spec.motion.speed = speed;
  return spec;
}

Schedule planned(const ScheduleSpec& spec) {
  auto result = schedule(spec);
  if (!result) {
    const Issue& issue = result.error().issues.front();
    ADD_FAILURE() << info(issue.code).code << " at " << issue.member << " " << issue.hint;
    return {};
  }
  return std::move(*result);
}

CutPath& contour_of(ScheduleSpec& spec) { return std::get<CutPath>(spec.cut); }

Issue refusal(const ScheduleSpec& spec) {
  const auto s = schedule(spec);
  EXPECT_FALSE(s);
  return s ? Issue{} : s.error().issues.front();
}

const AxisPulses& axis(const Schedule& schedule, std::string_view name) {
  const auto found = std::ranges::find(schedule.axes, name, &AxisPulses::name);
  if (found == schedule.axes.end()) throw std::out_of_range("no axis " + std::string(name));
  return *found;
}

}  // namespace tubecut::motion::testing
