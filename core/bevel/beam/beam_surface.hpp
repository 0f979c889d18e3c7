#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/bevel/beam/beam_axes.hpp"

namespace tubecut::bevel::beam {

/// A point of the finished surface: between rows, across the wall.
struct SurfacePoint {
  std::size_t row = 0;
  double u = 0.0, v = 0.0;
  bool land = false;
};

/// The finished surface and the axes near it.
class Surface {
 public:
  Surface(const BeamCut& cut);

  /// The nearest axis to a point: its distance, negative if it lies beyond the finished line of its
  /// own row, in the part; and its position on the torch's path.
  struct Seen {
    double distance;
    std::size_t row;
    double u;
  };
  /// Computes it for up to kLanes points near one another, each on its line.
  void seen(std::span<const SurfacePoint> at, std::span<const Line> lines,
            std::span<Seen> out) const;
  void seen(std::span<const SurfacePoint> at, std::span<Seen> out) const;
  /// Computes the lines across the wall, or the land, for up to kLanes points.
  void across_wall(std::span<const SurfacePoint> at, std::span<Line> out) const;

  [[nodiscard]] double phase(const SurfacePoint& at) const;
  [[nodiscard]] std::size_t rows() const { return cut_.finished.size(); }
  [[nodiscard]] double across(std::size_t row, bool land) const {
    return (land ? on_land_ : on_wall_)[row];
  }
  /// Returns the length of the path from one row to the next, on the wall where it is longer.
  [[nodiscard]] double step(std::size_t row) const { return steps_[row]; }
  /// Returns the point at these distances along the cut and across the wall from another, mm;
  /// clamped to the edges.
  [[nodiscard]] SurfacePoint moved(SurfacePoint from, double along, double across) const;

 private:
  [[nodiscard]] std::size_t next(std::size_t row) const { return row + 1 < rows() ? row + 1 : 0; }
  [[nodiscard]] double share(const SurfacePoint& at) const { return mixed(cut_.from, 1.0, at.v); }
  [[nodiscard]] AcrossWall finished(const OnWay& at) const;
  [[nodiscard]] Eigen::Vector3d point(const SurfacePoint& at, const Line& line) const;
  [[nodiscard]] double length(std::size_t row) const;
  [[nodiscard]] double beyond(const Line& finished, std::size_t row,
                              const Eigen::Vector3d& point) const;
  void see_rows();

  const BeamCut& cut_;
  Axes axes_;
  std::vector<Eigen::Vector3d> along_;  // from each row to the next, in the middle of the wall
  std::vector<double> steps_, on_wall_, on_land_;
  std::vector<bool>
      off_;  // true if on the path from each row to the next the axis is clear of its own line
};

}  // namespace tubecut::bevel::beam
