#pragma once

#include <variant>

#include "core/cutoff/linkage.hpp"
#include "core/math/remez.hpp"

namespace tubecut::cutoff {

/// The work feed by its ends, mm from rest.
struct FeedWindow {
  double start_feed = 0.0;
  double end_feed = 0.0;  // > start_feed
};

/// The work feed by the distances that the tool covers, mm: it starts `slowdown` before the tube
/// and ends `overcut` beyond the wall.
struct CutDistances {
  double clearance = 0.0;  // s1, tool at rest to the tube, >= 0
  double slowdown = 0.0;   // s2, 0..clearance
  double wall = 0.0;       // s, > 0
  double overcut = 0.0;    // s3, >= 0
};

struct Cut {
  std::variant<FeedWindow, CutDistances> range = {};
  double feed = 0.0;  // v of the tool, mm/s, > 0
};

/// The cylinder motion that the exact work feed requires.
struct Work {
  double start_feed = 0.0;                 // x_s, mm
  double end_feed = 0.0;                   // x_e, mm
  double feed = 0.0;                       // v, mm/s
  double duration = 0.0;                   // T, s
  double start_stroke = 0.0;               // mm
  double end_stroke = 0.0;                 // mm
  double min_cylinder_speed = 0.0;         // mm/s
  double max_cylinder_speed = 0.0;         // mm/s
  double max_cylinder_acceleration = 0.0;  // largest magnitude, mm/s^2
  double max_cylinder_jerk = 0.0;          // largest magnitude, mm/s^3
  std::optional<double> time_at_peak =
      {};  // s; empty when the cylinder speed has no maximum within the work feed
};

/// Cylinder motion at one instant of the work feed.
struct CylinderState {
  double feed = 0.0;          // tool, mm
  double stroke = 0.0;        // mm
  double speed = 0.0;         // mm/s
  double acceleration = 0.0;  // mm/s^2
  double jerk = 0.0;          // mm/s^3
};

/// The constant tool feed x = x_s + v t on [0, T] and the cylinder motion that produces it, in
/// closed form.
///
/// Source    docs/theory/feed-curves.md, section 3.
class WorkFeed {
 public:
  /// Errors    out_of_range, not_finite, s2_gt_s1, unreachable_x.
  [[nodiscard]] static Result<WorkFeed> make(const Mechanism& mechanism, const Cut& cut);

  [[nodiscard]] CylinderState at(double time) const;
  /// Computes the same for a sequence of times.
  [[nodiscard]] CylinderState at(double time, StrokeCursor& cursor) const;
  [[nodiscard]] double cylinder_speed(double time) const { return at(time).speed; }
  [[nodiscard]] const Work& work() const { return work_; }
  [[nodiscard]] const Mechanism& mechanism() const { return mechanism_; }
  /// Returns the cylinder speed over time on 1601 Chebyshev-spaced points.
  [[nodiscard]] const math::SampledCurve& speed() const { return speed_; }

 private:
  explicit WorkFeed(const Mechanism& mechanism) : mechanism_(mechanism) {}
  void find_extremes();
  [[nodiscard]] double feed_at(double time) const;
  [[nodiscard]] CylinderState state(double feed, const Inverse& g) const;

  Mechanism mechanism_;
  Work work_ = {};
  math::SampledCurve speed_ = {};
};

}  // namespace tubecut::cutoff
