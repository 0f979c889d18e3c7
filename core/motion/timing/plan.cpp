#include "core/motion/timing/plan.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"

namespace tubecut::motion {
namespace {

constexpr int kFullRounds = 4;
constexpr double kAccepted = 1.0 + 1e-9;
constexpr double kJerkRelief = 0.97;

// For the ladder of filters.
constexpr int kProvenAfter =
    7;  // passes; after them a violated position goes directly to the proven rows
constexpr int kMostPasses = 40;                // after them, every interval does
constexpr double kNothingToGain = 1.0 + 1e-4;  // of the optimum without jerk limits

// For the plan by signed rows.
constexpr int kMostSignedPasses = 20;  // after them, the filter is given up
constexpr double kStart = 3.0;         // optimism of the jerk rows
constexpr double kLeast = 0.3;         // minimum, relative to the rows of a proof
constexpr double kShareRelief = 0.995;
constexpr double kWorthwhile = 0.999;  // of the previous time, to continue with the next filter
constexpr double kCancels = 1.01;      // above it, sums of magnitudes are too strict

constexpr double kLastCheck = 1.0 + 1e-8;

/// Returns the length in periods of the filter with the smallest `time_of`: octave by octave from
/// the longest that any axis can use down to one period, until two in sequence are slower than the
/// best.
double best_octave(const Course& course, const std::function<double(double)>& time_of) {
  const double period = course.machine.period;
  double longest = 0.0;
  for (const AxisBounds& axis : course.limits.axes) {
    if (axis.j_max > 0.0) longest = std::max(longest, 2.0 * axis.a_max / axis.j_max);
  }
  double best_count = 1.0, best_time = 1e300;
  int slower = 0;
  for (double ideal = longest / period;; ideal *= 0.5) {
    const double count = std::max(1.0, std::floor(ideal + 0.5));
    const double time = time_of(count * period);
    slower = time < best_time ? 0 : slower + 1;
    if (slower == 0) {
      best_time = time;
      best_count = count;
    }
    if (slower == 2 || count <= 1.0 || stopped()) return best_count;
  }
}

/// Calls `lower(i)` for every interval that the filter window of sample `k` can reach.
void for_reach_of(const std::vector<PathPosition>& positions, std::size_t k, std::size_t reach,
                  std::size_t intervals, const std::function<void(std::size_t)>& lower) {
  const std::size_t from = positions[k < reach ? 0 : k - reach].interval;
  const std::size_t to = positions[std::min(positions.size() - 1, k + reach)].interval;
  for (std::size_t i = from == 0 ? 0 : from - 1; i <= std::min(intervals - 1, to + 1); ++i) {
    lower(i);
  }
}

/// One search over the ladder of filters for one optimism.
class LadderSearch {
 public:
  LadderSearch(const Course& course, const PlanOptions& options, FilteredProfiles& profiles,
               const std::vector<double>& without_jerk)
      : course_(course),
        options_(options),
        profiles_(profiles),
        without_jerk_(without_jerk),
        least_(duration(without_jerk, course.limits.d)) {}

  /// Returns the fastest timing that is faster than `bound` seconds; x is empty if there is none.
  Timing best(double optimism, double bound) {
    Timing found{{}, 0.0, bound};
    for (const double filter : filters(optimism)) {
      if (stopped()) break;
      Timing next = repaired(filter, optimism, found.time);
      if (next.time < found.time) found = std::move(next);
      if (good_enough(found)) break;
    }
    return found;
  }

  /// Returns true if no other filter or optimism could save more than a part in ten thousand.
  [[nodiscard]] bool good_enough(const Timing& timing) const {
    return timing.time <= kNothingToGain * least_;
  }

 private:
  [[nodiscard]] double period() const { return course_.machine.period; }

  [[nodiscard]] Timing profile(double filter, const Optimism& optimism, int rounds) const {
    return profiles_.by_magnitudes(without_jerk_, filter, optimism, rounds);
  }

  /// Tries every octave with one round, then returns the best and its neighbours.
  std::vector<double> filters(double optimism) const {
    if (options_.filter) return {*options_.filter};
    const Optimism level(course_.limits.intervals(), optimism);
    return neighbours(
        best_octave(course_, [&](double filter) { return profile(filter, level, 1).time; }));
  }

  [[nodiscard]] std::vector<double> neighbours(double count) const {
    std::vector<double> out{count * period()};
    for (const double factor : {0.70710678118654752, 1.4142135623730951}) {
      const double next = std::max(1.0, std::floor(count * factor + 0.5));
      if (next != count) out.push_back(next * period());
    }
    return out;
  }

