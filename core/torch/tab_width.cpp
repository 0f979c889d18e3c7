#include "core/torch/tab_width.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/motion/path/path.hpp"

namespace tubecut::torch {
namespace {

constexpr int kRounds = 12;
constexpr int kInKnot = 4;         // points between two knots of a path, 0.1 mm at most
constexpr double kSampled = 1e-3;  // mm, the bend of a corner between two points or two periods
constexpr double kEnough = 1e-6;   // mm, tolerance of a width

/// Returns the sign of B, as the machine counts it.
double sign_of(const motion::Machine& machine) {
  return machine.b_positive == motion::BPositive::outer_edge_to_waste ? -1.0 : 1.0;
}

/// Returns the points of the smoothed path of one segment, as the torch counts B.
Result<Trail> followed(const ProgramSpec& spec, const ProgramCut& cut, const BesideTab& beside) {
  const auto job = cut_job(spec, cut, 0.0);
  TRY(const auto program, motion::program(job));
  TRY(const auto path, motion::smooth_path(program, job.motion.eps_tip, job.motion.eps_b));
  // A machine that does not swing is square.
  const double sign = motion::Reconstruction(job).knows(2) ? sign_of(spec.machine) : 0.0;
  Trail out(cut.cut.path.radius(), beside.start, beside.end);
  motion::PathCursor cursor(path, false);
  for (std::size_t i = 0; i < path.intervals() && !stops(i); ++i)
    for (int k = i == 0 ? 0 : 1; k <= kInKnot; ++k) {
      const auto x = cursor.at(i, path.d * k / kInKnot).x;
      out.add({.phi = x[0], .z = x[1], .b = sign * x[2]});
    }
  return out;
}

/// Returns how much each tab is narrower than required, mm; negative: wider.
Result<std::vector<double>> lacking(const ProgramSpec& spec, const std::vector<ProgramCut>& cuts,
                                    const motion::PartBorder& border) {
  const auto& tabs = *spec.setup.tabs;
  const auto n = cuts.size();
  std::vector<Trail> trails;
  std::vector<BesideTab> beside;
  for (std::size_t k = 0; k < n; ++k)
    beside.push_back(beside_tab(cuts[k].cut, tabs, cuts[k].way, cuts[(k + 1) % n].way));
  for (std::size_t k = 0; k < n; ++k) {
    TRY(auto trail, followed(spec, cuts[k], {beside[k].end, beside[(k + n - 1) % n].start}));
    trails.push_back(std::move(trail));
  }
  const motion::Reconstruction torch(cut_job(spec, cuts.front(), 0.0));
  std::vector<double> out;
  for (std::size_t k = 0; k < n && !stopped(); ++k) {
    const double metal =
        metal_between(border, cuts[k].cut.kerf, trails[k].end(), trails[(k + 1) % n].start());
    out.push_back(tabs.width + tab_rounding(torch, cuts[k]) + kSampled - metal);
  }
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  return out;
}

}  // namespace

double Trail::step(const motion::CutPoint& from, const motion::CutPoint& to) const {
  return elementary::hypot(radius_ * (to.phi - from.phi), to.z - from.z);
}

void Trail::add(const motion::CutPoint& point) {
  if (!last_.empty()) {
    const double way = step(last_.back(), point);
    const double swung = radius_ * std::abs(point.b - last_.back().b);
    skipped_ = point;
    if (way < kTrail && swung < kTrail) return;
    skipped_.reset();
    gone_ += way;
    kept_ += way;
  }
  if (first_.empty() || gone_ <= start_) first_.push_back(point);
  last_.push_back(point);
  while (last_.size() > 2) {
    const double way = step(last_[0], last_[1]);
    if (kept_ - way <= end_) break;
    kept_ -= way;
    last_.pop_front();
  }
}

std::vector<motion::CutPoint> Trail::end() const {
  std::vector<motion::CutPoint> out;
  if (skipped_) out.push_back(*skipped_);
  out.insert(out.end(), last_.rbegin(), last_.rend());
  return out;
}

double tab_rounding(const motion::Reconstruction& torch, const ProgramCut& cut) {
  const auto& path = cut.cut.path;
  double lean = 0.0;
  for (const auto& point : cut.way.points.points) lean = std::max(lean, std::abs(point.b));
  const auto half = torch.quantum(lean);
  const double cos = elementary::cos(lean);
  const double swing = path.wall * half[2] / (cos * cos);
  return 2.0 * elementary::hypot(path.outer_radius * half[0], half[1] + swing);
}

Result<std::vector<ProgramCut>> followed_cut(const ProgramSpec& spec, const TorchCut& cut,
                                             bool last) {
  if (!spec.setup.tabs || !holds(*spec.setup.tabs, cut, last))
    return program_cut(cut, spec.setup, last, {});
  TRY(const auto border, torch_border(cut));
  std::vector<double> more(static_cast<std::size_t>(spec.setup.tabs->count), 0.0);
  for (int round = 0; round < kRounds; ++round) {
    TRY(auto cuts, program_cut(cut, spec.setup, last, more));
    TRY(const auto lacks, lacking(spec, cuts, border));
    bool enough = true;
    for (std::size_t k = 0; k < lacks.size(); ++k) {
      if (!(lacks[k] > kEnough)) continue;
      more[k] += lacks[k];
      enough = false;
    }
    if (enough) return cuts;
  }
  return fail({.code = ErrorCode::lead_blocked,
               .member = "tabs/width_mm",
               .hint = "no shorter cut leaves a tab of this width"});
}

}  // namespace tubecut::torch
