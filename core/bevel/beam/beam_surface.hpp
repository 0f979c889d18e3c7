#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <stop_token>
#include <vector>

#include "core/bevel/beam/beam_axes.hpp"

namespace tubecut::bevel::beam {

/// A place of the finished surface: between rows, across the wall.
struct Place {
  std::size_t row = 0;
  double u = 0.0, v = 0.0;
  bool land = false;
};

/// The finished surface and the axes past it.
class Surface {
 public:
  Surface(const BeamCut& cut, const std::stop_token& stop);

  /// The nearest axis to a place: its distance, negative where it runs beyond the finished line of
  /// its own row, in the part; and where on the torch's way it stands.
  struct Seen {
    double distance;
    std::size_t row;
    double u;
  };
  /// Of up to kLanes places near one another, each on its line.
  void seen(std::span<const Place> at, std::span<const Line> lines, std::span<Seen> out) const;
  void seen(std::span<const Place> at, std::span<Seen> out) const;
  /// Across the wall, or the land; of up to kLanes places.
  void across_wall(std::span<const Place> at, std::span<Line> out) const;

  [[nodiscard]] double phase(const Place& at) const;
  [[nodiscard]] std::size_t rows() const { return cut_.finished.size(); }
  [[nodiscard]] double across(std::size_t row, bool land) const {
    return (land ? on_land_ : on_wall_)[row];
  }
  /// Length of the way from one row to the next, on the wall where it is longer.
  [[nodiscard]] double step(std::size_t row) const { return steps_[row]; }
  /// A place so far along the cut and across the wall from another, mm; no further than the edges.
  [[nodiscard]] Place moved(Place from, double along, double across) const;

 private:
  [[nodiscard]] std::size_t next(std::size_t row) const { return row + 1 < rows() ? row + 1 : 0; }
  [[nodiscard]] double share(const Place& at) const { return mixed(cut_.from, 1.0, at.v); }
  [[nodiscard]] AcrossWall finished(const OnWay& at) const;
  [[nodiscard]] Eigen::Vector3d point(const Place& at, const Line& line) const;
  [[nodiscard]] double length(std::size_t row) const;
  [[nodiscard]] double beyond(const Line& finished, std::size_t row,
                              const Eigen::Vector3d& point) const;
  void see_rows(const std::stop_token& stop);

  const BeamCut& cut_;
  Axes axes_;
  std::vector<Eigen::Vector3d> along_;  // from each row to the next, in the middle of the wall
  std::vector<double> steps_, on_wall_, on_land_;
  std::vector<bool> off_;  // on the way from each row to the next the axis is clear of its own line
};

}  // namespace tubecut::bevel::beam
