#include "core/motion/timing/window_maxima.hpp"

#include <algorithm>
#include <limits>

#include "core/base/stop.hpp"

namespace tubecut::motion {

void widen(const std::vector<double>& values, const Windows& w, std::vector<double>& out) {
  const std::size_t n = w.low.size();
  out.resize(n);
  std::vector<std::uint32_t> queue(values.size());  // falling values, candidates of later windows
  std::size_t head = 0, tail = 0;
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < n && !stops(i); ++i) {
    for (; next <= w.high[i]; ++next) {
      while (tail > head && values[queue[tail - 1]] <= values[next]) --tail;
      queue[tail++] = next;
    }
    while (queue[head] < w.low[i]) ++head;
    out[i] = values[queue[head]];
  }
}

WindowMaxima::WindowMaxima(const PathLimits& limits)
    : axes_((limits.axes.size() + kPack - 1) / kPack * kPack),
      slowness_(3 * axes_),
      optimism_(slowness_ + 1),
      speed_(optimism_ + 1),
      width_((speed_ / kPack + 1) * kPack) {
  for (auto* const of : {&rows_, &maxima_}) of->reserve(limits.intervals() * width_);
  for (std::size_t i = 0; i < limits.intervals(); ++i) {
    // Row by row, with more frequent checks, because all at once takes tens of milliseconds, and
    // the first access to a page of 2 MiB up to eight.
    if (i % 128 == 0 && stopped()) return;
    for (auto* const of : {&rows_, &maxima_}) of->resize((i + 1) * width_, 0.0);
    double* const row = at(rows_, i);
    for (std::size_t a = 0; a < limits.axes.size(); ++a) {
      row[a] = limits.axes[a].first[i];
      row[axes_ + a] = limits.axes[a].second[i];
      row[2 * axes_ + a] = limits.axes[a].third[i];
    }
    row[slowness_] = limits.slowness[i];
  }
}

void WindowMaxima::raise(const double* a, const double* b, double* to) const {
  for (std::size_t k = 0; k < width_; k += kPack) {
    Eigen::Map<Pack>(to + k) = Eigen::Map<const Pack>(a + k).max(Eigen::Map<const Pack>(b + k));
  }
}

/// A window consists of the rows before a pivot, whose maxima up to it are stored for every row,
/// and the rows after it, of which one maximum is kept. When the pivot leaves the window, the
/// window's last row becomes the next one.
void WindowMaxima::widen(const Windows& w) {
  const std::vector<double> none(width_, -std::numeric_limits<double>::infinity());
  std::vector<double> tail = none;
  std::size_t pivot = 0, base = 0, next = 0;
  for (std::size_t i = 0; i < w.low.size() && !stops(i); ++i) {
    for (; next <= w.high[i]; ++next) raise(tail.data(), at(rows_, next), tail.data());
    if (w.low[i] >= pivot) {
      pivot = next;
      base = w.low[i];
      heads_.resize(std::max(heads_.size(), (pivot - base) * width_));
      const double* ahead = none.data();
      for (std::size_t j = pivot; j-- > base;) {
        raise(ahead, at(rows_, j), at(heads_, j - base));
        ahead = at(heads_, j - base);
      }
      tail = none;
    }
    raise(at(heads_, w.low[i] - base), tail.data(), at(maxima_, i));
  }
}

}  // namespace tubecut::motion
