#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/bevel/section/section_table.hpp"
#include "core/bevel/table/table.hpp"
#include "core/motion/path/border.hpp"
#include "core/motion/path/lead.hpp"
#include "core/part/part.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::torch {

/// One cut as the path of the torch: its axis on the outer wall, mm and rad. Or a stroke of a mark:
/// open, with the torch dark.
///
/// Frame   that of its table or part; B > 0: the outer edge lies further towards +z.
struct TorchCut {
  std::string name = {};        // empty: the only one
  motion::CutPath path = {};    // closed, an end from the seam at phi = 0 on; a hole's ends meet
  double kerf = 0.0;            // the path is half of it off the finished edge
  bool counted_inward = false;  // B as published, for comparison: reversed
  double land = 0.0;     // mm: its bevel begins at a land of this height, which it does not cut
  bool of_land = false;  // true for the pass that cuts the land
  bool mark = false;
  bool open = false;     // a slit: from its pierce to its end, without leads
  bool on_flat = false;  // of a section: within a flat, whose normal the torch keeps
  /// Of a prism over corners, cut while the tube is still and the torch runs across: the largest
  /// lean of the torch from the wall's normal, rad.
  std::optional<double> still_lean = {};
  /// Of a cut-out: deep in its scrap, rad and mm on the outside.
  struct Deep {
    double phi = 0.0, z = 0.0;
  };
  std::optional<Deep> centre = {};
};

/// Returns the rows at which a corner of either wall's curve is a node.
[[nodiscard]] std::vector<bool> corner_rows(const bevel::Table& table);

/// Returns the path along which a table's end is cut.
[[nodiscard]] TorchCut torch_cut(const bevel::TableSpec& spec, const bevel::Table& table);
/// Returns the same of a target that is not round: its phi is the girth over
/// `motion::equal_radius`.
[[nodiscard]] TorchCut torch_cut(const section::Section& section, const bevel::TableSpec& spec,
                                 const bevel::SectionTable& table);
/// Returns the cuts of a part in the order of its sequence.
[[nodiscard]] std::vector<TorchCut> torch_cuts(const part::PartSpec& spec, const part::Part& part);
[[nodiscard]] std::vector<TorchCut> torch_cuts(const part::SectionPartSpec& spec,
                                               const part::SectionPart& part);

/// Returns the same with a land's pass before its bevel's. The first pass cuts off all that the
/// second would not hold, and the last cut of a part's sequence releases the part.
///
/// Errors  those of bevel::land_pass; unsupported_combination (root_face): the land is on the last
///         cut of a part.
[[nodiscard]] Result<std::vector<TorchCut>> torch_passes(const bevel::TableSpec& spec,
                                                         const bevel::Table& table);
[[nodiscard]] Result<std::vector<TorchCut>> torch_passes(const part::PartSpec& spec,
                                                         const part::Part& part);

/// The start of a cut and the lead of the torch to it.
struct Approach {
  std::optional<motion::Lead> lead = {};  // empty: straight onto the cut
  motion::Start start = {};
};

/// Minimum radius of a shortened lead, mm, because a shorter arc is no longer than its pierce is
/// wide.
inline constexpr double kShortestLead = 1.0;

/// Distance of the pierce's beam to the finished part, as a fraction of its lead's radius: half of
/// it along a straight edge, less in a hole.
inline constexpr double kPierceOff = 0.25;

/// The path of the torch around one cut, from its pierce to torch off.
struct TorchWay {
  motion::CutWithLead points = {};
  double radius = 0.0;  // of the leads' arcs; less than requested if that would enter the part
};

/// Returns the distance of the pierce to the place where the cut begins, on the outside, mm.
[[nodiscard]] double from_edge(const motion::CutWithLead& way, double outer_radius);

/// Computes the cut from its start on, with leads that are clear of the finished part, and a pierce
/// clear by `kPierceOff`. If the scrap has no room, their radius is halved, down to
/// `kShortestLead`; a cut-out whose middle is further from its edge is pierced there instead.
///
/// Errors  lead_blocked, out_of_range (no point at the requested phi), unsupported_combination (B
///         counted inward has no leads), cancelled; those of motion::track.
/// Source  docs/theory/pulse-schedules.md, section 2.6.
[[nodiscard]] Result<TorchWay> torch_way(const TorchCut& cut, const Approach& approach);

/// Computes the part's border that a cut makes.
///
/// Errors  unsupported_combination (B counted inward); those of motion::part_border.
[[nodiscard]] Result<motion::PartBorder> torch_border(const TorchCut& cut);

/// Adds these leads to a cut, or to a part of it, that already has its direction and start.
///
/// Errors  lead_blocked, cancelled.
[[nodiscard]] Result<TorchWay> way_with_lead(const motion::PartBorder& border,
                                             const motion::Track& from, motion::Lead lead);

}  // namespace tubecut::torch
