#pragma once

#include <string>

#include "api/endpoints/tube_laser.hpp"
#include "api/wire/reader.hpp"
#include "api/wire/writer.hpp"
#include "core/bevel/hole/hole.hpp"

namespace tubecut::api {

struct HoleBranch {
  bevel::BranchPlacement placement = {};
  double wall = 0.0;
  std::string name = {};
};
/// Decodes the branch of a hole: its size and position.
[[nodiscard]] HoleBranch decode_hole_branch(Reader& in);

/// `kind`, `gap_mm`, `depth_mm` and `plane`. A set-in branch goes less deep than the chord's
/// radius; a mitre is one of two members, not of a hole.
[[nodiscard]] joint::Joint decode_joint_kind(Reader& in, double chord_radius, bool of_members);
void encode_joint_kind(const joint::Joint& joint, Writer& o);

/// Decodes `joint`, `groove` and `tilt`; without a `joint` if the members state it.
void decode_hole_cut(Reader& in, double chord_radius, const joint::Joint* stated, Preset preset,
                     bevel::HoleSpec& out);

/// One hole as members of an object.
void encode_hole(const bevel::HoleSpec& spec, const bevel::Hole& hole, Writer& o);

}  // namespace tubecut::api
