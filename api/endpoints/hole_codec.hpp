#pragma once

#include <string>

#include "api/reader.hpp"
#include "api/writer.hpp"
#include "core/bevel/hole.hpp"

namespace tubecut::api {

struct HoleBranch {
  bevel::BranchPlacement placement = {};
  double wall = 0.0;
  std::string name = {};
};
/// The branch of a hole: its size and where it stands.
[[nodiscard]] HoleBranch decode_hole_branch(Reader& in);

/// `joint`, `groove` and `tilt`. A set-in branch goes less deep than the chord's radius.
void decode_hole_cut(Reader& in, double chord_radius, bevel::HoleSpec& out);

/// One hole as members of an object.
void encode_hole(const bevel::HoleSpec& spec, const bevel::Hole& hole, Writer& o);

}  // namespace tubecut::api
