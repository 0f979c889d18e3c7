#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/bevel/beam/beam.hpp"
#include "core/bevel/beam/beam_lanes.hpp"
#include "core/math/mixed.hpp"

namespace tubecut::bevel::beam {

using math::mixed;

/// A line across the wall, by its points on both walls.
struct Line {
  Eigen::Vector3d from, to;
};
[[nodiscard]] Line placed(const BeamCut& cut, const AcrossWall& at);
/// Computes many at once.
void placed(const BeamCut& cut, std::span<const AcrossWall> at, std::span<Line> out);
[[nodiscard]] std::vector<Line> placed(const BeamCut& cut, std::span<const AcrossWall> at);
/// Interpolates at the fraction u from row i to the next; the last row is joined to the first.
[[nodiscard]] AcrossWall between(const std::vector<AcrossWall>& rows, double turn, std::size_t i,
                                 double u);

/// A fraction u of the path after a row.
struct OnWay {
  std::size_t row;
  double u;
};

/// The nearest axis: its squared distance, and its fraction of the path after `row`.
struct Nearest {
  double square;
  OnWay at;
  std::size_t stretch;
  double share;  // of the segment
};

/// The axes along the torch's path; indices cover two laps, so that half a lap in either direction
/// is contiguous.
class Axes {
 public:
  Axes(const BeamCut& cut);

  /// Finds the nearest axis of each point, less than half a lap from its own position on the path;
  /// for up to kLanes points near one another.
  void nearest(std::span<const OnWay> own, const EightPoints& points, std::span<Nearest> out) const;
  /// Returns the point of that axis that is nearest to q.
  [[nodiscard]] Eigen::Vector3d point(const Nearest& axis, const Eigen::Vector3d& q) const;

 private:
  /// A segment's fractions of the path from its row to the next.
  struct Part {
    std::size_t row;
    double from, to;
  };
  void divide(const std::vector<Line>& rows);
  void add_ways(const std::vector<Line>& rows);
  [[nodiscard]] Way way(const Line& first, const Line& middle, const Line& last) const;
  [[nodiscard]] std::size_t stretch_of(const OnWay& at) const;
  [[nodiscard]] std::pair<std::size_t, std::size_t> stretches(std::span<const OnWay> own) const;
  void see_first(std::size_t k, const EightPoints& points, Eight& square, EightNearest& best) const;
  [[nodiscard]] Walked walk_on(std::size_t k, bool on, const EightPoints& points, Eight& square,
                               EightNearest& best) const;
  void walk_ahead(std::size_t k, std::size_t last, const EightPoints& points, Eight square,
                  EightNearest& best) const;
  void walk_back(std::size_t end, std::size_t first, const EightPoints& points, Eight square,
                 EightNearest& best) const;
  [[nodiscard]] const Way& way(std::size_t k) const { return ways_[k % ways_.size()]; }

  const BeamCut& cut_;
  std::vector<Part> parts_;
  std::vector<Way> ways_;
  std::vector<std::size_t> first_;  // first segment of each row
  std::vector<double> travelled_;   // total of all segments before this one
  bool meridian_ =
      false;  // true if each axis is in a half plane through the tube's axis, as at an end
};

}  // namespace tubecut::bevel::beam
