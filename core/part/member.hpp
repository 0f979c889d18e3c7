#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "core/joint/node/node.hpp"
#include "core/part/part.hpp"

namespace tubecut::part {

/// Where phi = 0 lies on a part.
enum class Datum {
  up,           // on the side of a direction (of a part given directly: its own phi = 0)
  seam,         // on the tube's seam, `seam` round from there
  first_cutter  // where the start's first partner has clocking 0; the finish's if it has none
};

/// The part's phi = 0 in the start's frame, from the ends' own partners.
/// Errors  bad_reference_direction (datum: no partner has a side).
[[nodiscard]] Result<Angle> datum_angle(Datum datum, Angle seam,
                                        const std::vector<joint::Partner>& start,
                                        const std::vector<joint::Partner>& finish);

/// A plane square to the axis, `height` from the work point into the member, instead of partners.
[[nodiscard]] EndSpec square_end(const bevel::TableSpec& options, double height);

/// Where the axis of a member that stands on a part of this outer radius leaves its surface; on the
/// nearest side when it passes by. `frame`: of the part's start.
[[nodiscard]] Mark mark_of(const joint::Member& branch, joint::End end,
                           const joint::MemberFrame& frame, double radius);

/// A hole for a member of the node: `cut` but for chord and branch.
struct BranchHole {
  bevel::HoleSpec cut;
  std::size_t branch = 0;
};

/// One member of a node as a part. An end that no member cuts is cut square at its work point.
struct MemberSpec {
  joint::NodeSpec node;
  std::size_t member = 0;
  Datum datum = Datum::first_cutter;
  std::optional<Eigen::Vector3d> up = {};  // empty: the member's own
  Angle seam = {};                         // from `up`, or from the first cutter without one
  bevel::TableSpec cut;                    // of both ends, but for target and partners
  std::vector<BranchHole> holes;
  double clamping = 0.0, facing = 0.0, density = 7850.0;
};

struct FoundMember {
  PartSpec part;
  std::vector<std::size_t> start_cutters, finish_cutters;  // members
  std::vector<Warning> warnings;                           // of the node about this member's ends
};

/// Finds who cuts the member's ends, who stands on it, and its frame in the world.
///
/// Errors    those of joint::solve (members/...); bad_reference_direction (up, datum); no_contact
///           (holes/i/member: that member neither ends on this one nor passes through it);
///           joint_contradicts (holes/i/joint: the members state another).
/// Warnings  joint_not_stated (the hole is for a joint that the branch's own part would not be cut
///           for), hole_missing (a branch that is set in, or passes through, has no hole).
/// Source    docs/theory/parts.md, section 1.
[[nodiscard]] Result<FoundMember> find_member(const MemberSpec& spec,
                                              const std::stop_token& stop = {});

}  // namespace tubecut::part
