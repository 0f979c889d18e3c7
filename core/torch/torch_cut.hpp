#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "core/bevel/table/table.hpp"
#include "core/motion/path/border.hpp"
#include "core/motion/path/lead.hpp"
#include "core/part/part.hpp"

namespace tubecut::torch {

/// One cut as the torch goes round it: its axis on the outer wall, mm and rad. Or a stroke of a
/// mark: open, and the torch dark.
///
/// Frame   that of the table or part it is of; B > 0: the outer edge lies further towards +z.
struct TorchCut {
  std::string name = {};        // empty: the only one
  motion::CutPath path = {};    // closed, an end from the seam at phi = 0 on; a hole's ends meet
  double kerf = 0.0;            // the path is half of it off the finished edge
  bool counted_inward = false;  // B as published, for comparison: the other way round
  double land = 0.0;     // mm: its bevel stands on a land of this height, which it does not cut
  bool of_land = false;  // the pass that does
  bool mark = false;
};

/// The rows at which a corner of either wall's curve is a node.
[[nodiscard]] std::vector<bool> corner_rows(const bevel::Table& table);

/// What a table's end is cut along.
[[nodiscard]] TorchCut torch_cut(const bevel::TableSpec& spec, const bevel::Table& table);
/// The cuts of a part in the order of its sequence.
[[nodiscard]] std::vector<TorchCut> torch_cuts(const part::PartSpec& spec, const part::Part& part);

/// The same with a land's pass before its bevel's. The first pass cuts off what the second has no
/// hold on: a part is let go by the last cut of its sequence.
///
/// Errors  those of bevel::land_pass; unsupported_combination (root_face): the land is the last
///         cut's of a part.
[[nodiscard]] Result<std::vector<TorchCut>> torch_passes(const bevel::TableSpec& spec,
                                                         const bevel::Table& table,
                                                         const std::stop_token& stop = {});
[[nodiscard]] Result<std::vector<TorchCut>> torch_passes(const part::PartSpec& spec,
                                                         const part::Part& part,
                                                         const std::stop_token& stop = {});

/// Where a cut begins and how the torch comes to it.
struct Approach {
  std::optional<motion::Lead> lead = {};  // empty: straight onto the cut
  motion::Start start = {};
};

/// Least radius that a lead is shortened to, mm: an arc of less is no longer than its pierce is
/// wide.
inline constexpr double kShortestLead = 1.0;

/// How far the pierce's beam stays off the finished part, of its lead's radius: half of it along a
/// straight edge, less in a hole.
inline constexpr double kPierceOff = 0.25;

/// The way of the torch round one cut, from its pierce to where it is put out.
struct TorchWay {
  motion::CutWithLead points = {};
  double radius = 0.0;  // of the leads' arcs; less than asked where that would enter the part
};

/// The cut from its start on, with leads that stay clear of the finished part, and the
/// pierce by `kPierceOff`: their radius halved, down to `kShortestLead`, where the scrap has no
/// room for them.
///
/// Errors  lead_blocked, out_of_range (no point at the asked phi), unsupported_combination
///         (B counted inward has no leads), cancelled; those of motion::track.
/// Source  docs/theory/pulse-schedules.md, section 2.6.
[[nodiscard]] Result<TorchWay> torch_way(const TorchCut& cut, const Approach& approach,
                                         const std::stop_token& stop = {});

/// The part's border that a cut makes.
///
/// Errors  unsupported_combination (B counted inward); those of motion::part_border.
[[nodiscard]] Result<motion::PartBorder> torch_border(const TorchCut& cut,
                                                      const std::stop_token& stop = {});

/// Such leads on a cut, or a stretch of it, that is directed and begins where it should.
///
/// Errors  lead_blocked, cancelled.
[[nodiscard]] Result<TorchWay> way_with_lead(const motion::PartBorder& border,
                                             const motion::Track& from, motion::Lead lead,
                                             const std::stop_token& stop = {});

}  // namespace tubecut::torch
