#pragma once

#include <optional>
#include <vector>

#include "core/joint/node/node.hpp"
#include "core/part/part.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::part {

/// The position of phi = 0 on a part.
enum class Datum {
  up,           // on the side of a direction (for a part given directly: its own phi = 0)
  seam,         // on the tube's seam, at `seam` from that direction
  first_cutter  // where the start's first partner has clocking 0; if it has no side, the finish's
                // first partner
};

/// Computes the part's phi = 0 in the start's frame, from the partners of its ends.
/// Errors  bad_reference_direction (datum: no partner has a side).
[[nodiscard]] Result<Angle> datum_angle(Datum datum, Angle seam,
                                        const std::vector<joint::Partner>& start,
                                        const std::vector<joint::Partner>& finish);

/// Returns an end whose partner is a plane square to the axis, `height` from the work point into
/// the member.
[[nodiscard]] EndSpec square_end(const bevel::TableSpec& options, double height);

/// Returns the point where the axis of a branch leaves the surface of a part with this outer
/// radius; if the axis misses the part, the nearest point. `frame`: of the part's start.
[[nodiscard]] Mark mark_of(const joint::Member& branch, joint::End end,
                           const joint::MemberFrame& frame, double radius);

/// Returns the point where the axis of a branch leaves the outside of a member that is not round.
/// `frame`: of the part's start.
[[nodiscard]] SectionMark mark_of(const joint::Member& branch, joint::End end,
                                  const joint::MemberFrame& frame, const section::Curve& outer);

/// Returns a member as the branch of a square hole. `frame`: of the part's start.
[[nodiscard]] cutout::Branch square_branch(const joint::Member& branch, joint::End end,
                                           const joint::MemberFrame& frame, joint::JointKind kind,
                                           double gap);

/// A hole for a member of the node: `cut` except chord and branch.
struct BranchHole {
  bevel::HoleSpec cut;
  std::size_t branch = 0;
};

/// One member of a node as a part. If no member cuts an end, it is cut square at its work point.
struct MemberSpec {
  joint::NodeSpec node;
  std::size_t member = 0;
  Datum datum = Datum::first_cutter;
  std::optional<Eigen::Vector3d> up = {};  // empty: the member's own
  Angle seam = {};                         // from `up`; if it is empty, from the first cutter
  bevel::TableSpec cut;                    // of both ends, except target and partners
  std::vector<BranchHole> holes;
  double clamping = 0.0, facing = 0.0, density = 7850.0;
};

struct FoundMember {
  PartSpec part;
  std::vector<SectionMark> on_faces = {};  // of a member that is not round: the branches on it
  std::vector<std::size_t> start_cutters, finish_cutters;  // member indices
  std::vector<Warning> warnings;                           // of the node about this member's ends
};

/// Finds the members that cut this member's ends, the branches on it, and its frame in the world.
///
/// Errors    those of joint::solve (members/...); bad_reference_direction (up, datum); no_contact
///           (holes/i/member: that member neither ends on this one nor passes through it);
///           joint_contradicts (holes/i/joint: the members state another).
/// Warnings  joint_not_stated (the branch's own part would not be cut for the hole's joint),
///           hole_missing (a branch that is set in, or passes through, has no hole).
/// Source    docs/theory/parts.md, section 1.
[[nodiscard]] Result<FoundMember> find_member(const MemberSpec& spec);

}  // namespace tubecut::part
