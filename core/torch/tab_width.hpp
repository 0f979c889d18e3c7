#pragma once

#include <deque>
#include <optional>
#include <stop_token>
#include <vector>

#include "core/motion/replay/reconstruction.hpp"
#include "core/torch/program_schedule.hpp"
#include "core/torch/stretches.hpp"

namespace tubecut::torch {

/// Keeps the points of a way that lie near its start and near its end, as they come one after the
/// other. Points nearer to each other than kTrail are one.
class Trail {
 public:
  static constexpr double kTrail = 2e-3;  // mm

  /// `radius`: of the surface of the points; `start`, `end`: how far along the way they are kept.
  Trail(double radius, double start, double end) : radius_(radius), start_(start), end_(end) {}

  void add(const motion::CutPoint& point);
  [[nodiscard]] const std::vector<motion::CutPoint>& start() const { return first_; }
  /// The last first.
  [[nodiscard]] std::vector<motion::CutPoint> end() const;

 private:
  [[nodiscard]] double step(const motion::CutPoint& from, const motion::CutPoint& to) const;

  double radius_, start_, end_;
  double gone_ = 0.0, kept_ = 0.0;  // mm of the way in `first_` and in `last_`
  std::vector<motion::CutPoint> first_ = {};
  std::deque<motion::CutPoint> last_ = {};
  std::optional<motion::CutPoint> skipped_ = {};  // the way ends there if nothing follows
};

/// What a pulse rounds a tab's width by, mm: half a pulse of every axis, on both sides of it, where
/// that moves an edge most.
[[nodiscard]] double tab_rounding(const motion::Reconstruction& torch, const ProgramCut& cut);

/// The stretches of a cut with tabs as its machine follows them: the motion rounds corners off and
/// swings B early, within its tolerances, so that a tab between two stretches of the polyline may
/// come out narrower than they are apart. The cut before such a tab ends so much earlier that the
/// smoothed paths, rounded to pulses, leave the tab's width.
///
/// Errors  as program_cut and motion::smooth_path; lead_blocked (tabs/width_mm): no shorter cut
///         leaves that much.
/// Cost    that of program_cut and of smoothing each stretch, two or three times.
/// Source  docs/theory/pulse-schedules.md, section 11.
[[nodiscard]] Result<std::vector<ProgramCut>> followed_cut(const ProgramSpec& spec,
                                                           const TorchCut& cut, bool last,
                                                           const std::stop_token& stop = {});

}  // namespace tubecut::torch
