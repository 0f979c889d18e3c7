#include "api/endpoints/cutouts/square_hole.hpp"

#include <algorithm>
#include <string>

#include "api/endpoints/frames/renaming.hpp"
#include "api/endpoints/hole_codec.hpp"
#include "api/endpoints/section_target.hpp"
#include "api/limits.hpp"
#include "core/joint/placement.hpp"

namespace tubecut::api {
namespace {

constexpr Range kComponent{.min = -1e6, .max = 1e6};
constexpr double kAlong = 1e-9;  // of their lengths: two directions are one

struct AxisOf {
  joint::AxisLine operator()(const joint::TubeCutter& tube) const { return joint::axis_of(tube); }
  joint::AxisLine operator()(const joint::AxisTube& tube) const { return tube.axis; }
};

void decode_round_branch(Reader& in, part::SquareHole& out) {
  const auto branch = decode_hole_branch(in);
  out.name = branch.name;
  out.branch.radius = std::visit([](const auto& one) { return one.radius; }, branch.placement);
  out.branch.wall = branch.wall;
  if (in.refused()) return;
  out.branch.axis = std::visit(AxisOf{}, branch.placement);
}

/// Its direction points out of the part; `up` is not along it.
void decode_section_branch(Reader& in, part::SquareHole& out) {
  const auto kind = decode_section_kind(in);
  out.name = in.optional_text("id").value_or("");
  out.branch.section = decode_section(in, kind).section;
  auto& axis = out.branch.axis;
  axis = in.object("axis", [](Reader& a) {
    joint::AxisLine line{a.vector3("point_mm", kOffset), a.vector3("direction", kComponent)};
    if (a.understood("direction") && !(line.direction.norm() > 0.0))
      a.issue({.code = ErrorCode::zero_length,
               .pointer = "direction",
               .got = Json{0.0},
               .limit = Json{0.0},
               .hint = "the vector's length must be greater than the limit"},
              a.find("direction"));
    return line;
  });
  out.branch.up = in.vector3("up", kComponent);
  if (in.refused()) return;
  const auto &up = out.branch.up, &along = axis.direction;
  if (!(up.cross(along).norm() > kAlong * up.norm() * along.norm()))
    in.issue(
        {.code = ErrorCode::bad_reference_direction,
         .pointer = "up",
         .hint = "the branch's height lies across its axis; give a direction that is not along "
                 "it"},
        in.find("up"));
}

/// Replaces the hint of a cut-out that a branch's hole became.
void advise(Issue& issue) {
  const std::string others =
      "set the branch on (joint kind set_on, without a hole), or set it on and give the tube a "
      "cut-out of its own there (cutouts)";
  if (issue.code == ErrorCode::open_profile)
    issue.hint =
        "the hole of this branch reaches beyond the tube's bore; take a narrower branch, " + others;
  if (issue.code == ErrorCode::out_of_range)
    issue.hint =
        "the beam is too wide for a hollow of this branch's hole, whose least radius is half the "
        "kerf, and more where the wall bends, because the beam, square to it, takes more of the "
        "bore; use a smaller kerf_mm, " +
        others;
}

}  // namespace

bool has_section_branch(const Reader& in) {
  const auto* branch = in.find("branch");
  return branch != nullptr && is_section(*branch);
}

part::SquareHole decode_square_hole(Reader& in, double half, std::size_t asked) {
  part::SquareHole out{.branch = {}, .asked = asked};
  const bool section = has_section_branch(in);
  in.object("branch", [&](Reader& b) {
    section ? decode_section_branch(b, out) : decode_round_branch(b, out);
    return 0;
  });
  bevel::HoleSpec cut;
  decode_hole_cut(in, half, nullptr, Preset::tube_laser, cut);
  out.branch.kind = cut.kind;
  out.branch.gap = cut.gap;
  return out;
}

Error on_branches(Error error, const part::CutoutSpecs& cutouts) {
  for (auto& issue : error.issues)
    if (std::ranges::any_of(cutouts.holes, [&](const auto& hole) {
          return is_at(issue.member, cutout::path_of(hole.cutout));
        }))
      advise(issue);
  return error;
}

}  // namespace tubecut::api
