#include "core/motion/timing.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/stop.hpp"

namespace tubecut::motion {
namespace {

constexpr double kEdgeShare = 0.6;  // most of the jerk budget given to curvature
constexpr std::size_t kReach = 10;  // intervals over which a round looks for |u_ddot|

/// Intervals that a filter window can reach from each interval.
struct Windows {
  std::vector<std::size_t> low;
  std::vector<std::size_t> high;
};

Windows windows(const std::vector<double>& fastest, double d, double filter) {
  const std::size_t n = fastest.size() - 1;
  std::vector<double> t(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    t[i + 1] = t[i] + 2.0 * d / (std::sqrt(fastest[i]) + std::sqrt(fastest[i + 1]));
  }
  Windows out{std::vector<std::size_t>(n), std::vector<std::size_t>(n)};
  std::size_t low = 0, high = 0;
  for (std::size_t i = 0; i < n; ++i) {
    while (t[low + 1] < t[i] - filter) ++low;
    high = std::max(high, i);
    while (high + 1 < n && t[high + 1] <= t[i + 1] + filter) ++high;
    out.low[i] = low;
    out.high[i] = high;
  }
  return out;
}

Windows around(std::size_t n, std::size_t reach) {
  Windows out{std::vector<std::size_t>(n), std::vector<std::size_t>(n)};
  for (std::size_t i = 0; i < n; ++i) {
    out.low[i] = i < reach ? 0 : i - reach;
    out.high[i] = std::min(n - 1, i + reach);
  }
  return out;
}

/// Largest value of `values` over each window [low[i], high[i]]; both bounds never decrease.
std::vector<double> widened(const std::vector<double>& values, const std::vector<std::size_t>& low,
                            const std::vector<std::size_t>& high, const std::stop_token& stop) {
  std::vector<double> out(low.size());
  std::vector<std::size_t> queue(values.size());  // falling values, candidates of later windows
  std::size_t head = 0, tail = 0, next = 0;
  for (std::size_t i = 0; i < out.size() && !stops(stop, i); ++i) {
    for (; next <= high[i]; ++next) {
      while (tail > head && values[queue[tail - 1]] <= values[next]) --tail;
      queue[tail++] = next;
    }
    while (queue[head] < low[i]) ++head;
    out[i] = values[queue[head]];
  }
  return out;
}

/// What the rows of one round need, everything already the largest over its window.
struct WindowMaxima {
  std::vector<AxisBounds> axes;
  std::vector<double> slowness;
  std::vector<double> optimism;  // the least
  std::vector<double> speed;     // V, of u
};

std::vector<double> over_windows(const std::vector<double>& values, const Windows& w,
                                 const std::stop_token& stop) {
  return widened(values, w.low, w.high, stop);
}

WindowMaxima window_maxima(const PathLimits& limits, const std::vector<double>& fastest,
                           const Optimism& optimism, const Windows& w,
                           const std::stop_token& stop) {
  WindowMaxima out;
  for (const AxisBounds& axis : limits.axes) {
    out.axes.push_back({axis.axis,
                        over_windows(axis.first, w, stop),
                        over_windows(axis.second, w, stop),
                        over_windows(axis.third, w, stop),
                        axis.v_max,
                        axis.a_max,
                        axis.j_max,
                        {}});
  }
  out.slowness = over_windows(limits.slowness, w, stop);
  std::vector<double> values(optimism.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = -optimism[i];
  out.optimism = over_windows(values, w, stop);
  for (double& value : out.optimism) value = -value;
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = std::sqrt(std::max(fastest[i], fastest[i + 1]));
  }
  out.speed = over_windows(values, w, stop);
  return out;
}

enum class Acceleration : std::uint8_t { bounds, has_rows_of_its_own };

/// W0: what filter edges and, by magnitudes, acceleration alone leave of |u_ddot|.
std::vector<double> first_bound(const WindowMaxima& maxima, double filter,
                                Acceleration acceleration, const std::stop_token& stop) {
  std::vector<double> bound(maxima.slowness.size(), 1e150);
  for (std::size_t i = 0; i < bound.size() && !stops(stop, i); ++i) {
    for (const AxisBounds& axis : maxima.axes) {
      if (axis.j_max <= 0.0 || axis.first[i] <= 0.0) continue;
      const double jerk = maxima.optimism[i] * axis.j_max;
      bound[i] = std::min(bound[i], jerk * filter / (2.0 * axis.first[i]));
      if (acceleration == Acceleration::bounds) {
        bound[i] = std::min(bound[i], axis.a_max / axis.first[i]);
      }
    }
  }
  return bound;
}

void tighten(std::vector<double>& bound, const std::vector<double>& x, double d,
             const std::stop_token& stop) {
  std::vector<double> used(bound.size());
  for (std::size_t i = 0; i < used.size(); ++i) used[i] = std::abs(x[i + 1] - x[i]) / (2.0 * d);
  const Windows w = around(used.size(), kReach);
  used = widened(used, w.low, w.high, stop);
  for (std::size_t i = 0; i < bound.size(); ++i) {
    bound[i] = std::min(bound[i], 1.1 * used[i] + 0.02 * bound[i]);
  }
}

void add_jerk_rows(const AxisBounds& axis, std::size_t i, double jerk, double speed,
                   double acceleration, double filter, Rows& rows) {
  const double need =
      (3.0 * axis.second[i] * speed * acceleration + axis.third[i] * speed * speed * speed) / jerk;
  const double share = std::min(need, kEdgeShare);
  rows.add({2.0 * axis.first[i] / filter, 0.0, (1.0 - share) * jerk});
  if (need > kEdgeShare) {
    rows.add({3.0 * axis.second[i] * speed, axis.third[i] * speed, kEdgeShare * jerk});
  }
}

/// |u_ddot| alone, and alpha |u_ddot| + beta x <= c at both knots.
void add_magnitude(const Row& row, double d, HalfPlanes& out) {
  const double pull = row.alpha / (2.0 * d * row.c), weight = row.beta / row.c;
  if (weight == 0.0) {
    out.add(-pull, pull);
    out.add(pull, -pull);
    return;
  }
  for (const double sign : {-pull, pull}) {
    out.add(weight - sign, sign);
    out.add(-sign, weight + sign);
  }
}

void add_scaled(const HalfPlanes& rows, std::size_t i, double scale, HalfPlanes& out) {
  for (std::size_t r = rows.first[i]; r < rows.first[i + 1]; ++r) {
    out.add(scale * rows.rows[r].start, scale * rows.rows[r].end);
  }
}

/// Rows of acceleration as they are, without windows, and those of jerk with them.
HalfPlanes signed_rows(const SignedRows& rows, const WindowMaxima& maxima,
                       const std::vector<double>& bound, const std::vector<double>& wide, double d,
                       double filter, const std::stop_token& stop) {
  HalfPlanes out;
  out.rows.reserve(rows.acceleration.rows.size() + 8 * bound.size());
  for (std::size_t i = 0; i < bound.size() && !stops(stop, i); ++i) {
    add_scaled(rows.acceleration, i, 1.0 / rows.share[i], out);
    Rows jerk;
    for (const AxisBounds& axis : maxima.axes) {
      if (axis.j_max <= 0.0) continue;
      add_jerk_rows(axis, i, maxima.optimism[i] * axis.j_max, maxima.speed[i], wide[i], filter,
                    jerk);
    }
    double most = bound[i];
    for (const Row& row : jerk.rows) {
      if (row.beta > 0.0) add_magnitude(row, d, out);
      if (row.beta == 0.0 && row.alpha > 0.0) most = std::min(most, row.c / row.alpha);
    }
    add_magnitude({1.0, 0.0, most}, d, out);
    out.close_interval();
  }
  return out;
}

Rows round_rows(const WindowMaxima& maxima, const std::vector<double>& bound,
                const std::vector<double>& wide, double filter, const std::stop_token& stop) {
  Rows rows;
  rows.rows.reserve(bound.size() * (3 * maxima.axes.size() + 1));
  for (std::size_t i = 0; i < bound.size() && !stops(stop, i); ++i) {
    rows.add({1.0, 0.0, bound[i]});
    for (const AxisBounds& axis : maxima.axes) {
      if (axis.first[i] <= 0.0 && axis.second[i] <= 0.0 && axis.third[i] <= 0.0) continue;
      rows.add({axis.first[i], axis.second[i], axis.a_max});
      if (axis.j_max <= 0.0) continue;
      add_jerk_rows(axis, i, maxima.optimism[i] * axis.j_max, maxima.speed[i], wide[i], filter,
                    rows);
    }
    rows.close_interval();
  }
  return rows;
}

std::vector<double> round_caps(const WindowMaxima& maxima, const std::vector<double>& fastest) {
  std::vector<double> caps = fastest;
  for (std::size_t i = 0; i < maxima.slowness.size(); ++i) {
    double most = maxima.slowness[i] > 0.0 ? 1.0 / maxima.slowness[i] : 1e150;
    for (const AxisBounds& axis : maxima.axes) {
      if (axis.first[i] > 0.0) most = std::min(most, axis.v_max / axis.first[i]);
    }
    caps[i] = std::min(caps[i], most * most);
    caps[i + 1] = std::min(caps[i + 1], most * most);
  }
  return caps;
}

/// Solves the rows round by round, each with the windows that the profile before leaves.
template <class Solve>
Timing refined(const PathLimits& limits, const std::vector<double>& without_jerk, double filter,
               const Optimism& optimism, int rounds, const Solve& solve,
               const std::stop_token& stop) {
  Timing best{{}, filter, 1e300};
  std::vector<double> fastest = without_jerk;
  std::vector<double> x;
  for (int round = 0; round < rounds && !stop.stop_requested(); ++round) {
    const Windows reach = windows(fastest, limits.d, filter);
    x = solve(window_maxima(limits, fastest, optimism, reach, stop), reach, x, fastest);
    if (stop.stop_requested()) break;
    const double time = duration(x, limits.d) + filter;
    if (time < best.time) best = {x, filter, time};
    for (std::size_t i = 1; i + 1 < x.size(); ++i) {
      fastest[i] = std::min(without_jerk[i], 1.21 * x[i] + 1e-3);
    }
  }
  return best;
}

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

Timing filtered_profile(const PathLimits& limits, const std::vector<double>& without_jerk,
                        double filter, const Optimism& optimism, int rounds,
                        const std::stop_token& stop) {
  const auto solve = [&](const WindowMaxima& maxima, const Windows& reach,
                         const std::vector<double>& before, const std::vector<double>& fastest) {
    std::vector<double> bound = first_bound(maxima, filter, Acceleration::bounds, stop);
    if (!before.empty()) tighten(bound, before, limits.d, stop);
    const Rows rows = round_rows(maxima, bound, over_windows(bound, reach, stop), filter, stop);
    if (stop.stop_requested()) return fastest;
    return largest_profile(round_caps(maxima, fastest), limits.d, rows, stop);
  };
  return refined(limits, without_jerk, filter, optimism, rounds, solve, stop);
}

Timing filtered_signed_profile(const PathLimits& limits, const SignedRows& rows, double filter,
                               const Optimism& optimism, int rounds, const std::stop_token& stop) {
  const auto solve = [&](const WindowMaxima& maxima, const Windows& reach,
                         const std::vector<double>& before, const std::vector<double>& fastest) {
    std::vector<double> bound =
        first_bound(maxima, filter, Acceleration::has_rows_of_its_own, stop);
    if (!before.empty()) tighten(bound, before, limits.d, stop);
    const HalfPlanes all =
        signed_rows(rows, maxima, bound, over_windows(bound, reach, stop), limits.d, filter, stop);
    if (stop.stop_requested()) return fastest;
    return fastest_within(round_caps(maxima, fastest), rows.without_jerk.bound, all, stop);
  };
  return refined(limits, rows.without_jerk.x, filter, optimism, rounds, solve, stop);
}

double periods_of(double time, double period) {
  return std::max(1.0, std::ceil(time / period - 1e-6));
}

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
