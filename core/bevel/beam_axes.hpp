#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <stop_token>
#include <vector>

#include "core/bevel/beam.hpp"
#include "core/math/mixed.hpp"

namespace tubecut::bevel::beam {

using math::mixed;

/// A line across the wall, by its points on both walls.
struct Line {
  Eigen::Vector3d from, to;
};
[[nodiscard]] Line placed(const BeamCut& cut, const AcrossWall& at);
/// The share u of the way from row i to the next; rows are joined the last to the first.
[[nodiscard]] AcrossWall between(const std::vector<AcrossWall>& rows, double turn, std::size_t i,
                                 double u);

/// The nearest axis: its squared distance, and the share of the way after `row` where it stands.
struct Nearest {
  double square;
  Eigen::Vector3d point;  // of the axis, nearest
  std::size_t row;
  double u;
};

/// A straight stretch of the torch's way in phase and height, short enough to be a parabola in
/// space: the axis at the share x of it is inner(x) + s across(x). It comes from outside and is
/// looked at no further than the middle of the tube.
struct Stretch {
  /// The axis at one end of it.
  struct End {
    Eigen::Vector3d inner, across;
    double inverse;  // of its squared length
  };
  std::size_t row;
  double from, to;  // shares of the way from this row to the next
  std::array<Eigen::Vector3d, 3> inner, across;
  std::array<End, 2> ends;
  double middle;  // s where the tube's middle is
  double travel;  // no point of the axis moves further, as far beyond the walls as the kerf is wide

  [[nodiscard]] Eigen::Vector3d at(double x, const Eigen::Vector3d& q) const {
    const Eigen::Vector3d p = inner[0] + x * (inner[1] + x * inner[2]);
    const Eigen::Vector3d d = across[0] + x * (across[1] + x * across[2]);
    return p + std::max((q - p).dot(d) / d.squaredNorm(), middle) * d;
  }
  [[nodiscard]] double square(double x, const Eigen::Vector3d& q) const {
    return (q - at(x, q)).squaredNorm();
  }
  [[nodiscard]] double square_at(const End& end, const Eigen::Vector3d& q) const {
    const Eigen::Vector3d off = q - end.inner;
    const double s = std::max(off.dot(end.across) * end.inverse, middle);
    return (off - s * end.across).squaredNorm();
  }
  [[nodiscard]] double square_first(const Eigen::Vector3d& q) const {
    return square_at(ends[0], q);
  }
  [[nodiscard]] double square_last(const Eigen::Vector3d& q) const { return square_at(ends[1], q); }
};

/// The axes along the torch's way; indices over two laps, so that half a lap either way is a run.
class Axes {
 public:
  Axes(const BeamCut& cut, const std::stop_token& stop);

  /// To q, from the axes less than half a lap from the share u of the way after `row`.
  [[nodiscard]] Nearest nearest(std::size_t row, double u, const Eigen::Vector3d& q) const;

 private:
  struct Best {
    std::size_t stretch;
    double x;
    double square = 0.0, distance = 0.0;

    void see(std::size_t k, double at, double value);
  };
  [[nodiscard]] AcrossWall torch(std::size_t row, double u) const;
  void add(std::size_t row, double from, double to, const Line& first, const Line& last);
  [[nodiscard]] const Stretch& stretch(std::size_t k) const {
    return stretches_[k % stretches_.size()];
  }
  void walk(std::size_t k, std::size_t last, const Eigen::Vector3d& q, Best& best) const;
  void walk_back(std::size_t end, std::size_t first, const Eigen::Vector3d& q, Best& best) const;
  void look(std::size_t index, double low, double high, double both, const Eigen::Vector3d& q,
            Best& best) const;
  [[nodiscard]] double ahead(const Stretch::End& end, const Eigen::Vector3d& q) const;
  void descend(std::size_t k, double x, const Eigen::Vector3d& q, Best& best) const;

  const BeamCut& cut_;
  std::vector<Stretch> stretches_;
  std::vector<std::size_t> first_;  // stretch of each row
  std::vector<double> travelled_;   // to the start of the stretch, of all before it
  bool meridian_ = false;  // each axis in a half plane through the tube's axis, as an end's are
};

}  // namespace tubecut::bevel::beam
