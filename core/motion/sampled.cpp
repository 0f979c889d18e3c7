#include <algorithm>
#include <cmath>

#include "core/base/stop.hpp"
#include "core/motion/timing.hpp"

namespace tubecut::motion {
namespace {

using Long = long double;

/// u(t) before the filter, with u_ddot constant on every interval: knot times and, inside an
/// interval, the way gone and its integral.
class Unfiltered {
 public:
  Unfiltered(const std::vector<double>& x, double d)
      : d_(static_cast<Long>(d)), time_(x.size(), 0.0L) {
    speed_.reserve(x.size());
    for (const double square : x) speed_.push_back(std::sqrt(static_cast<Long>(square)));
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      time_[i + 1] = time_[i] + 2.0L * d_ / (speed_[i] + speed_[i + 1]);
    }
  }

  [[nodiscard]] Long end() const { return time_.back(); }
  [[nodiscard]] std::size_t intervals() const { return time_.size() - 1; }
  [[nodiscard]] Long time(std::size_t knot) const { return time_[knot]; }
  /// Moves `i` on to the interval that holds `t`.
  void advance(std::size_t& i, Long t) const {
    while (i + 1 < intervals() && time_[i + 1] <= t) ++i;
  }
  /// Integral over t of the way gone since knot `i`, from that knot's time.
  [[nodiscard]] Long integral(std::size_t i, Long t) const {
    const Long since = t - time_[i];
    return since * since * (0.5L * speed_[i] + since * acceleration(i) / 6.0L);
  }
  [[nodiscard]] Long way(std::size_t i, Long t) const {
    const Long since = t - time_[i];
    return since * (speed_[i] + 0.5L * since * acceleration(i));
  }

 private:
  [[nodiscard]] Long acceleration(std::size_t i) const {
    const Long step = time_[i + 1] - time_[i];
    return (speed_[i + 1] - speed_[i]) / step;
  }
  Long d_;
  std::vector<Long> time_;
  std::vector<Long> speed_;
};

/// Splits the way since knot `i` into interval and offset.
Place place(std::size_t i, Long way, Long d, std::size_t intervals) {
  const auto whole = static_cast<std::size_t>(std::max(0.0L, way / d));
  const std::size_t at = std::min(i + whole, intervals - 1);
  const Long offset = std::clamp(way - d * static_cast<Long>(at - i), 0.0L, d);
  return {static_cast<std::uint32_t>(at), static_cast<double>(offset)};
}

/// The moving average at `t`, summed interval by interval over its window, relative to the window's
/// first knot.
class Averaged {
 public:
  Averaged(const Unfiltered& u, Long d, Long filter) : u_(u), d_(d), filter_(filter) {}

  Place at(Long t) {
    if (filter_ <= 0.0L) {
      u_.advance(first_, t);
      return place(first_, u_.way(first_, std::min(t, u_.end())), d_, u_.intervals());
    }
    const Long from = t - filter_;
    const Long start = std::clamp(from, 0.0L, u_.end());
    const Long stop = std::min(t, u_.end());
    u_.advance(first_, start);
    u_.advance(last_, stop);
    Long sum = -u_.integral(first_, start);
    for (std::size_t i = first_; i < last_; ++i) sum += piece(i, u_.time(i + 1));
    sum += piece(last_, stop);
    sum += (t - stop) * d_ * static_cast<Long>(u_.intervals() - first_);
    // Before the start u is 0, which is the window's first knot as well: nothing to add.
    return place(first_, sum / filter_, d_, u_.intervals());
  }

 private:
  /// Integral over interval `i` up to `t` of u less u at the window's first knot.
  [[nodiscard]] Long piece(std::size_t i, Long t) const {
    return u_.integral(i, t) + (t - u_.time(i)) * d_ * static_cast<Long>(i - first_);
  }
  const Unfiltered& u_;
  Long d_;
  Long filter_;
  std::size_t first_ = 0;
  std::size_t last_ = 0;
};

bool before(const Place& a, const Place& b) {
  return a.interval < b.interval || (a.interval == b.interval && a.offset < b.offset);
}

}  // namespace

std::vector<Place> sampled(const Timing& timing, double d, std::int64_t periods,
                           const std::stop_token& stop) {
  const Unfiltered u(timing.x, d);
  Averaged average(u, static_cast<Long>(d), static_cast<Long>(timing.filter));
  const Long total = u.end() + static_cast<Long>(timing.filter);
  std::vector<Place> places;
  places.reserve(static_cast<std::size_t>(periods) + 1);
  places.push_back({0, 0.0});
  for (std::int64_t k = 1; k < periods && !stops(stop, static_cast<std::size_t>(k)); ++k) {
    const Place next = average.at(total * static_cast<Long>(k) / static_cast<Long>(periods));
    places.push_back(before(next, places.back()) ? places.back() : next);
  }
  places.push_back({static_cast<std::uint32_t>(u.intervals() - 1), d});
  return places;
}

}  // namespace tubecut::motion
