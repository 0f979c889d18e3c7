#pragma once

#include <array>
#include <vector>

#include "core/motion/machine/kinematics.hpp"
#include "core/motion/path/path.hpp"
#include "core/motion/timing/profile.hpp"
#include "core/motion/timing/speed.hpp"

namespace tubecut::motion {

/// An axis' derivatives where intervals meet.
struct SignedDerivatives {
  std::vector<double> first = {};   // q' at the knots
  std::vector<double> second = {};  // q'' at the knots
  std::vector<double> third = {};   // q''' at the start of every interval
  bool linear = true;               // in the coordinates: q' is a quadratic on every interval
};

/// Bounds of an axis' derivatives over every interval: |q'|, |q''|, |q'''| per mm, mm2, mm3 of u.
struct AxisBounds {
  std::size_t axis = 0;  // of the machine
  std::vector<double> first = {};
  std::vector<double> second = {};
  std::vector<double> third = {};
  double v_max = 0.0;  // after the overflow cap
  double a_max = 0.0;
  double j_max = 0.0;  // 0: no jerk limit
  SignedDerivatives along = {};
};

/// All data of a path on a machine for the timing.
struct PathLimits {
  double d = 0.1;
  std::vector<AxisBounds> axes = {};  // moving axes only
  /// Per interval: tip path per mm of u over the requested speed, s/mm.
  std::vector<double> slowness = {};
  /// The same at an interval's start, as inner Bezier value and at its end.
  std::vector<std::array<double, 3>> slowness_along = {};

  [[nodiscard]] std::size_t intervals() const { return slowness.size(); }
};

/// Accuracy  exact for axes linear in the coordinates; else sampled at three points of each
///           interval with 0.1 % margin, and the last check covers the rest.
/// Source    docs/theory/pulse-schedules.md, sections 5.1 and 5.2.
[[nodiscard]] PathLimits path_limits(const Path& path, const std::vector<AxisFunction>& axes,
                                     const std::vector<AxisFunction>& tip, const SpeedAlong& speed,
                                     const Machine& machine);

/// Caps at the knots and rows of acceleration, without jerk; zero at both ends.
struct Conditions {
  std::vector<double> caps = {};
  Rows rows = {};
};
[[nodiscard]] Conditions without_jerk(const PathLimits& limits);

/// Computes caps of x at the knots from the speeds of axes and tip, on whole intervals; zero at
/// both ends.
///
/// Accuracy  as `limits`.
[[nodiscard]] std::vector<double> speed_caps(const PathLimits& limits);

/// Computes the rows |q' u_ddot + q'' x| <= a_max of every axis on whole intervals, with signs. If
/// u_ddot is constant, it is a quadratic along the interval, so its three Bezier values bound it.
///
/// Accuracy  exact for axes linear in the coordinates; else with 0.1 % margin.
/// Source    docs/theory/pulse-schedules.md, section 6.2.
[[nodiscard]] HalfPlanes acceleration_rows(const PathLimits& limits);

}  // namespace tubecut::motion