  /// Lowers the optimism where a sample breaks its jerk limit, until none does. It ends, because
  /// every pass lowers some of it and the proven level breaks no limit.
  Timing repaired(double filter, double level, double bound) const {
    Optimism optimism(course_.limits.intervals(), level);
    for (int pass = 1;; ++pass) {
      Timing timing = profile(filter, optimism, kFullRounds);
      const bool proven = std::ranges::all_of(optimism, [](double o) { return o <= 1.0; });
      if (timing.time >= bound || proven || stopped()) return timing;
      const auto count = static_cast<std::int64_t>(periods_of(timing.time, period()));
      const std::vector<PathPosition> positions = sampled(timing, course_.limits.d, count);
      const std::vector<double> ratio = ratios(course_, positions).jerk;
      if (*std::ranges::max_element(ratio) <= kAccepted) return timing;
      if (pass >= kMostPasses) {
        std::ranges::fill(optimism, 1.0);
      } else {
        lower(optimism, positions, ratio, filter, pass >= kProvenAfter);
      }
    }
  }

  void lower(Optimism& optimism, const std::vector<PathPosition>& positions,
             const std::vector<double>& ratio, double filter, bool to_proven) const {
    const auto reach = static_cast<std::size_t>(std::ceil(filter / period())) + 3;
    const Optimism before = optimism;
    for (std::size_t k = 0; k < ratio.size() && !stops(k); ++k) {
      if (ratio[k] <= kAccepted) continue;
      for_reach_of(positions, k, reach, optimism.size(), [&](std::size_t i) {
        const double next = to_proven ? 1.0 : std::max(1.0, kJerkRelief * before[i] / ratio[k]);
        optimism[i] = std::min(optimism[i], next);
      });
    }
  }

  const Course& course_;
  const PlanOptions& options_;
  FilteredProfiles& profiles_;
  const std::vector<double>& without_jerk_;
  double least_;
};

/// Repairs plans by signed rows, filter by filter.
class SignedSearch {
 public:
  SignedSearch(const Course& course, FilteredProfiles& profiles, SignedRows rows)
      : course_(course), profiles_(profiles), rows_(std::move(rows)) {}

  Timing best(double bound) {
    const Optimism level(intervals(), kStart);
    rows_.share.assign(intervals(), 1.0);
    const double count = best_octave(
        course_, [&](double filter) { return profiles_.by_signs(rows_, filter, level, 1).time; });
    Timing found{{}, 0.0, bound};
    step_to(count, found);
    climb(count, longer, found);
    climb(count, shorter, found);
    return found;
  }

 private:
  [[nodiscard]] std::size_t intervals() const { return course_.limits.intervals(); }
  [[nodiscard]] double period() const { return course_.machine.period; }

  static double longer(double count) {
    return std::max(count + 1.0, std::floor(count * std::numbers::sqrt2 + 0.5));
  }
  static double shorter(double count) {
    return std::min(count - 1.0, std::floor(count / std::numbers::sqrt2 + 0.5));
  }

  /// Returns true if the search should continue from a filter of `count` periods.
  bool step_to(double count, Timing& found) {
    Timing next = repaired(count * period(), found.time);
    const bool better = next.time < kWorthwhile * found.time;
    if (next.time < found.time) found = std::move(next);
    return better;
  }

  /// Continues until two filters in sequence save nothing.
  void climb(double count, double (*next)(double), Timing& found) {
    for (int idle = 0; idle < 2 && !stopped();) {
      count = next(count);
      if (count < 1.0) return;
      idle = step_to(count, found) ? 0 : idle + 1;
    }
  }

  /// Lowers the rows' permission where a sample breaks a limit, until none does.
  Timing repaired(double filter, double bound) {
    Optimism optimism(intervals(), kStart);
    rows_.share.assign(intervals(), 1.0);
    for (int pass = 0; pass < kMostSignedPasses && !stopped(); ++pass) {
      Timing timing = profiles_.by_signs(rows_, filter, optimism, kFullRounds);
      if (timing.time >= bound || stopped()) break;
      const auto count = static_cast<std::int64_t>(periods_of(timing.time, period()));
      const std::vector<PathPosition> positions = sampled(timing, course_.limits.d, count);
      if (!lower(optimism, positions, ratios(course_, positions), filter)) return timing;
    }
    return {{}, filter, 1e300};
  }

