#pragma once

#include <array>
#include <cstddef>

/// Places beside the torch's axes, eight side by side (base/lanes.hpp).
namespace tubecut::bevel::beam {

inline constexpr std::size_t kLanes = 8;
using Eight = std::array<double, kLanes>;

struct alignas(64) EightPoints {
  Eight x, y, z;
};

/// The axis at one place of the torch's way: the points p + s d, `inverse` of the square of d.
struct AxisAt {
  std::array<double, 3> p, d;
  double inverse;
};

/// A straight stretch of the torch's way in phase and height, short enough to be a parabola in
/// space: the axis at the share x of it has p = inner(x) and d = across(x). It comes from outside
/// and is looked at no further than the middle of the tube.
struct Way {
  AxisAt first, middle, last;
  std::array<std::array<double, 3>, 3> inner, across;  // by the power of x
  double floor;                                        // s where the tube's middle is
  double travel;  // no point of the axis moves further, as far beyond the walls as the kerf is wide
};

/// The nearest axis to each point.
struct alignas(64) EightNearest {
  Eight square, distance, stretch, share;
};

/// Squared distances.
void squares(const AxisAt& axis, double floor, const EightPoints& points, Eight& out);
/// Takes an axis for the nearest where it is.
void see(double stretch, double share, const Eight& square, EightNearest& best);

/// What a walk along the axes finds on one stretch.
struct Walked {
  double clear;   // until an axis is nearer than the best, all move at least so far
  double beside;  // the least by which the half plane of the last axis passes the best distances
};

/// From one end of a stretch, whose squared distances are `near`, to the other: those of that one,
/// and what is nearer on the way. `inner`: the radius of the points p.
[[nodiscard]] Walked walk(const Way& way, double stretch, bool ahead, double inner,
                          const EightPoints& points, Eight& near, EightNearest& best);

}  // namespace tubecut::bevel::beam
