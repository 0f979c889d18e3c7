#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/joint/node/node.hpp"

namespace tubecut::joint {

/// Members whose coordinates have three decimals are turned against each other by so much at most,
/// rad: sides of one that are along the other but for it are taken to be along it.
inline constexpr double kDrawnAlong = 1e-5;
/// Does so with a partner of an end, in the end's frame.
void straighten_as_drawn(RectangularTubeCutter& box);

/// Returns the surface of a member that is not round as a cutter in the world, or in a frame.
[[nodiscard]] RectangularTubeCutter box_of(const Member& member);
[[nodiscard]] RectangularTubeCutter box_of(const Member& member, const MemberFrame& frame);

}  // namespace tubecut::joint

/// For `solve` and `verify`: members in space, whether round or not.
namespace tubecut::joint::detail {

/// The corner radius of a chord whose faces count as meeting in an edge, mm.
inline constexpr double kSharpCorner = 0.01;

/// Sections that are turned against each other about their axis by at most this count as one: at
/// 150 mm from the axis their surfaces are 0.15 mm from each other. rad.
inline constexpr double kSameTurn = 1e-3;

/// Returns the direction of a section's height: `up` made perpendicular to the axis; unit.
[[nodiscard]] Eigen::Vector3d height_of(const Member& member);

/// Returns the member's surface in that frame; empty if it runs along the frame's z.
[[nodiscard]] std::optional<Cutter> cutter_of(const Member& member, const MemberFrame& frame);

/// Returns how far the surface reaches from the axis in the direction of a vector, times its
/// length; only what of it lies across the axis counts.
[[nodiscard]] double support(const Member& member, const Eigen::Vector3d& direction);
/// Returns the signed distance of a point from the endless surface, negative inside.
[[nodiscard]] double distance_from(const Member& member, const Eigen::Vector3d& point);

/// Returns true if both have one outline, so that either continues the surface of the other: of
/// sections equal in size and orientation. A round tube and a section never have.
[[nodiscard]] bool same_outline(const Member& a, const Member& b);
/// Returns the largest distance of two outlines about one axis that are flush on one side: the
/// difference of their radii, or half that of their sides.
[[nodiscard]] double size_step(const Member& a, const Member& b);

/// Returns true if a direction across the axis is one of the section's two axes of symmetry, so
/// that the surface is square to it where it reaches furthest; always of a round tube.
[[nodiscard]] bool is_square_to(const Member& member, const Eigen::Vector3d& direction);

/// Returns true if a branch lies within the chord's width across both axes, up to kSlightOverhang,
/// so that the chord's wall stops all of it. Parallel members never do.
[[nodiscard]] bool covers(const Member& chord, const Member& branch);
/// Returns how far a branch reaches beyond the chord's width across both axes, mm; 0 if it does
/// not.
[[nodiscard]] double overhang(const Member& chord, const Member& branch);
/// Returns the chord as it cuts an end of the branch. A face that a branch is square to, and whose
/// width the bore exceeds, counts as going on to both sides without a rounding, so that the end is
/// flat on it; otherwise nothing would stop the wall that overhangs.
[[nodiscard]] Member as_met(const Member& chord, const Member& branch);
/// Returns true if a chord stops the bore of a branch all round, by its width or by such a face.
[[nodiscard]] bool carries(const Member& chord, const Member& branch);
/// Returns true if a chord whose nearer end lies `inside` mm beyond the axis of a branch that ends
/// on it goes on at least to the branch's far side.
[[nodiscard]] bool goes_on(const Member& chord, const Member& branch, double inside);

/// Returns the largest distance between the edges along which a plane cuts two surfaces, of which
/// one at least is a section, in that plane. `normal` is unit.
/// Accuracy  from 128 places of each edge, by the distance from the other surface: of first order
///           where an edge lies opposite a corner.
[[nodiscard]] double edge_step(const Member& a, const Member& b, const Eigen::Vector3d& point,
                               const Eigen::Vector3d& normal);
/// Returns how far the edge along which a plane through `point` cuts the surface lies outside of
/// all these members on the side of `towards`; mm, negative if it lies inside of one everywhere. A
/// place from which the member, along `into`, still meets one of them is cut off, and counts as
/// lying as near as that.
/// Accuracy  from 128 places of the edge.
[[nodiscard]] double edge_outside(const Member& member, const Eigen::Vector3d& into,
                                  const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                  const Eigen::Vector3d& towards,
                                  const std::vector<const Member*>& others);

}  // namespace tubecut::joint::detail
