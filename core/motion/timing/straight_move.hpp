#pragma once

#include <optional>
#include <vector>

#include "core/motion/machine/machine.hpp"

namespace tubecut::motion {

/// Moves from rest to rest along 0..1 under limits of speed, acceleration and jerk: three moving
/// averages of a step, one after the other, the widest at least as wide as both others.
class SCurve {
 public:
  /// Returns the fastest curve. Limits per second of the whole path; without a jerk limit the
  /// acceleration jumps.
  static SCurve fastest(double speed, double acceleration, std::optional<double> jerk);

  [[nodiscard]] double time() const { return cruise_ + rise_ + jerk_; }  // s
  /// Returns the fraction of the path after `t` seconds.
  [[nodiscard]] double at(double t) const;

 private:
  SCurve(double cruise, double rise, double jerk) : cruise_(cruise), rise_(rise), jerk_(jerk) {}
  [[nodiscard]] double first_half(double t) const;

  double cruise_, rise_, jerk_;  // s: widths of the averages, path / v, v / a, a / j
};

/// All axes straight from one place to another at once, each from rest to rest.
struct StraightMove {
  std::vector<double> from = {};  // in the axes' units and order
  std::vector<double> to = {};
  double length = 0.0;  // mm of tip path, if its speed is limited
  double speed = 0.0;   // mm/s, of the tip; 0: as fast as the axes can
};

/// Computes the motion of a move under its axes' limits and the tip's; empty when no axis moves.
///
/// Accuracy  every limit holds along the whole move, so between any of its samples.
/// Source    docs/theory/pulse-schedules.md, section 11.
[[nodiscard]] std::optional<SCurve> timed(const StraightMove& move, const Machine& machine,
                                          bool jerk);

}  // namespace tubecut::motion
