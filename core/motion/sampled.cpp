#include <algorithm>
#include <cmath>

#include "core/motion/timing.hpp"

namespace tubecut::motion {
namespace {

using Long = long double;

/// u(t) before the filter, with u_ddot constant on every interval: knot times and, inside an
/// interval, the way gone and its integral.
class Unfiltered {
 public:
  Unfiltered(const std::vector<double>& x, double d)
      : x_d(static_cast<Long>(d)), x_time(x.size(), 0.0L) {
    x_speed.reserve(x.size());
    for (const double square : x) x_speed.push_back(std::sqrt(static_cast<Long>(square)));
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      x_time[i + 1] = x_time[i] + 2.0L * x_d / (x_speed[i] + x_speed[i + 1]);
    }
  }

  [[nodiscard]] Long end() const { return x_time.back(); }
  [[nodiscard]] std::size_t intervals() const { return x_time.size() - 1; }
  [[nodiscard]] Long time(std::size_t knot) const { return x_time[knot]; }
  /// Moves `i` on to the interval that holds `t`.
  void advance(std::size_t& i, Long t) const {
    while (i + 1 < intervals() && x_time[i + 1] <= t) ++i;
  }
  /// Integral over t of the way gone since knot `i`, from that knot's time.
  [[nodiscard]] Long integral(std::size_t i, Long t) const {
    const Long since = t - x_time[i];
    return since * since * (0.5L * x_speed[i] + since * acceleration(i) / 6.0L);
  }
  [[nodiscard]] Long way(std::size_t i, Long t) const {
    const Long since = t - x_time[i];
    return since * (x_speed[i] + 0.5L * since * acceleration(i));
  }

 private:
  [[nodiscard]] Long acceleration(std::size_t i) const {
    const Long step = x_time[i + 1] - x_time[i];
    return (x_speed[i + 1] - x_speed[i]) / step;
  }
  Long x_d;
  std::vector<Long> x_time;
  std::vector<Long> x_speed;
};

/// Splits the way since knot `i` into interval and offset.
Place place(std::size_t i, Long way, Long d, std::size_t intervals) {
  const auto whole = static_cast<std::size_t>(std::max(0.0L, std::floor(way / d)));
  const std::size_t at = std::min(i + whole, intervals - 1);
  const Long offset = std::clamp(way - d * static_cast<Long>(at - i), 0.0L, d);
  return {static_cast<std::uint32_t>(at), static_cast<double>(offset)};
}

/// The moving average at `t`, summed interval by interval over its window, relative to the window's
/// first knot.
class Averaged {
 public:
  Averaged(const Unfiltered& u, Long d, Long filter) : x_u(u), x_d(d), x_filter(filter) {}

  Place at(Long t) {
    if (x_filter <= 0.0L) {
      x_u.advance(x_first, t);
      return place(x_first, x_u.way(x_first, std::min(t, x_u.end())), x_d, x_u.intervals());
    }
    const Long from = t - x_filter;
    const Long start = std::clamp(from, 0.0L, x_u.end());
    const Long stop = std::min(t, x_u.end());
    x_u.advance(x_first, start);
    x_u.advance(x_last, stop);
    Long sum = -x_u.integral(x_first, start);
    for (std::size_t i = x_first; i < x_last; ++i) sum += piece(i, x_u.time(i + 1));
    sum += piece(x_last, stop);
    sum += (t - stop) * x_d * static_cast<Long>(x_u.intervals() - x_first);
    // Before the start u is 0, which is the window's first knot as well: nothing to add.
    return place(x_first, sum / x_filter, x_d, x_u.intervals());
  }

 private:
  /// Integral over interval `i` up to `t` of u less u at the window's first knot.
  [[nodiscard]] Long piece(std::size_t i, Long t) const {
    return x_u.integral(i, t) + (t - x_u.time(i)) * x_d * static_cast<Long>(i - x_first);
  }
  const Unfiltered& x_u;
  Long x_d;
  Long x_filter;
  std::size_t x_first = 0;
  std::size_t x_last = 0;
};

bool before(const Place& a, const Place& b) {
  return a.interval < b.interval || (a.interval == b.interval && a.offset < b.offset);
}

}  // namespace

std::vector<Place> sampled(const Timing& timing, double d, std::int64_t periods) {
  const Unfiltered u(timing.x, d);
  Averaged average(u, static_cast<Long>(d), static_cast<Long>(timing.filter));
  const Long total = u.end() + static_cast<Long>(timing.filter);
  std::vector<Place> places;
  places.reserve(static_cast<std::size_t>(periods) + 1);
  places.push_back({0, 0.0});
  for (std::int64_t k = 1; k < periods; ++k) {
    const Place next = average.at(total * static_cast<Long>(k) / static_cast<Long>(periods));
    places.push_back(before(next, places.back()) ? places.back() : next);
  }
  places.push_back({static_cast<std::uint32_t>(u.intervals() - 1), d});
  return places;
}

}  // namespace tubecut::motion
