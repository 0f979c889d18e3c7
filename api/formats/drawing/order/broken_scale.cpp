#include "api/formats/drawing/order/broken_scale.hpp"

#include <algorithm>

namespace tubecut::api {
namespace {

constexpr double kBreak = 10.0;    // mm on the sheet, the least width of a gap with a break
constexpr double kReduced = 0.95;  // of a scale, in one step

}  // namespace

BrokenScale::BrokenScale(std::vector<Range> shown, double room, double scale)
    : shown_(std::move(shown)), scale_(scale) {
  std::ranges::sort(shown_);
  const auto all = shown_;
  while (true) {
    shown_ = all;
    join(kBreak / scale_);
    double used = kBreak * static_cast<double>(shown_.size() - 1);
    for (const auto& [from, to] : shown_) used += scale_ * (to - from);
    if (used <= room) break;
    scale_ *= kReduced;
  }
  place(room);
}

/// Merges ranges that lie nearer to each other than `least`.
void BrokenScale::join(double least) {
  std::vector<Range> out;
  for (const auto& one : shown_)
    if (!out.empty() && one.first - out.back().second <= least)
      out.back().second = std::max(out.back().second, one.second);
    else
      out.push_back(one);
  shown_ = std::move(out);
}

/// Draws each gap as wide as the room allows, all gaps up to the same width.
void BrokenScale::place(double room) {
  double whole = 0.0;
  std::vector<double> gaps;
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    whole += scale_ * (shown_[i].second - shown_[i].first);
    if (i > 0) gaps.push_back(scale_ * (shown_[i].first - shown_[i - 1].second));
  }
  // The widest that all gaps may be, found from the narrowest gap on.
  auto sorted = gaps;
  std::ranges::sort(sorted);
  double left = room - whole, widest = 0.0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    widest = left / static_cast<double>(sorted.size() - i);
    if (sorted[i] > widest) break;
    widest = sorted[i];
    left -= sorted[i];
  }
  double at = 0.0;
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    if (i > 0) {
      const double gap = gaps[i - 1], drawn = std::min(gap, widest);
      segments_.push_back({shown_[i - 1].second, shown_[i].first, at, drawn / gap});
      if (drawn < gap * (1.0 - 1e-9)) breaks_.push_back(at + 0.5 * drawn);
      at += drawn;
    }
    segments_.push_back({shown_[i].first, shown_[i].second, at, 1.0});
    at += scale_ * (shown_[i].second - shown_[i].first);
  }
}

double BrokenScale::x(double z) const {
  const auto* segment = &segments_.front();
  for (const auto& one : segments_)
    if (z >= one.from) segment = &one;
  return segment->at + (z - segment->from) * scale_ * segment->shortened;
}

}  // namespace tubecut::api
