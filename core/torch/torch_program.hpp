#pragma once

// Lays out the motion around every cut of a part: start, lead, heights, tabs and pierce.
//
// Idea: pulses and G-code are two outputs of the same program, so both have the same start points,
// leads and heights.
//
// Example: the end of a tube with a lead of 5 mm.
//     bevel::TableSpec spec;
//     spec.target = {60.3 / 2, 4};
//     spec.partners = {joint::TubeCutter{114.3 / 2}};
//     spec.sampling.uniform_points = 360;
//     spec.smoothing = bevel::NoSmoothing{};
//     const auto cut = torch::torch_cut(spec, bevel::table(spec).value());
//     torch::Setup setup;
//     setup.lead = motion::Lead{};
//     const auto program = torch::program_cut(cut, setup, true).value();
//     const auto points = program[0].way.points.points.size();  // 411

#include <cstddef>
#include <optional>
#include <vector>

#include "core/torch/tabs.hpp"
#include "core/torch/torch_cut.hpp"

namespace tubecut::torch {

/// Default height of the tip over the tube between two cuts, mm.
inline constexpr double kClearance = 50.0;

/// The motion of a program around every cut; pulses and G-code are two outputs of it. From the cut
/// before: straight off the tube to the clearance, there turn and move along it, down to the
/// pierce; then torch on, delay, cutting height, lead-in, cut, overcut, lead-out, torch off. For a
/// mark: down to cutting height, the marking tool on, its stroke, the tool off.
struct Setup {
  std::optional<motion::Lead> lead = {};  // empty: straight onto the cut
  std::optional<Angle> start = {};  // of ends; empty: automatic with a lead, else the first point
  double clearance = kClearance;    // mm, of the tip over the tube
  double cut_height = 0.0;          // mm off the wall along the torch
  std::optional<double> pierce_height = {};  // empty: the cutting height
  double pierce_delay = 0.0;                 // s
  std::optional<Tabs> tabs = {};
  std::optional<double> mark_speed = {};  // mm/s; empty: the cutting speed

  [[nodiscard]] double pierce_off() const { return pierce_height.value_or(cut_height); }
};

/// Returns the start of a cut of such a program. A hole covers few angles, so its start is
/// searched: its smallest bevel away from its corners and from the seam at phi = 0.
[[nodiscard]] Approach approach(const TorchCut& cut, const Setup& setup);

/// One cut for every output, or a segment of it from tab to tab.
struct ProgramCut {
  TorchCut cut = {};
  TorchWay way = {};
  std::size_t stretch = 0, stretches = 1;
  motion::Start::At start = motion::Start::At::first_point;  // the reason for its start

  [[nodiscard]] const motion::CutPoint& first() const { return way.points.points.front(); }
  [[nodiscard]] const motion::CutPoint& last() const { return way.points.points.back(); }
};

/// Returns a cut with tabs as its segments, each named by its number; `last`: of the program.
/// `more`: as for ways_between_tabs.
///
/// Errors  as torch_way and ways_between_tabs; unsupported_combination (tabs of a cut in two
///         passes).
[[nodiscard]] Result<std::vector<ProgramCut>> program_cut(const TorchCut& cut, const Setup& setup,
                                                          bool last,
                                                          const std::vector<double>& more = {});

/// Returns the whole revolutions of the tube by which each cut's phi continues from the end of the
/// cut before, by the shortest rotation: of the cuts in their order.
[[nodiscard]] std::vector<double> windings(const std::vector<ProgramCut>& cuts);

}  // namespace tubecut::torch
