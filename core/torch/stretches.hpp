#pragma once

#include <stop_token>
#include <vector>

#include "core/torch/tabs.hpp"
#include "core/torch/torch_cut.hpp"

namespace tubecut::torch {

/// Whether a cut of a program has tabs; `last`: it is the program's last.
[[nodiscard]] bool holds(const Tabs& tabs, const TorchCut& cut, bool last);

/// The stretches of a cut between its tabs, from its start on: the last tab lies before the start.
/// The others lie evenly along the tip's path, moved no more than a quarter of that off corners. A
/// stretch is come onto square to it, by the lead's radius, and ends where its tab begins: arcs and
/// an overcut would reach over what holds.
///
/// `more`: by how much each tab is wider than `tabs.width`, mm; empty: none is.
///
/// Errors  those of torch_way; out_of_range (tabs/count: they take more than half of the cut),
///         lead_blocked (tabs/width_mm: no way onto the cut leaves so much).
/// Source  docs/theory/pulse-schedules.md, section 11.
[[nodiscard]] Result<std::vector<TorchWay>> ways_between_tabs(const TorchCut& cut,
                                                              const Approach& approach,
                                                              const Tabs& tabs,
                                                              const std::vector<double>& more = {},
                                                              const std::stop_token& stop = {});

/// How much of two ways is looked at beside the tab between them, mm along the tip's path: of the
/// cut that ends there, and of the next one with its way in. Four widths of the tab.
struct BesideTab {
  double end = 0.0, start = 0.0;
};
[[nodiscard]] BesideTab beside_tab(const TorchCut& cut, const Tabs& tabs, const TorchWay& before,
                                   const TorchWay& after);

/// The points of a way within so many mm of its end, the last first, or of its start.
[[nodiscard]] std::vector<motion::CutPoint> near_end(const std::vector<motion::CutPoint>& way,
                                                     double radius, double length, bool end);

/// Metal between the end of a cut at a tab and all that the next stretch cuts, its way in with it,
/// mm, the least of both walls: of every point of either to the other. The kerf is off on both
/// sides. `border`: the cut's torch_border; whole turns between the two play no part.
[[nodiscard]] double metal_between(const motion::PartBorder& border, double kerf,
                                   const std::vector<motion::CutPoint>& end,
                                   const std::vector<motion::CutPoint>& start,
                                   const std::stop_token& stop = {});
/// The same of two ways as they are laid.
[[nodiscard]] double metal_between(const motion::PartBorder& border, const TorchCut& cut,
                                   const Tabs& tabs, const TorchWay& before, const TorchWay& after,
                                   const std::stop_token& stop = {});

}  // namespace tubecut::torch
