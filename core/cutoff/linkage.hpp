#pragma once

#include <optional>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/base/error.hpp"

namespace tubecut::cutoff {

/// One measured position of the machine: the tool's feed at a cylinder stroke, both from rest.
struct MeasuredPair {
  double feed = 0.0;    // mm
  double stroke = 0.0;  // mm, same sign as the feed
};

/// The linkage between cylinder and tool of a rotary cut-off machine. Lengths in mm.
/// Frame: arm pivot O1 at the origin, X towards the slot plate's pivot O2, angles anticlockwise,
/// rod line X = 0.
struct Linkage {
  double arm = 0.0;             // R1, > 0
  double pivot_distance = 0.0;  // R2 = |O1 O2|, >= pivot_offset
  double pivot_offset = 0.0;    // A, its part along X, > 0
  Angle rest_angle = {};        // theta0 of the arm, open interval (-180, 180) deg
  Angle slot_angle = {};        // alpha between the two slots, open interval (0, 180) deg
  double rad_per_mm = 0.0;      // k, arm angle per stroke, > 0
  std::optional<MeasuredPair> calibrate = {};  // gives rad_per_mm instead of the member
};

/// Quantities that follow from the linkage only. Empty limits are infinite.
struct Geometry {
  double rod_height = 0.0;    // x0, mm
  Angle slot_elevation = {};  // psi0 of slot 2 at rest
  double stroke_low = 0.0;    // open interval of the stroke, mm
  double stroke_high = 0.0;
  std::optional<double> feed_low = {};  // open interval of the feed, mm
  std::optional<double> feed_high = {};
  std::optional<double> feed_at_peak =
      {};                   // where the cylinder is fastest at constant feed; independent of k
  double rad_per_mm = 0.0;  // the k in use
};

/// Tool feed and its derivative with respect to the stroke.
struct Forward {
  double feed = 0.0;  // mm
  double rate = 0.0;  // f', mm/mm
};

/// Stroke at a feed and its derivatives with respect to the feed.
struct Inverse {
  double stroke = 0.0;  // mm
  double first = 0.0;   // g'
  double second = 0.0;  // g'', 1/mm
  double third = 0.0;   // g''', 1/mm^2
};

/// The maps between cylinder stroke y and tool feed x of one linkage, both 0 at rest, in closed
/// form.
///
/// Accuracy  feed(stroke(x)) = x within 1e-12 of |x| + A/cos^2 psi0, 1 % away from the limits
///           (worst seen over 10^5 seeded linkages: 3.5e-13).
/// Source    docs/theory/feed-curves.md, section 2.
class Mechanism {
 public:
  /// Errors    out_of_range, not_finite, exclusive_fields, r2_lt_a, dead_point, reversed,
  ///           slot_off_rod; unreachable_x for the feed of a calibration.
  [[nodiscard]] static Result<Mechanism> make(const Linkage& linkage);

  /// Computes the tool feed at a stroke.
  /// Errors    tan_pole or dead_point: the stroke is outside (stroke_low, stroke_high) shrunk by
  ///           1e-12 of its width.
  [[nodiscard]] Result<double> tool_feed(double stroke) const;

  /// Compute the tool feed at a stroke, or the cylinder stroke at a feed, with derivatives. The
  /// arguments must be in range.
  /// Cost      one call of an elementary function each, three roots and some six quotients.
  [[nodiscard]] Forward forward(double stroke) const;
  [[nodiscard]] Inverse inverse(double feed) const;

  /// Returns true if a feed is within the linkage's range and the arm is at least 0.06 deg from a
  /// tangent position.
  [[nodiscard]] bool reaches(double feed) const;
  [[nodiscard]] const Geometry& geometry() const { return geometry_; }
  /// Returns the horizontal part A of the pivots' distance, the scale of the accuracy line.
  [[nodiscard]] double pivot_offset() const { return offset_; }

 private:
  friend class StrokeCursor;
  struct Limit {
    double turn = 0.0;  // arm angle from rest, rad
    std::optional<double> feed = {};
    bool dead_point = false;
  };
  Mechanism() = default;
  /// beta - beta0 and half of it.
  struct SlotTurn {
    elementary::SinCos whole, half;
  };
  [[nodiscard]] SlotTurn slot_turn(double feed) const;
  [[nodiscard]] static SlotTurn slot_turned(double angle);
  [[nodiscard]] double arm_turn(const SlotTurn& slot) const;  // theta - theta0
  /// Computes sine and cosine of half of it, times one factor.
  [[nodiscard]] elementary::SinCos half_arm_turn(const SlotTurn& slot, double cosine) const;
  /// Computes all except the stroke, and stores half the arm's turn for it.
  [[nodiscard]] Inverse inverse(double feed, elementary::SinCos& half_arm_turn) const;
  [[nodiscard]] double lead_of(const elementary::SinCos& lag_half) const;
  [[nodiscard]] Limit limit(double slot_turn_at_pole, double slot_turn_at_dead_point,
                            bool upper) const;
  [[nodiscard]] std::optional<double> find_peak() const;
  [[nodiscard]] Result<void> set_rest(const Linkage& linkage);
  [[nodiscard]] Result<void> set_rate(const Linkage& linkage);
  void set_limits();

  double offset_ = 0.0;  // A
  double ratio_ = 0.0;   // rho = R2/R1
  double one_minus_ratio_ = 0.0;
  double lag_ = 0.0;  // e0 = gamma - theta0
  elementary::SinCos lag_half_ = {};
  double slot_lag_ = 0.0;  // delta0 = gamma - beta0
  elementary::SinCos slot_lag_sides_ = {};
  double sine_ = 0.0;            // sin(theta0 - beta0)
  double cosine_ = 0.0;          // cos(theta0 - beta0), > 0
  elementary::SinCos psi_ = {};  // of psi0, its cosine > 0
  double k_ = 0.0;
  Limit low_ = {};
  Limit high_ = {};
  Geometry geometry_ = {};
};

/// `Mechanism::inverse` at a sequence of feeds: computes the arm's turn from that of a nearby feed,
/// by the arctangent of the small difference.
///
/// Accuracy  strokes within 4e-16 rad of the arm's turn of `Mechanism::inverse`; derivatives the
///           same.
/// Cost      no elementary function while the arm is within 1e-3 rad of the last position that used
///           one.
class StrokeCursor {
 public:
  explicit StrokeCursor(const Mechanism& mechanism) : mechanism_(&mechanism) {}
  [[nodiscard]] Inverse at(double feed);

 private:
  const Mechanism* mechanism_;
  elementary::SinCos anchor_ =
      {};  // sine and cosine of half the arm's turn, times one factor; at rest
  double angle_ = 0.0;
};

}  // namespace tubecut::cutoff
