#pragma once

#include <string>

#include "core/groove/mill.hpp"
#include "core/groove/optimise.hpp"
#include "tests/core/groove/groove_cases.hpp"

namespace tubecut::groove::testing {

inline Mill mill_case(const std::string& name) {
  const api::Json& in = at(golden_case(name), "inputs/tool");
  return {Angle::deg(number(in, "kappa_deg")), number(in, "r_tip"), number(in, "L")};
}

inline Setup setup_case(const std::string& name) {
  const api::Json& in = at(golden_case(name), "inputs/machine");
  Setup out;
  out.mount = text(in, "mount") == "end_up" ? Mount::end_up : Mount::end_down;
  out.pivot_length = number(in, "Lp");
  out.z_zero = number(in, "Z0");
  out.c_zero = Angle::deg(number(in, "C0_deg"));
  out.direction = int(number(golden_case(name), "inputs/tool/direction"));
  out.overrun = number(golden_case(name), "inputs/tool/lam0");
  return out;
}

inline Hold hold_case(const std::string& name) {
  return text(golden_case(name), "inputs/hold") == "tip" ? Hold::tip : Hold::pivot;
}

inline JointGeometry joint_case(const std::string& name) {
  return *joint_geometry(groove_case(name));
}

/// Distance of two angles in degrees on the circle.
inline double turn_difference(double a, double b) { return std::abs(std::remainder(a - b, 360.0)); }

}  // namespace tubecut::groove::testing
