#pragma once

// Computes both ends and the holes of one member in one frame, with lengths, mass and marks.
//
// Idea: each end is a bevel table in its own frame. The partners are rotated first, so that both
// tables have rows at the same phi, and the finish is then seen from the start.
//
// Example: a strut of 60.3 x 4, 800 mm between two parallel chords of 114.3.
//     part::PartSpec spec;
//     spec.target = {60.3 / 2, 4, 800};
//     for (auto* end : {&spec.start, &spec.finish}) {
//       end->cut.target = spec.target;
//       end->cut.partners = {joint::TubeCutter{114.3 / 2}};
//       end->cut.sampling.uniform_points = 360;
//       end->cut.smoothing = bevel::NoSmoothing{};
//     }
//     const auto part = part::part(spec).value();
//     const double longest = part.lengths.longest;  // mm, tip to tip: 698.4

#include <optional>
#include <string>
#include <vector>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"
#include "core/bevel/hole/hole.hpp"
#include "core/bevel/table/table.hpp"
#include "core/cutout/branch_hole.hpp"
#include "core/cutout/cutout.hpp"
#include "core/cutout/text.hpp"
#include "core/joint/placement.hpp"
#include "core/part/cutout_report.hpp"
#include "core/part/dimensions.hpp"

namespace tubecut::part {

/// One requested end. `cut` has target and partners in the end's own frame, as a bevel table takes
/// them: z from the end into the member, phi = 0 on the same side at both ends. Seen from the
/// finish, phi therefore runs in reverse.
struct EndSpec {
  bevel::TableSpec cut;
  bool welded = true;  // false: an end plane without a weld
};

/// A hole of the part. Its branch is given in the start's frame.
struct HoleSpec {
  bevel::HoleSpec hole;
  std::string name = {};  // of the branch
  std::size_t asked = 0;  // index of the caller's request: errors name holes/asked
};

/// A line, point or text to be drawn on the part's outer surface for the fitter.
struct Mark {
  enum class Kind { datum_line, part_mark, partner, text };
  Kind kind = Kind::datum_line;
  std::string text = {};
  double phi = 0.0;  // rad; of a text's anchor
  double z_from = 0.0, z_to = 0.0;
  std::optional<cutout::Lettering> lettering = {};  // of a text
};

/// A hole that is cut as a cut-out, because the branch or the part is not round. The branch is
/// given in the start's frame.
struct SquareHole {
  cutout::Branch branch;
  std::string name = {};  // of the branch
  std::size_t asked = 0;  // index of the caller's request: errors name holes/asked
};

/// The cut-out that a square hole has become; a branch that passes through makes two.
struct HoleCutout {
  std::size_t cutout = 0;  // index in CutoutSpecs::all
  SquareHole hole;
  double greatest_gap = 0.0;  // of its edges from the branch, mm
};

/// Openings for no branch and square holes, how they are cut, and texts.
struct CutoutSpecs {
  std::vector<cutout::Spec> all = {};
  std::vector<HoleCutout> holes = {};
  std::vector<cutout::TextSpec> texts = {};
  double kerf = 0.0;
  double tolerance = 0.01;        // mm, of the straight ways from row to row
  double most_lean = 0.5 * kPi;   // rad, of the torch across
  double most_swing = 0.5 * kPi;  // rad, of the torch to either side along the tube
};

struct PartSpec {
  joint::Target target;  // its length, between the work points, is required
  EndSpec start, finish;
  std::vector<HoleSpec> holes;
  std::vector<SquareHole> square_holes = {};  // those of `cutouts`, see add_square_holes
  CutoutSpecs cutouts = {};
  Angle zero = {};                      // the part's phi = 0, in the start's frame
  joint::MemberFrame start_frame = {};  // of the start, in the world; the identity if unknown
  std::vector<Mark> partners = {};      // in the start's frame
  std::string name = {};
  double clamping = 0.0, facing = 0.0;  // allowances of the blank
  double density = 7850.0;              // kg/m^3
};

/// One end of the finished part.
struct End {
  bevel::TableSpec spec;  // as cut: partners rotated to the part's phi = 0, own frame
  bevel::Table own;       // in the end's own frame
  bevel::Table table;     // in the part's frame; B > 0: the outer edge lies further towards +z
  EdgePoint longest, shortest;  // of the outer edge: furthest from, and nearest to, the other end
  double weld_length = 0.0;     // of the root curve; 0 if nothing is welded
  double groove_volume = 0.0;   // between cut and partners within the wall, mm^3
};

/// A hole in the part's frame; a branch that passes through makes two.
struct PlacedHole {
  bevel::Hole hole;
  std::size_t asked = 0;  // index in PartSpec::holes
};

struct Lengths {
  double work_point = 0.0;
  double longest = 0.0;  // tip to tip, of either wall
  double shortest =
      0.0;  // throat to throat: the length of the full ring; < 0 if there is no full ring
  double blank = 0.0;  // with both kerfs, clamping and facing
  double weld = 0.0;
  double volume = 0.0;  // of the finished part, mm^3
  double mass = 0.0;    // kg
};

/// One operation on the blank, in the order of the list.
struct Step {
  enum class What { mark, hole, cutout, finish, start };
  What what = What::mark;
  std::size_t index = 0;  // of the mark, hole or cut-out
  double z_from = 0.0, z_to = 0.0;
};

struct Part {
  joint::MemberFrame frame;  // of the part in the world, or in the start's frame
  End start, finish;
  std::vector<bevel::HoleSpec> hole_specs;  // rotated, in the start's frame
  std::vector<bevel::HoleCut> hole_cuts;    // in the start's frame
  std::vector<PlacedHole> holes;
  cutout::Layout cutouts;
  CutoutReport cutout_report;
  double clocking = 0.0;  // see clocking_between
  Lengths lengths;
  std::vector<CheckDimension> check_dimensions;
  std::vector<Mark> marks;     // texts last
  std::vector<Step> sequence;  // marks, openings from the finish on, the finish, the start
  std::vector<Warning> warnings;
};

/// Computes both ends and the holes of one member in one frame, with its dimensions.
///
/// Frame   right-handed; z along the member from the start's long point, the lowest of either wall,
///         which has z = 0, to the finish; phi from x towards y, zero at PartSpec::zero. B > 0
///         everywhere: the outer edge lies further towards +z.
/// Errors  those of bevel::table and bevel::hole, under start/..., finish/... and holes/i/...;
///         member_consumed (the two cuts meet); hole_off_part (holes/i: all of it is cut off);
///         those of cutout::lay, check_cutouts, cutout::lay_texts and check_texts; out_of_range (no
///         length).
/// Accuracy  a point's place in the world within 1e-12 of the lengths involved of the end's own.
/// Source  docs/theory/parts.md.
[[nodiscard]] Result<Part> part(const PartSpec& spec);

/// What cut-outs are laid on, once the part's ends are cut.
[[nodiscard]] cutout::Ground cutout_ground(const PartSpec& spec, const Part& part);

/// The part proved from its own numbers: each end's and hole's own proof (the worst of them all),
/// and every point placed by a matrix instead of column by column.
[[nodiscard]] std::vector<Check> verify(const PartSpec& spec, const Part& part);

}  // namespace tubecut::part
