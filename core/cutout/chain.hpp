#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.hpp"

namespace tubecut::cutout {

/// A point or direction of a cut-out's local plane: x is a, along +z; y is b, the way s grows.
using Flat = Eigen::Vector2d;

[[nodiscard]] inline double cross(const Flat& a, const Flat& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// A line, or an arc of a circle where `radius` is not 0.
struct Segment {
  Flat from = Flat::Zero(), to = Flat::Zero();
  Flat centre = Flat::Zero();
  double radius = 0.0;
  double angle = 0.0;     // of `from` about the centre, rad from a towards b
  double sweep = 0.0;     // rad, positive from a towards b
  std::size_t piece = 0;  // of a drawing

  [[nodiscard]] bool arc() const { return radius > 0.0; }
  /// The scrap lies within the arc's circle: on the left of an arc that turns left.
  [[nodiscard]] bool hollow() const { return sweep > 0.0; }
  [[nodiscard]] Flat at(double share) const;
  [[nodiscard]] Flat along(double share) const;  // unit tangent
  [[nodiscard]] double length() const;
};

/// Closed; the scrap is on its left, so that it turns from a towards b.
using Chain = std::vector<Segment>;

[[nodiscard]] Segment line(const Flat& from, const Flat& to);
[[nodiscard]] Segment arc(const Flat& centre, double radius, double angle, double sweep);

[[nodiscard]] Chain circle(double diameter);
/// `length` over all.
[[nodiscard]] Chain slot(double length, double width);
[[nodiscard]] Chain rectangle(double along, double round, double radius);

/// A segment of a drawing, from where the one before it ends: x to the right, y up.
struct DrawnSegment {
  Flat to = Flat::Zero();
  std::optional<Flat> centre = {};  // of an arc
  bool clockwise = false;           // its sense
};

/// A closed drawing as seen from outside with the start on the left: a = x, b = -y; mirrored: b =
/// y.
///
/// Errors  contour_open, contour_crosses (also of one without an area); out_of_range (pieces/i: an
///         arc's ends lie at different distances from its centre, or a piece has no length).
[[nodiscard]] Result<Chain> drawn(const Flat& start, const std::vector<DrawnSegment>& pieces,
                                  bool mirrored);

/// Turned about the anchor from a towards b, rad.
[[nodiscard]] Chain turned(Chain chain, double angle);

/// Enclosed in its plane, mm^2.
[[nodiscard]] double area(const Chain& chain);

/// A box with its sides along a and b.
struct Bounds {
  Flat least = Flat::Zero(), most = Flat::Zero();
};
[[nodiscard]] Bounds bounds(const Chain& chain);

/// From a place to the chain, mm.
[[nodiscard]] double distance(const Chain& chain, const Flat& p);
/// Whether a place lies within it.
[[nodiscard]] bool holds(const Chain& chain, const Flat& p);

/// Where the chain crosses the line a = `at`, as stretches within it: from b to b, ascending.
[[nodiscard]] std::vector<std::pair<double, double>> stretches(const Chain& chain, double at);

/// The greatest |b| of a segment.
[[nodiscard]] double reach_across(const Segment& s);
/// Returns the shares, from 0 to 1, between which a segment is integrated that reaches to |b| >=
/// near the bore's: `count` equal pieces, and finer and finer ones towards such places, because the
/// way round has a square root's bend beyond. Empty if it is nowhere so wide.
[[nodiscard]] std::vector<double> shares_towards(const Segment& s, int count, double near);

}  // namespace tubecut::cutout
