#pragma once

#include <vector>

#include "core/torch/tabs.hpp"
#include "core/torch/torch_cut.hpp"

namespace tubecut::torch {

/// Returns true if a cut of a program has tabs; `last`: it is the program's last.
[[nodiscard]] bool holds(const Tabs& tabs, const TorchCut& cut, bool last);

/// Computes the segments of a cut between its tabs, from its start on: the last tab lies before the
/// start. The others are spaced evenly along the tip's path, moved off corners by at most a quarter
/// of that spacing. A segment begins with a lead-in square to it, of the lead's radius, and ends
/// where its tab begins, because arcs and an overcut would cross the tab.
///
/// `more`: additional width of each tab over `tabs.width`, mm; empty: 0.
///
/// Errors  those of torch_way; out_of_range (tabs/count: they take more than half of the cut),
///         lead_blocked (tabs/width_mm: no lead-in leaves this width).
/// Source  docs/theory/pulse-schedules.md, section 11.
[[nodiscard]] Result<std::vector<TorchWay>> ways_between_tabs(const TorchCut& cut,
                                                              const Approach& approach,
                                                              const Tabs& tabs,
                                                              const std::vector<double>& more = {});

/// The lengths of two paths that are checked next to the tab between them, mm along the tip's path:
/// of the cut that ends there, and of the next one with its lead-in. Four widths of the tab.
struct BesideTab {
  double end = 0.0, start = 0.0;
};
[[nodiscard]] BesideTab beside_tab(const TorchCut& cut, const Tabs& tabs, const TorchWay& before,
                                   const TorchWay& after);

/// Returns the points of a path within `length` mm of its end, the last first, or of its start.
[[nodiscard]] std::vector<motion::CutPoint> near_end(const std::vector<motion::CutPoint>& way,
                                                     double radius, double length, bool end);

/// Computes the metal between the end of a cut at a tab and the whole path of the next segment,
/// including its lead-in, mm, the smaller of both walls: over every point of either to the other.
/// The kerf is subtracted on both sides. `border`: the cut's torch_border; whole revolutions
/// between the two are ignored.
[[nodiscard]] double metal_between(const motion::PartBorder& border, double kerf,
                                   const std::vector<motion::CutPoint>& end,
                                   const std::vector<motion::CutPoint>& start);
/// The same for two paths as placed.
[[nodiscard]] double metal_between(const motion::PartBorder& border, const TorchCut& cut,
                                   const Tabs& tabs, const TorchWay& before, const TorchWay& after);

}  // namespace tubecut::torch
