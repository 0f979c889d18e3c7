#pragma once

// Computes both ends of one square, rectangular or oval member in one frame, with lengths, mass
// and the angles at which its faces are cut.
//
// Idea: as of a round part (part.hpp), each end is a bevel table in its own frame. The section has
// both its axes as planes of symmetry, so the finish is the same section with y reversed.
//
// Example: a rail of 60 x 40 x 3 between two others, mitred at both ends.
//     part::SectionPartSpec spec;
//     spec.section = {.height = 60, .width = 40, .wall = 3, .corner = 6, .inner_corner = 3};
//     spec.length = 800;
//     for (auto* end : {&spec.start, &spec.finish}) {
//       end->cut.partners = {joint::PlaneCutter{{0, 0, 0}, {-1, 0, 1}}};
//       end->cut.groove = bevel::SquareCut{};
//       end->cut.contact = bevel::Contact::automatic;
//       end->cut.smoothing = bevel::NoSmoothing{};
//       end->cut.sampling.uniform_points = 360;
//     }
//     const auto part = part::section_part(spec).value();
//     const double top = part.faces[0].length;  // mm, along the middle of face 1: 740

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/bevel/section/section_table.hpp"
#include "core/joint/placement.hpp"
#include "core/part/dimensions.hpp"
#include "core/part/part.hpp"
#include "core/part/section/end_tab.hpp"
#include "core/section/section.hpp"

namespace tubecut::part {

/// A line, point or text to be drawn on the outside for the fitter.
struct SectionMark {
  Mark::Kind kind = Mark::Kind::datum_line;
  std::string text = {};
  double s = 0.0, z_from = 0.0, z_to = 0.0;         // s of a text's anchor
  std::optional<cutout::Lettering> lettering = {};  // of a text
};

struct SectionPartSpec {
  section::Section section;
  double length = 0.0;  // between the work points
  EndSpec start, finish;
  std::vector<EndTab> start_tabs = {}, finish_tabs = {};
  joint::MemberFrame start_frame = {};     // of the start, in the world; the identity if unknown
  std::vector<SectionMark> partners = {};  // in the start's frame
  std::string name = {};
  double clamping = 0.0, facing = 0.0;  // allowances of the blank
  double density = 7850.0;              // kg/m^3
  CutoutSpecs cutouts = {};             // each cut-out on one flat
};

/// A place on the part's outer edge.
struct GirthPoint {
  double s = 0.0, z = 0.0;
};

/// Where an end cuts one face: on the outside, in the part's frame.
struct FaceCut {
  double z = 0.0;  // on the middle of the face
  // Of a face with a flat, rad: of the cut against a square across it, > 0 where z rises with s;
  // and the tilt of a saw's blade on this face if the end is one plane.
  std::optional<double> angle = {}, tilt = {};
};

/// One end of the finished part.
struct SectionEnd {
  bevel::TableSpec spec;
  bevel::SectionTable own;                           // in the end's own frame, with its tabs
  std::optional<bevel::SectionTable> shoulder = {};  // the same without tabs, if it has any
  bevel::SectionTable table;     // in the part's frame; B > 0: outer edge further towards +z
  GirthPoint longest, shortest;  // of the outer edge: furthest from, and nearest to, the other end
  double weld_length = 0.0;      // of the root curve; 0 if nothing is welded
  double groove_volume = 0.0;    // between cut and partners within the wall, mm^3
  std::array<FaceCut, 4> faces;  // faces 1 to 4
  std::array<double, 4> corners{};  // z at their middles
};

/// The part along one face and along the corner that follows it, outside, mm.
struct FaceLength {
  double length = 0.0, corner = 0.0;
};

struct SectionPart {
  joint::MemberFrame frame;  // of the part in the world, or in the start's frame
  SectionEnd start, finish;
  double clocking = 0.0;  // see clocking_between
  Lengths lengths;
  std::array<FaceLength, 4> faces;
  std::vector<CheckDimension> check_dimensions;
  std::vector<SectionMark> marks;  // texts last
  cutout::Layout cutouts = {};
  CutoutReport cutout_report = {};
  std::vector<Step> sequence;
  std::vector<Warning> warnings;
};

/// Computes both ends of a member that is not round, in one frame, with its dimensions.
///
/// Frame   that of the start, moved so that the lowest point of the start, of either wall, has
///         z = 0: x along the section's height, the datum line in the middle of face 1. At the
///         finish, the same faces have the same numbers. B > 0 everywhere: the outer edge lies
///         further towards +z.
/// Errors  those of bevel::section_table, under start/... and finish/...; member_consumed (the two
///         cuts meet); those of cutout::lay, check_cutouts, cutout::lay_texts and check_texts.
/// Accuracy  a point's place in the world within 1e-12 of the lengths involved of the end's own;
///           volumes within 1e-9 of themselves of the surface between the rows.
/// Source  docs/theory/parts.md; docs/theory/sections.md, sections 8 and 9.
[[nodiscard]] Result<SectionPart> section_part(const SectionPartSpec& spec);

/// Returns what cut-outs are laid on, once the part's ends are cut.
[[nodiscard]] cutout::Ground cutout_ground(const SectionPartSpec& spec, const SectionPart& part);

/// Verifies the part from its own numbers: each end's checks (the worst of both), every point
/// placed by a matrix, the volume by facets.
[[nodiscard]] std::vector<Check> verify(const SectionPartSpec& spec, const SectionPart& part);

/// Transforms a finish's table into the start's frame, `length` away: see seen_from_start of a
/// round tube's table.
[[nodiscard]] bevel::SectionTable seen_from_start(const section::Wall& wall,
                                                  const bevel::SectionTable& finish, double length);
/// Moves all z by `dz`.
[[nodiscard]] bevel::SectionTable shifted(bevel::SectionTable table, double dz);

/// Returns an edge of a table over the share of the girth, in rad of the whole turn.
[[nodiscard]] Edge edge_over_girth(const bevel::SectionTable& table, const std::vector<double>& z);

/// Computes the volume of the wall below an end's cut, down to z = 0, mm^3.
/// Accuracy  1e-12 of itself on flats and concentric arcs, 1e-9 where the wall varies.
[[nodiscard]] double end_volume(const section::Wall& wall, const bevel::TableSpec& spec,
                                const bevel::SectionTable& table);
/// Computes the volume between an end's cut and its partners' metal, as `groove_volume` of a round
/// tube.
[[nodiscard]] double groove_volume(const section::Wall& wall, const bevel::TableSpec& spec,
                                   const bevel::SectionTable& table);

/// The finished part as an operator sees it: two closed edges at each end, over the share of the
/// girth.
struct SectionShape {
  section::Section section;
  Edge start_outer, start_inner, finish_outer, finish_inner;
  bool start_root_outer = false, finish_root_outer = false;
};
/// Returns up to 14 dimensions, as `check_dimensions` of a round part. If cancelled, returns fewer
/// mistakes.
[[nodiscard]] std::vector<CheckDimension> check_dimensions(const SectionShape& shape);

}  // namespace tubecut::part
