#include "core/motion/timing/timing.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/stop.hpp"
#include "core/motion/timing/window_maxima.hpp"

namespace tubecut::motion {
namespace {

constexpr double kEdgeShare = 0.6;    // maximum fraction of the jerk budget for curvature
constexpr double kFreeTime = 1e150;   // no limit, and its square is still finite
constexpr std::uint32_t kReach = 10;  // intervals over which a round searches for |u_ddot|

/// Computes the intervals that a filter window can reach from each interval; `root` is the speed at
/// the knots.
void reach_of(const std::vector<double>& root, double d, double filter, Windows& out) {
  const std::size_t n = root.size() - 1;
  std::vector<double> t(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) t[i + 1] = t[i] + 2.0 * d / (root[i] + root[i + 1]);
  out.low.resize(n);
  out.high.resize(n);
  std::size_t low = 0, high = 0;
  for (std::size_t i = 0; i < n; ++i) {
    while (t[low + 1] < t[i] - filter) ++low;
    high = std::max(high, i);
    while (high + 1 < n && t[high + 1] <= t[i + 1] + filter) ++high;
    out.low[i] = static_cast<std::uint32_t>(low);
    out.high[i] = static_cast<std::uint32_t>(high);
  }
}

Windows around(std::size_t n, std::uint32_t reach) {
  Windows out{std::vector<std::uint32_t>(n), std::vector<std::uint32_t>(n)};
  for (std::uint32_t i = 0; i < n; ++i) {
    out.low[i] = i < reach ? 0 : i - reach;
    out.high[i] = std::min(static_cast<std::uint32_t>(n - 1), i + reach);
  }
  return out;
}

/// Adds the bound of |u_ddot|, and alpha |u_ddot| + beta x <= c at both knots.
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

}  // namespace

FilteredProfiles::FilteredProfiles(const PathLimits& limits)
    : limits_(limits),
      maxima_(limits),
      beside_(around(limits.intervals(), kReach)),
      root_(limits.intervals() + 1),
      bound_(limits.intervals()),
      used_(limits.intervals()),
      wide_(limits.intervals()) {
  for (std::size_t a = 0; a < maxima_.axes(); ++a) {
    if (a % kPack == 0) {
      for (auto* const packs : {&jerk_, &acceleration_})
        packs->push_back(Pack::Constant(kFreeTime));
      for (auto* const packs : {&per_speed_, &per_acceleration_, &per_jerk_})
        packs->push_back(Pack::Zero());
    }
    if (a >= limits.axes.size()) continue;
    const AxisBounds& axis = limits.axes[a];
    const auto k = static_cast<Eigen::Index>(a % kPack);
    per_speed_.back()[k] = 1.0 / axis.v_max;
    acceleration_.back()[k] = axis.a_max;
    if (axis.j_max <= 0.0) continue;
    per_acceleration_.back()[k] = 1.0 / axis.a_max;
    per_jerk_.back()[k] = 1.0 / axis.j_max;
    jerk_.back()[k] = axis.j_max;
  }
}

/// Finds the maxima over the filter's windows, from the fastest profile so far.
void FilteredProfiles::find_window_maxima(const std::vector<double>& fastest, double filter) {
  for (std::size_t j = 0; j < root_.size(); ++j) root_[j] = std::sqrt(fastest[j]);
  reach_of(root_, limits_.d, filter, windows_);
  for (std::size_t i = 0; i < bound_.size(); ++i) {
    maxima_.set_speed(i, std::max(root_[i], root_[i + 1]));
  }
  maxima_.widen(windows_);
}

/// Bounds |u_ddot| by the filter's edges and, if `by_axes`, by acceleration.
void FilteredProfiles::bound_acceleration(double filter, bool by_axes) {
  for (std::size_t i = 0; i < bound_.size() && !stops(i); ++i) {
    double edges = 0.0, axes = 0.0;  // u_ddot times these is 1
    for (std::size_t a = 0; a < maxima_.axes(); a += kPack) {
      const Pack first = maxima_.first(i, a);
      edges = std::max(edges, (first * per_jerk_[a / kPack]).maxCoeff());
      axes = std::max(axes, (first * per_acceleration_[a / kPack]).maxCoeff());
    }
    edges *= 2.0 / filter;
    const double optimism = maxima_.optimism(i);
    if (!by_axes || axes * optimism <= edges) {
      bound_[i] = edges > 0.0 ? std::min(kFreeTime, optimism / edges) : kFreeTime;
    } else {
      bound_[i] = 1.0 / axes;
    }
  }
}

/// Permits only slightly more than the values that the previous round used nearby.
void FilteredProfiles::tighten(const std::vector<double>& x) {
  for (std::size_t i = 0; i < used_.size(); ++i) {
    used_[i] = std::abs(x[i + 1] - x[i]) / (2.0 * limits_.d);
  }
  widen(used_, beside_, wide_);
  for (std::size_t i = 0; i < bound_.size(); ++i) {
    bound_[i] = std::min(bound_[i], 1.1 * wide_[i] + 0.02 * bound_[i]);
  }
}

/// Computes the jerk rows: curvature takes its part of the budget, up to `kEdgeShare`, from the
/// edges' limit of |u_ddot|; if it needs more, a row is added.
void FilteredProfiles::bound_edges(double filter) {
  widen(bound_, windows_, wide_);
  extra_.clear();
  extra_first_.assign(1, 0);
  for (std::size_t i = 0; i < bound_.size() && !stops(i); ++i) {
    const double speed = maxima_.speed(i), optimism = maxima_.optimism(i);
    double most = bound_[i];
    for (std::size_t a = 0; a < maxima_.axes(); a += kPack) {
      const Pack jerk = optimism * jerk_[a / kPack], twice = 2.0 * maxima_.first(i, a);
      const Pack second = 3.0 * speed * maxima_.second(i, a), third = speed * maxima_.third(i, a);
      const Pack need = second * wide_[i] + third * (speed * speed);
      const Pack left = (jerk - need).max((1.0 - kEdgeShare) * jerk) * filter;
      if ((most * twice > left).any()) most = (left / twice.max(left / kFreeTime)).minCoeff();
      if (!(need > kEdgeShare * jerk).any()) continue;
      for (Eigen::Index k = 0; k < jerk.size(); ++k) {
        if (!(need[k] > kEdgeShare * jerk[k])) continue;
        extra_.push_back({second[k], third[k], kEdgeShare * jerk[k]});
      }
    }
    bound_[i] = most;
    extra_first_.push_back(static_cast<std::uint32_t>(extra_.size()));
  }
}

/// Limits `fastest` to the speeds that every window permits.
std::vector<double> FilteredProfiles::capped(const std::vector<double>& fastest) const {
  std::vector<double> caps = fastest;
  const auto cap = [](double& x, double slowness) {
    if (x * slowness * slowness > 1.0) x = 1.0 / (slowness * slowness);
  };
  for (std::size_t i = 0; i + 1 < caps.size(); ++i) {
    double slowness = maxima_.slowness(i);
    for (std::size_t a = 0; a < maxima_.axes(); a += kPack) {
      slowness = std::max(slowness, (maxima_.first(i, a) * per_speed_[a / kPack]).maxCoeff());
    }
    cap(caps[i], slowness);
    cap(caps[i + 1], slowness);
  }
  return caps;
}

/// Returns the largest x at one knot of interval `i` up to `most`, with `from` at the other. Rows
/// by magnitudes are symmetric in both knots.
double FilteredProfiles::reach(std::size_t i, double from, double most) const {
  const double twice = 2.0 * limits_.d;
  most = std::min(most, from + twice * bound_[i]);
  const auto hold = [&](double alpha, double beta, double c) {
    const double weight = alpha + twice * beta, all = alpha * from + twice * c;
    if (weight * most > all) most = all / weight;
    if (beta * most > c) most = c / beta;
  };
  for (std::size_t a = 0; a < maxima_.axes(); a += kPack) {
    const Pack alpha = maxima_.first(i, a), beta = maxima_.second(i, a);
    const Pack& c = acceleration_[a / kPack];
    const Pack pull = alpha * (most - from), weight = (twice * most) * beta;
    if (!(pull + weight > twice * c || beta * most > c).any()) continue;
    for (Eigen::Index k = 0; k < c.size(); ++k) hold(alpha[k], beta[k], c[k]);
  }
  for (std::size_t r = extra_first_[i]; r < extra_first_[i + 1]; ++r) {
    hold(extra_[r].alpha, extra_[r].beta, extra_[r].c);
  }
  return most;
}

/// Same as `largest_profile`, with its rows read from the maxima.
std::vector<double> FilteredProfiles::passed(std::vector<double> x) const {
  const std::size_t n = limits_.intervals();
  for (std::size_t i = 0; i < n && !stops(i); ++i) x[i + 1] = reach(i, x[i], x[i + 1]);
  for (std::size_t turn = 0; turn < n && !stops(turn); ++turn) {
    const std::size_t i = n - 1 - turn;
    x[i] = reach(i, x[i + 1], x[i]);
  }
  return x;
}

/// Returns the rows of acceleration without windows, and those of jerk with them.
HalfPlanes FilteredProfiles::signed_rows(const SignedRows& rows) const {
  HalfPlanes out;
  // Reserve the maximum, because growth would move everything.
  out.rows.reserve(rows.acceleration.rows.size() + 2 * bound_.size() + 4 * extra_.size());
  out.first.reserve(bound_.size() + 1);
  for (std::size_t i = 0; i < bound_.size() && !stops(i); ++i) {
    add_scaled(rows.acceleration, i, 1.0 / rows.share[i], out);
    for (std::size_t r = extra_first_[i]; r < extra_first_[i + 1]; ++r) {
      if (extra_[r].beta > 0.0) add_magnitude(extra_[r], limits_.d, out);
    }
    add_magnitude({1.0, 0.0, bound_[i]}, limits_.d, out);
    out.close_interval();
  }
  return out;
}

/// Solves the rows round by round, each with the windows of the previous profile, until one is no
/// faster.
template <class Solve>
Timing FilteredProfiles::refined(const std::vector<double>& without_jerk, double filter,
                                 const Optimism& optimism, int rounds, const Solve& solve) {
  Timing best{{}, filter, 1e300};
  std::vector<double> fastest = without_jerk;
  std::vector<double> x;
  for (std::size_t i = 0; i < optimism.size(); ++i) maxima_.set_optimism(i, optimism[i]);
  for (int round = 0; round < rounds && !stopped(); ++round) {
    find_window_maxima(fastest, filter);
    x = solve(x, fastest);
    if (stopped()) break;
    const double time = duration(x, limits_.d) + filter;
    if (!(time < best.time)) break;
    best = {x, filter, time};
    for (std::size_t i = 1; i + 1 < x.size(); ++i) {
      fastest[i] = std::min(without_jerk[i], 1.21 * x[i] + 1e-3);
    }
  }
  return best;
}

Timing FilteredProfiles::by_magnitudes(const std::vector<double>& without_jerk, double filter,
                                       const Optimism& optimism, int rounds) {
  const auto solve = [&](const std::vector<double>& before, const std::vector<double>& fastest) {
    bound_acceleration(filter, true);
    if (!before.empty()) tighten(before);
    bound_edges(filter);
    if (stopped()) return fastest;  // not all rows are present
    return passed(capped(fastest));
  };
  return refined(without_jerk, filter, optimism, rounds, solve);
}

Timing FilteredProfiles::by_signs(const SignedRows& rows, double filter, const Optimism& optimism,
                                  int rounds) {
  const auto solve = [&](const std::vector<double>& before, const std::vector<double>& fastest) {
    bound_acceleration(filter, false);
    if (!before.empty()) tighten(before);
    bound_edges(filter);
    const HalfPlanes all = signed_rows(rows);
    if (stopped()) return fastest;  // not all rows are present
    return fastest_within(capped(fastest), rows.without_jerk.bound, all);
  };
  return refined(rows.without_jerk.x, filter, optimism, rounds, solve);
}

}  // namespace tubecut::motion
