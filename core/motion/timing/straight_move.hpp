#pragma once

#include <optional>
#include <vector>

#include "core/motion/machine/machine.hpp"

namespace tubecut::motion {

/// From rest to rest along 0..1 under limits of speed, acceleration and jerk: three means of a
/// step, one over the other, the widest at least as wide as both others.
class SCurve {
 public:
  /// The fastest. Limits per second of the whole way; without one of jerk the acceleration jumps.
  static SCurve fastest(double speed, double acceleration, std::optional<double> jerk);

  [[nodiscard]] double time() const { return cruise_ + rise_ + jerk_; }  // s
  /// Share of the way done after `t` seconds.
  [[nodiscard]] double at(double t) const;

 private:
  SCurve(double cruise, double rise, double jerk) : cruise_(cruise), rise_(rise), jerk_(jerk) {}
  [[nodiscard]] double first_half(double t) const;

  double cruise_, rise_, jerk_;  // s: widths of the means, way / v, v / a, a / j
};

/// All axes straight from one place to another at once, each from rest to rest.
struct StraightMove {
  std::vector<double> from = {};  // in the axes' units and order
  std::vector<double> to = {};
  double length = 0.0;  // mm that the tip goes, where its speed is limited
  double speed = 0.0;   // mm/s, of the tip; 0: as fast as the axes can
};

/// What a move takes under its axes' limits and the tip's; nothing where no axis moves.
///
/// Accuracy  every limit holds along the whole move, so between any of its samples.
/// Source    docs/theory/pulse-schedules.md, section 11.
[[nodiscard]] std::optional<SCurve> timed(const StraightMove& move, const Machine& machine,
                                          bool jerk);

}  // namespace tubecut::motion
