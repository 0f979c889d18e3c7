#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <stop_token>
#include <vector>

#include "core/bevel/beam_axes.hpp"

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
  [[nodiscard]] Seen seen(const Place& at) const {
    return seen(at, across_wall(at.row, at.u, at.land));
  }
  /// The same of a place on a line known.
  [[nodiscard]] Seen seen(const Place& at, const Line& line) const;
  /// Across the wall, or the land.
  [[nodiscard]] Line across_wall(std::size_t row, double u, bool land) const;

  [[nodiscard]] double phase(const Place& at) const;
  [[nodiscard]] std::size_t rows() const { return cut_.finished.size(); }
  [[nodiscard]] double across(std::size_t row, bool land) const;
  /// Length of the way from one row to the next, on the wall where it is longer.
  [[nodiscard]] double step(std::size_t row) const;
  /// A place so far along the cut and across the wall from another, mm; no further than the edges.
  [[nodiscard]] Place moved(Place from, double along, double across) const;

 private:
  [[nodiscard]] double share(const Place& at) const { return mixed(cut_.from, 1.0, at.v); }
  [[nodiscard]] AcrossWall finished(const Place& at) const;
  [[nodiscard]] Eigen::Vector3d point(const Place& at, const Line& line) const;
  [[nodiscard]] double beyond(const Nearest& near) const;

  const BeamCut& cut_;
  Axes axes_;
  std::vector<Eigen::Vector3d> along_;  // from each row to the next, in the middle of the wall
};

}  // namespace tubecut::bevel::beam
