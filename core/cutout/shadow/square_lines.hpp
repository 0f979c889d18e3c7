#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/joint/target.hpp"
#include "core/section/section.hpp"

/// The lines of a wall that are square to the outside of a tube.
namespace tubecut::cutout {

/// One of these lines, across the tube, and how its ends move as s grows.
struct SquareLine {
  Eigen::Vector2d outer, bore;
  Eigen::Vector2d outer_rate, bore_rate;  // per mm of s; at a seam those beyond it
};

/// All lines of a round tube or of a section, by s: the way round the outside from +x towards +y,
/// which may count whole turns.
/// Source  docs/theory/cutouts.md, section 11.
class SquareLines {
 public:
  explicit SquareLines(const joint::Target& tube) : tube_(tube) {}
  explicit SquareLines(const section::Wall& wall) : wall_(wall) {}

  [[nodiscard]] SquareLine at(double s) const;
  /// Returns s where either end of the lines has a seam, between two s, ascending.
  [[nodiscard]] std::vector<double> seams(double from, double to) const;

  /// The side of the tube that faces a direction, a unit vector across the tube: from s to s.
  struct Side {
    double from, to;
  };
  [[nodiscard]] Side side(const Eigen::Vector2d& towards) const;

 private:
  [[nodiscard]] double girth() const;

  joint::Target tube_ = {};
  std::optional<section::Wall> wall_;
};

}  // namespace tubecut::cutout