  /// Returns false when nothing had to be lowered.
  bool lower(Optimism& optimism, const std::vector<PathPosition>& positions, const Ratios& ratio,
             double filter) {
    const auto reach = static_cast<std::size_t>(std::ceil(filter / period())) + 3;
    const std::vector<double> optimism_before = optimism, share_before = rows_.share;
    bool lowered = false;
    for (std::size_t k = 0; k < positions.size() && !stops(k); ++k) {
      const double jerk = ratio.jerk[k], acceleration = ratio.acceleration[k];
      if (jerk <= kAccepted && acceleration <= kAccepted) continue;
      lowered = true;
      for_reach_of(positions, k, reach, intervals(), [&](std::size_t i) {
        if (jerk > kAccepted) {
          const double next = std::max(kLeast, kJerkRelief * optimism_before[i] / jerk);
          optimism[i] = std::min(optimism[i], next);
        }
        if (acceleration > kAccepted) {
          rows_.share[i] = std::min(rows_.share[i], kShareRelief * share_before[i] / acceleration);
        }
      });
    }
    return lowered;
  }

  const Course& course_;
  FilteredProfiles& profiles_;
  SignedRows rows_;
};

/// Finds the fastest plan by signed rows that is faster than `bound` seconds and whose samples keep
/// every limit of acceleration and jerk; x is empty if there is none.
///
/// Source  docs/theory/pulse-schedules.md, section 6.3.
Timing best_by_signed_rows(const Course& course, FilteredProfiles& profiles,
                           const Profile& without_jerk, HalfPlanes acceleration, double bound) {
  return SignedSearch(course, profiles, {std::move(acceleration), without_jerk, {}}).best(bound);
}

bool any_jerk(const PathLimits& limits) {
  return std::ranges::any_of(limits.axes, [](const AxisBounds& axis) { return axis.j_max > 0.0; });
}

/// Samples the plan and stretches it while a limit is broken; a stretch by K divides v, a, j by K,
/// K^2, K^3.
Result<void> settle(Plan& out, const Course& course, const PlanOptions& options, bool jerk) {
  for (;;) {
    const double periods = periods_of(out.timing.time * out.stretch, course.machine.period);
    if (!(periods <= static_cast<double>(options.max_periods)))
      return too_many_periods(periods, options.max_periods);
    out.positions = sampled(out.timing, course.limits.d, static_cast<std::int64_t>(periods));
    out.uses = uses(course, out.positions, jerk);
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    const double worst = out.uses.worst();
    if (worst <= kLastCheck) return {};
    out.stretch *= std::min(1.5, worst * 1.0005);
  }
}

Timing fastest_of(const std::vector<double>& a, const std::vector<double>& b, double d) {
  const double time_a = duration(a, d), time_b = duration(b, d);
  return time_a <= time_b ? Timing{a, 0.0, time_a} : Timing{b, 0.0, time_b};
}

/// Computes the proven plan, and keeps the faster of it and the optimistic one.
void limit_jerk(Plan& out, LadderSearch search, const Course& course, const PlanOptions& options) {
  out.timing = search.best(1.0, 1e300);
  out.proven = out.timing.time;
  if (options.optimism <= 1.0 || search.good_enough(out.timing)) return;
  const double most = course.machine.period * (static_cast<double>(options.max_periods) + 1.0);
  Timing faster = search.best(options.optimism, std::min(out.proven, most));
  if (!faster.x.empty()) out.timing = std::move(faster);
}

}  // namespace

Result<Plan> plan(const Course& course, const PlanOptions& options) {
  Conditions base = without_jerk(course.limits);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  const std::vector<double> x = largest_profile(base.caps, course.limits.d, base.rows);
  base = {};  // because its release at the end, with the rest, would delay a cancellation
  HalfPlanes acceleration = acceleration_rows(course.limits);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  const Profile by_signs = fastest_profile(speed_caps(course.limits), acceleration);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  Plan out;
  out.least = duration(by_signs.bound, course.limits.d);
  out.timing = fastest_of(x, by_signs.x, course.limits.d);
  out.no_jerk = out.proven = out.timing.time;
  const double least = periods_of(out.no_jerk, course.machine.period);
  if (!(least <= static_cast<double>(options.max_periods)))
    return too_many_periods(least, options.max_periods);
  const bool jerk = options.jerk && any_jerk(course.limits);
  if (jerk) {
    const double by_magnitudes = duration(x, course.limits.d);
    FilteredProfiles profiles(course.limits);
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    limit_jerk(out, LadderSearch(course, options, profiles, x), course, options);
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    if (!options.filter && options.optimism > 1.0 && by_magnitudes > kCancels * out.least) {
      Timing faster =
          best_by_signed_rows(course, profiles, by_signs, std::move(acceleration), out.timing.time);
      if (!faster.x.empty()) out.timing = std::move(faster);
    }
  }
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  TRY(settle(out, course, options, jerk));
  return out;
}

}  // namespace tubecut::motion
