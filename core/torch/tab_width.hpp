#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/motion/replay/reconstruction.hpp"
#include "core/torch/program_schedule.hpp"
#include "core/torch/stretches.hpp"

namespace tubecut::torch {

/// Keeps the points of a path that lie near its start and near its end, as they arrive in sequence.
/// Points nearer to each other than kTrail are merged.
class Trail {
 public:
  static constexpr double kTrail = 2e-3;  // mm

  /// `radius`: of the surface of the points; `start`, `end`: the lengths of the path that are kept.
  Trail(double radius, double start, double end) : radius_(radius), start_(start), end_(end) {}

  void add(const motion::CutPoint& point);
  [[nodiscard]] const std::vector<motion::CutPoint>& start() const { return first_; }
  /// Returns them, the last first.
  [[nodiscard]] std::vector<motion::CutPoint> end() const;

 private:
  [[nodiscard]] double step(const motion::CutPoint& from, const motion::CutPoint& to) const;

  double radius_, start_, end_;
  double gone_ = 0.0, kept_ = 0.0;  // mm of the path in `first_` and in `last_`
  std::vector<motion::CutPoint> first_ = {};
  std::deque<motion::CutPoint> last_ = {};
  std::optional<motion::CutPoint> skipped_ = {};  // the end of the path if no point follows
};

/// Returns the change of a tab's width by rounding to pulses, mm: half a pulse of every axis, on
/// both sides of it, where that moves an edge most.
[[nodiscard]] double tab_rounding(const motion::Reconstruction& torch, const ProgramCut& cut);

/// Returns the segments of a cut with tabs as its machine follows them. The motion rounds corners
/// and swings B early, within its tolerances, so that a tab between two segments of the polyline
/// may become narrower than their distance. Therefore the cut before such a tab ends earlier, so
/// that the smoothed paths, rounded to pulses, leave the tab's width.
///
/// Errors  as program_cut and motion::smooth_path; lead_blocked (tabs/width_mm): no shorter cut
///         leaves this width.
/// Cost    that of program_cut and of smoothing each segment, two or three times.
/// Source  docs/theory/pulse-schedules.md, section 11.
[[nodiscard]] Result<std::vector<ProgramCut>> followed_cut(const ProgramSpec& spec,
                                                           const TorchCut& cut, bool last);

}  // namespace tubecut::torch
