#pragma once

#include <cstddef>
#include <vector>

#include "core/motion/kinematics.hpp"
#include "core/motion/program.hpp"

namespace tubecut::motion {

/// A point as the follower sees it: tip coordinates in mm.
using TipPoint = Coordinates;

/// Follows reconstructed points along the polyline of a program: how far off each is, what of the
/// polyline was never reached, and which B the contour has where each point lies. Looks only near
/// the last place, so that the order of the cut counts.
class Follower {
 public:
  /// `part`: coordinates that take part. `window`: mm of tip path looked at on both sides.
  Follower(const Program& program, const std::vector<bool>& part, double window);

  struct Found {
    double distance = 0.0;  // mm
    double at = 0.0;        // mm of tip path along the polyline
    std::size_t segment = 0;
  };
  /// Nearest place of the polyline to the next reconstructed point.
  Found follow(const TipPoint& tip);

  /// Least and greatest value of coordinate `c` of the contour within `reach` mm of tip path around
  /// `at`.
  [[nodiscard]] std::pair<double, double> range(std::size_t c, double at, double reach) const;
  /// Largest distance of a polyline point to the path followed, mm.
  [[nodiscard]] double farthest_missed() const;
  [[nodiscard]] double tip_length(std::size_t point) const { return at_[point]; }
  /// Tip coordinates, mm, out of program coordinates.
  [[nodiscard]] TipPoint tip_of(const Coordinates& x) const;

 private:
  void reach_points(const TipPoint& from, const TipPoint& to, double at);
  [[nodiscard]] Found nearest_on(std::size_t segment, const TipPoint& tip) const;

  const Program& program_;
  std::vector<std::size_t> tip_coordinates_ = {};
  std::vector<TipPoint> points_ = {};
  std::vector<double> at_ = {};      // tip length up to each point
  std::vector<double> missed_ = {};  // distance of each point to the path so far
  double window_;
  std::size_t low_ = 0;   // first segment within the window
  std::size_t near_ = 0;  // first point within the window
  double last_at_ = 0.0;
  bool started_ = false;
  TipPoint last_ = {};
};

}  // namespace tubecut::motion
