#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "core/joint/node.hpp"
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

/// One member of a node as a part. An end that no member cuts is cut square at its work point.
struct MemberSpec {
  joint::NodeSpec node;
  std::size_t member = 0;
  Datum datum = Datum::first_cutter;
  std::optional<Eigen::Vector3d> up = {};  // empty: the member's own
  Angle seam = {};                         // from `up`, or from the first cutter without one
  bevel::TableSpec cut;                    // of both ends, but for target and partners
  std::vector<bevel::HoleSpec> holes;      // but for chord and branch
  std::vector<std::size_t> branches;       // the member each hole is for
  double clamping = 0.0, facing = 0.0, density = 7850.0;
};

struct FoundMember {
  PartSpec part;
  std::vector<std::size_t> start_cutters, finish_cutters;  // members
  std::vector<Warning> warnings;                           // of the node about this member's ends
};

/// Finds who cuts the member's ends, who stands on it, and its frame in the world.
///
/// Errors  those of joint::solve (members/...); bad_reference_direction (up, datum); no_contact
///         (holes/i/member: that member neither ends on this one nor passes through it).
/// Source  docs/theory/parts.md, section 1.
[[nodiscard]] Result<FoundMember> find_member(const MemberSpec& spec,
                                              const std::stop_token& stop = {});

}  // namespace tubecut::part
