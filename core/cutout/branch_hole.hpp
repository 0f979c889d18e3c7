#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/cutout/cutout.hpp"
#include "core/joint/joint.hpp"
#include "core/joint/placement.hpp"

/// Holes for a branch where the branch or the tube that is cut is not round. Their wall is square
/// to the tube, so they are cut-outs whose shape follows from the branch.
namespace tubecut::cutout {

/// A branch in the frame of the tube's start: z from its work point.
struct Branch {
  std::optional<section::Section> section = {};   // of one that is not round
  double radius = 0.0, wall = 0.0;                // of a round one
  joint::AxisLine axis;                           // its direction points out of the tube
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  // the section's height lies along it
  joint::JointKind kind = joint::JointKind::set_in;
  double gap = 0.0;  // from the branch's surface, normal to it
  bevel::Tilt tilt = bevel::Tilt::none;
};

/// A hole as a cut-out.
struct BranchHole {
  Spec spec;
  // Largest distance of the hole's wall from the branch, normal to its surface, mm: more than the
  // gap where the branch leans and on round tubes, because a square wall clears it on both
  // surfaces.
  double greatest_gap = 0.0;
};

/// Returns the cut-outs that a branch requires: one where it leaves the tube, and of one that
/// passes through also one on the other side ("id.far"). Set-on: the branch's bore; else its
/// outside, grown by the gap. On a flat, and at a right angle in a round tube, the outline is the
/// hull of the branch's outlines on the outside and on the bore; over corners, and if the branch
/// leans in a round tube, it is the branch's shadow on a wall square to the outside.
///
/// `wall` is of a tube that is not round, else nullptr; `zero`: the part's phi = 0 in the start's
/// frame.
///
/// Errors    at the branch: parallel_axes (it runs along the tube), open_profile (its axis
///           misses the tube, or it reaches the tube's side).
/// Accuracy  the wall is nowhere nearer to the branch than the gap; straight sides and those of
///           branches at right angles are exact, the others are within 2e-4 mm.
/// Source    docs/theory/cutouts.md, sections 6 and 12.
[[nodiscard]] Result<std::vector<BranchHole>> holes_for(const Branch& branch, const std::string& id,
                                                        const joint::Target& tube,
                                                        const section::Wall* wall, Angle zero);

/// Returns the signed distance of a place in the tube's start frame from the branch's surface that
/// the hole follows, without the gap; negative inside.
[[nodiscard]] double distance_from(const Branch& branch, const Eigen::Vector3d& place);

}  // namespace tubecut::cutout
