#pragma once

#include <array>
#include <cstddef>

/// Distances between points and the torch's axes, eight in parallel (base/lanes.hpp).
namespace tubecut::bevel::beam {

inline constexpr std::size_t kLanes = 8;
using Eight = std::array<double, kLanes>;

struct alignas(64) EightPoints {
  Eight x, y, z;
};

/// The axis at one position of the torch's path: the points p + s d; `inverse` of the square of d.
struct AxisAt {
  std::array<double, 3> p, d;
  double inverse;
};

/// A segment of the torch's path, straight in phase and height, short enough to be a parabola in
/// space: the axis at its fraction x has p = inner(x) and d = across(x). It comes from outside and
/// is followed at most to the middle of the tube.
struct Way {
  AxisAt first, middle, last;
  std::array<std::array<double, 3>, 3> inner, across;  // by powers of x
  double floor;                                        // s at the tube's middle
  double
      travel;  // maximum motion of a point of the axis, including a kerf's width beyond the walls
};

/// The nearest axis to each point.
struct alignas(64) EightNearest {
  Eight square, distance, stretch, share;
};

/// Computes squared distances.
void squares(const AxisAt& axis, double floor, const EightPoints& points, Eight& out);
/// Replaces the best axis where this one is nearer.
void see(double stretch, double share, const Eight& square, EightNearest& best);

/// The result of a walk along the axes of one segment.
struct Walked {
  double clear;  // until an axis is nearer than the best, all must move at least this far
  double
      beside;  // the smallest distance of the half plane of the last axis beyond the best distances
};

/// Walks from one end of a segment, whose squared distances are `near`, to the other end, and
/// stores that end's distances and any nearer axis on the way. `inner`: the radius of the points p.
[[nodiscard]] Walked walk(const Way& way, double stretch, bool ahead, double inner,
                          const EightPoints& points, Eight& near, EightNearest& best);

}  // namespace tubecut::bevel::beam
