#pragma once

#include <optional>
#include <vector>

namespace tubecut::cutoff {

/// Limits of the cylinder, all > 0.
struct CylinderLimits {
  double speed = 0.0;         // mm/s
  double acceleration = 0.0;  // mm/s^2
  double jerk = 0.0;          // mm/s^3
};

/// A phase of constant jerk, from its state at `start`.
struct Phase {
  double start = 0.0;         // s
  double duration = 0.0;      // s
  double stroke = 0.0;        // mm
  double speed = 0.0;         // mm/s
  double acceleration = 0.0;  // mm/s^2
  double jerk = 0.0;          // mm/s^3
};

/// Returns the phase `elapsed` seconds after its start.
[[nodiscard]] Phase after(const Phase& phase, double elapsed);

/// The shortest jerk-limited change of speed, acceleration 0 at both ends.
struct Ramp {
  double duration = 0.0;  // s
  double distance = 0.0;  // mm, mean speed times duration
};
[[nodiscard]] Ramp ramp(double from_speed, double to_speed, const CylinderLimits& limits);

/// Rest, ramp to `peak`, cruise, ramp to `end_speed`.
struct RapidMove {
  double peak = 0.0;      // mm/s
  double cruise = 0.0;    // s at the peak
  double duration = 0.0;  // s
};

/// Computes the rapid move over `distance` that starts at rest and leaves at `end_speed` (<= the
/// speed limit). Returns empty when the ramp to `end_speed` is longer than `distance`.
///
/// Accuracy  the peak of a short move is the last double that fits; the rest of the distance goes
///           into the cruise.
/// Cost      at most 128 bisections.
/// Source    docs/theory/feed-curves.md, section 5.
[[nodiscard]] std::optional<RapidMove> rapid_move(double distance, double end_speed,
                                                  const CylinderLimits& limits);

/// Appends the phases of a ramp (three at most) to a motion; `sign` is its direction, speeds are
/// magnitudes. Returns the state at its end: acceleration exactly 0, speed exactly sign * to_speed.
[[nodiscard]] Phase append_ramp(std::vector<Phase>& motion, const Phase& from, double from_speed,
                                double to_speed, double sign, const CylinderLimits& limits);

}  // namespace tubecut::cutoff
