#pragma once

#include <cstddef>
#include <optional>
#include <stop_token>
#include <vector>

#include "core/torch/torch_cut.hpp"

namespace tubecut::torch {

/// How far the tip stays over the tube between two cuts, mm, where nothing else is asked.
inline constexpr double kClearance = 50.0;

/// What a program does round every cut: pulses and G-code are two printings of it. From the cut
/// before: straight off the tube to the clearance, there turned and moved along it, down to the
/// pierce; then torch, delay, cutting height, lead-in, cut, overcut, lead-out, torch out.
struct Setup {
  std::optional<motion::Lead> lead = {};  // empty: straight onto the cut
  std::optional<Angle> start = {};        // of ends; else by itself with a lead, or the first point
  double clearance = kClearance;          // mm, of the tip over the tube
  double cut_height = 0.0;                // mm off the wall along the torch
  std::optional<double> pierce_height = {};  // empty: as it cuts
  double pierce_delay = 0.0;                 // s

  [[nodiscard]] double pierce_off() const { return pierce_height.value_or(cut_height); }
};

/// Where a cut of such a program begins. A hole reaches few angles, so that its start is found: its
/// least bevel off its corners and off the seam at phi = 0.
[[nodiscard]] Approach approach(const TorchCut& cut, const Setup& setup);

/// One cut as every printing has it.
struct ProgramCut {
  TorchCut cut = {};
  TorchWay way = {};
  motion::Start::At start = motion::Start::At::first_point;  // why it begins where it does

  [[nodiscard]] const motion::CutPoint& first() const { return way.points.points.front(); }
  [[nodiscard]] const motion::CutPoint& last() const { return way.points.points.back(); }
};

/// Errors  as torch_way.
[[nodiscard]] Result<ProgramCut> program_cut(TorchCut cut, const Setup& setup,
                                             const std::stop_token& stop = {});

/// Whole turns of the tube by which each cut's phi goes on from where the cut before left it, the
/// nearest way round: of the cuts in their order.
[[nodiscard]] std::vector<double> windings(const std::vector<ProgramCut>& cuts);

}  // namespace tubecut::torch
