#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/cutout/hull.hpp"

/// A convex outline about the origin, as lines in one direction see it.
namespace tubecut::cutout {

/// One side of the outline: a place has c across the lines and w along them, on this side the
/// greatest w at its c; of the other side the signs of w are turned, so that both are concave.
class Profile {
 public:
  /// `c`, `w`: unit vectors at a right angle to each other; `sense`: 1, or -1 for the other side.
  Profile(const std::vector<HullPart>& outline, const Eigen::Vector2d& c, const Eigen::Vector2d& w,
          double sense);

  struct Span {
    double from, to;          // c
    Eigen::Vector2d at, end;  // its ends, (c, w)
    Eigen::Vector2d centre;   // of an arc
    double radius = 0.0;      // 0 of a line
  };
  [[nodiscard]] const std::vector<Span>& spans() const { return spans_; }
  [[nodiscard]] double least() const { return spans_.front().from; }
  [[nodiscard]] double most() const { return spans_.back().to; }
  /// Returns the index of the span at c.
  [[nodiscard]] std::size_t span_at(double c) const;
  /// Returns w of a span at c, beyond its ends as at them.
  [[nodiscard]] double height(std::size_t span, double c) const;
  /// Returns its outward unit normal there.
  [[nodiscard]] Eigen::Vector2d normal(std::size_t span, double c) const;

 private:
  std::vector<Span> spans_;
};

}  // namespace tubecut::cutout
