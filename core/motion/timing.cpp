#include "core/motion/timing.hpp"

#include <algorithm>
#include <cmath>

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

/// What the rows of one round need, everything already the largest over its window.
struct Hats {
  std::vector<AxisBounds> axes;
  std::vector<double> slowness;
  std::vector<double> optimism;  // the least
  std::vector<double> speed;     // V, of u
};

std::vector<double> hat(const std::vector<double>& values, const Windows& w) {
  return widened(values, w.low, w.high);
}

Hats hats(const Limits& limits, const std::vector<double>& fastest, const Optimism& optimism,
          const Windows& w) {
  Hats out;
  for (const AxisBounds& axis : limits.axes) {
    out.axes.push_back({axis.axis, hat(axis.first, w), hat(axis.second, w), hat(axis.third, w),
                        axis.v_max, axis.a_max, axis.j_max});
  }
  out.slowness = hat(limits.slowness, w);
  std::vector<double> values(optimism.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = -optimism[i];
  out.optimism = hat(values, w);
  for (double& value : out.optimism) value = -value;
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = std::sqrt(std::max(fastest[i], fastest[i + 1]));
  }
  out.speed = hat(values, w);
  return out;
}

/// W0: what acceleration and filter edges alone leave of |u_ddot|.
std::vector<double> first_bound(const Hats& hats, double filter) {
  std::vector<double> bound(hats.slowness.size(), 1e150);
  for (std::size_t i = 0; i < bound.size(); ++i) {
    for (const AxisBounds& axis : hats.axes) {
      if (axis.j_max <= 0.0 || axis.first[i] <= 0.0) continue;
      const double jerk = hats.optimism[i] * axis.j_max;
      const double edges = jerk * filter / (2.0 * axis.first[i]);
      bound[i] = std::min({bound[i], axis.a_max / axis.first[i], edges});
    }
  }
  return bound;
}

void tighten(std::vector<double>& bound, const std::vector<double>& x, double d) {
  std::vector<double> used(bound.size());
  for (std::size_t i = 0; i < used.size(); ++i) used[i] = std::abs(x[i + 1] - x[i]) / (2.0 * d);
  const Windows w = around(used.size(), kReach);
  used = widened(used, w.low, w.high);
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

Rows round_rows(const Hats& hats, const std::vector<double>& bound, const std::vector<double>& wide,
                double filter) {
  Rows rows;
  rows.rows.reserve(bound.size() * (3 * hats.axes.size() + 1));
  for (std::size_t i = 0; i < bound.size(); ++i) {
    rows.add({1.0, 0.0, bound[i]});
    for (const AxisBounds& axis : hats.axes) {
      if (axis.first[i] <= 0.0 && axis.second[i] <= 0.0 && axis.third[i] <= 0.0) continue;
      rows.add({axis.first[i], axis.second[i], axis.a_max});
      if (axis.j_max <= 0.0) continue;
      add_jerk_rows(axis, i, hats.optimism[i] * axis.j_max, hats.speed[i], wide[i], filter, rows);
    }
    rows.close_interval();
  }
  return rows;
}

std::vector<double> round_caps(const Hats& hats, const std::vector<double>& fastest) {
  std::vector<double> caps = fastest;
  for (std::size_t i = 0; i < hats.slowness.size(); ++i) {
    double most = hats.slowness[i] > 0.0 ? 1.0 / hats.slowness[i] : 1e150;
    for (const AxisBounds& axis : hats.axes) {
      if (axis.first[i] > 0.0) most = std::min(most, axis.v_max / axis.first[i]);
    }
    caps[i] = std::min(caps[i], most * most);
    caps[i + 1] = std::min(caps[i + 1], most * most);
  }
  return caps;
}

}  // namespace

std::vector<double> widened(const std::vector<double>& values, const std::vector<std::size_t>& low,
                            const std::vector<std::size_t>& high) {
  std::vector<double> out(low.size());
  std::vector<std::size_t> queue(values.size());  // falling values, candidates of later windows
  std::size_t head = 0, tail = 0, next = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (; next <= high[i]; ++next) {
      while (tail > head && values[queue[tail - 1]] <= values[next]) --tail;
      queue[tail++] = next;
    }
    while (queue[head] < low[i]) ++head;
    out[i] = values[queue[head]];
  }
  return out;
}

Timing filtered_profile(const Limits& limits, const std::vector<double>& without_jerk,
                        double filter, const Optimism& optimism, int rounds) {
  Timing best{{}, filter, 1e300};
  std::vector<double> fastest = without_jerk;
  std::vector<double> x;
  for (int round = 0; round < rounds; ++round) {
    const Windows reach = windows(fastest, limits.d, filter);
    const Hats hat_of = hats(limits, fastest, optimism, reach);
    std::vector<double> bound = first_bound(hat_of, filter);
    if (round > 0) tighten(bound, x, limits.d);
    const Rows rows = round_rows(hat_of, bound, hat(bound, reach), filter);
    x = largest_profile(round_caps(hat_of, fastest), limits.d, rows);
    const double time = duration(x, limits.d) + filter;
    if (time < best.time) best = {x, filter, time};
    for (std::size_t i = 1; i + 1 < x.size(); ++i) {
      fastest[i] = std::min(without_jerk[i], 1.21 * x[i] + 1e-3);
    }
  }
  return best;
}

}  // namespace tubecut::motion
