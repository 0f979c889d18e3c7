#pragma once

#include <Eigen/Core>

#include "core/cutout/chain.hpp"
#include "core/joint/node/member.hpp"
#include "core/joint/placement.hpp"

/// The hole that a tube requires in a plate.
namespace tubecut::plate {

/// A tube within a plate, between two heights of the plate's frame (z along its normal, 0 at its
/// face).
struct Passage {
  joint::Member tube;
  double from = 0.0, to = 0.0;  // mm; from > to
  double gap = 0.0;             // of the hole's wall from the tube's surface, normal to it
};

/// The hole, straight through the plate. Lengths in mm.
struct TubeHole {
  cutout::Chain chain;
  std::optional<double> diameter;  // of a circle
  cutout::Flat centre;             // where the axis passes half-way
  double greatest_gap = 0.0;       // of its wall from the tube, more than the gap where it leans
};

/// If the sine of the angle between a tube's axis and the plate is below it, the tube runs along
/// the plate.
inline constexpr double kAlong = 1e-3;

/// Returns the shadow of the tube, grown by its gap, along the plate's normal: the hull of its
/// outlines at both heights, so that a wall square to the plate clears the tube at every depth.
///
/// Errors    parallel_axes: the tube runs along the plate.
/// Accuracy  circles, and the straight sides and corners of tubes square to the plate, are exact;
///           arcs of ellipses are circular arcs within 1e-4 mm, on the side away from the tube.
[[nodiscard]] Result<TubeHole> hole_of(const Passage& passage, const joint::MemberFrame& plate);

/// Returns the tube's outline where it meets the height `at`, without a gap.
/// Errors  as `hole_of`.
[[nodiscard]] Result<cutout::Chain> outline_at(const joint::Member& tube, double at,
                                               const joint::MemberFrame& plate);

/// Returns the signed distance of a place of the world from the tube's outside as if it were
/// endless; negative inside.
[[nodiscard]] double off_tube(const joint::Member& tube, const Eigen::Vector3d& place);

}  // namespace tubecut::plate
