#pragma once

#include <cstddef>
#include <optional>
#include <stop_token>
#include <vector>

#include "core/torch/tabs.hpp"
#include "core/torch/torch_cut.hpp"

namespace tubecut::torch {

/// How far the tip stays over the tube between two cuts, mm, where nothing else is asked.
inline constexpr double kClearance = 50.0;

/// What a program does round every cut: pulses and G-code are two printings of it. From the cut
/// before: straight off the tube to the clearance, there turned and moved along it, down to the
/// pierce; then torch, delay, cutting height, lead-in, cut, overcut, lead-out, torch out. Of a mark
/// down to cutting height, the marking tool on, its stroke, the tool off.
struct Setup {
  std::optional<motion::Lead> lead = {};  // empty: straight onto the cut
  std::optional<Angle> start = {};        // of ends; else by itself with a lead, or the first point
  double clearance = kClearance;          // mm, of the tip over the tube
  double cut_height = 0.0;                // mm off the wall along the torch
  std::optional<double> pierce_height = {};  // empty: as it cuts
  double pierce_delay = 0.0;                 // s
  std::optional<Tabs> tabs = {};
  std::optional<double> mark_speed = {};  // mm/s; empty: as it cuts

  [[nodiscard]] double pierce_off() const { return pierce_height.value_or(cut_height); }
};

/// Where a cut of such a program begins. A hole reaches few angles, so that its start is found: its
/// least bevel off its corners and off the seam at phi = 0.
[[nodiscard]] Approach approach(const TorchCut& cut, const Setup& setup);

/// One cut as every printing has it, or a stretch of it from tab to tab.
struct ProgramCut {
  TorchCut cut = {};
  TorchWay way = {};
  std::size_t stretch = 0, stretches = 1;
  motion::Start::At start = motion::Start::At::first_point;  // why it begins where it does

  [[nodiscard]] const motion::CutPoint& first() const { return way.points.points.front(); }
  [[nodiscard]] const motion::CutPoint& last() const { return way.points.points.back(); }
};

/// A cut that has tabs, in its stretches, each named by its number; `last`: of the program. `more`:
/// as of ways_between_tabs.
///
/// Errors  as torch_way and ways_between_tabs; unsupported_combination (tabs of a cut in two
///         passes).
[[nodiscard]] Result<std::vector<ProgramCut>> program_cut(const TorchCut& cut, const Setup& setup,
                                                          bool last,
                                                          const std::vector<double>& more = {},
                                                          const std::stop_token& stop = {});

/// Whole turns of the tube by which each cut's phi goes on from where the cut before left it, the
/// nearest way round: of the cuts in their order.
[[nodiscard]] std::vector<double> windings(const std::vector<ProgramCut>& cuts);

}  // namespace tubecut::torch
