#include "core/motion/plan.hpp"

#include <algorithm>
#include <cmath>

namespace tubecut::motion {
namespace {

constexpr int kFullRounds = 4;
constexpr int kProvenAfter =
    7;  // passes; from then on a violated place goes to the proven rows at once
constexpr int kMostPasses = 40;  // then every interval does
constexpr double kAccepted = 1.0 + 1e-9;
constexpr double kRelief = 0.97;
constexpr double kLastCheck = 1.0 + 1e-8;
constexpr double kNothingToGain = 1.0 + 1e-4;  // over the optimum without jerk limits

/// One search over the ladder of filters for one optimism.
class Search {
 public:
  Search(const Course& course, const PlanOptions& options, const std::vector<double>& without_jerk,
         std::stop_token stop)
      : course_(course),
        options_(options),
        without_jerk_(without_jerk),
        least_(duration(without_jerk, course.limits.d)),
        stop_(std::move(stop)) {}

  /// The fastest timing found that is faster than `bound` seconds; empty x where none is.
  Timing best(double optimism, double bound) {
    Timing found{{}, 0.0, bound};
    for (const double filter : filters(optimism)) {
      if (stop_.stop_requested()) break;
      Timing next = repaired(filter, optimism, found.time);
      if (next.time < found.time) found = std::move(next);
      if (good_enough(found)) break;
    }
    return found;
  }

  /// No other filter or optimism could save more than a part in ten thousand.
  [[nodiscard]] bool good_enough(const Timing& timing) const {
    return timing.time <= kNothingToGain * least_;
  }

 private:
  [[nodiscard]] double period() const { return course_.machine.period; }

  [[nodiscard]] Timing profile(double filter, const Optimism& optimism, int rounds) const {
    return filtered_profile(course_.limits, without_jerk_, filter, optimism, rounds);
  }

  /// Scouts every octave with one round, then offers the best and its neighbours.
  std::vector<double> filters(double optimism) const {
    if (options_.filter) return {*options_.filter};
    const Optimism level(course_.limits.intervals(), optimism);
    double longest = 0.0;
    for (const AxisBounds& axis : course_.limits.axes) {
      if (axis.j_max > 0.0) longest = std::max(longest, 2.0 * axis.a_max / axis.j_max);
    }
    double best_count = 1.0, best_time = 1e300;
    for (double ideal = longest / period();; ideal *= 0.5) {
      const double count = std::max(1.0, std::floor(ideal + 0.5));
      const double time = profile(count * period(), level, 1).time;
      if (time < best_time) {
        best_time = time;
        best_count = count;
      }
      if (count <= 1.0 || stop_.stop_requested()) break;
    }
    return neighbours(best_count);
  }

  [[nodiscard]] std::vector<double> neighbours(double count) const {
    std::vector<double> out{count * period()};
    for (const double factor : {0.70710678118654752, 1.4142135623730951}) {
      const double next = std::max(1.0, std::floor(count * factor + 0.5));
      if (next != count) out.push_back(next * period());
    }
    return out;
  }

  /// Lowers the optimism where a sample breaks its jerk limit, until none does. Every pass lowers
  /// some of it and the proven level breaks nothing, so this ends.
  Timing repaired(double filter, double level, double bound) const {
    Optimism optimism(course_.limits.intervals(), level);
    for (int pass = 1;; ++pass) {
      Timing timing = profile(filter, optimism, kFullRounds);
      const bool proven = std::ranges::all_of(optimism, [](double o) { return o <= 1.0; });
      if (timing.time >= bound || proven || stop_.stop_requested()) return timing;
      const auto count = static_cast<std::int64_t>(periods_of(timing.time, period()));
      const std::vector<Place> places = sampled(timing, course_.limits.d, count);
      const std::vector<double> ratio = jerk_ratios(course_, places);
      if (*std::ranges::max_element(ratio) <= kAccepted) return timing;
      if (pass >= kMostPasses) {
        std::ranges::fill(optimism, 1.0);
      } else {
        lower(optimism, places, ratio, filter, pass >= kProvenAfter);
      }
    }
  }

  void lower(Optimism& optimism, const std::vector<Place>& places, const std::vector<double>& ratio,
             double filter, bool to_proven) const {
    const auto reach = static_cast<std::size_t>(std::ceil(filter / period())) + 3;
    const Optimism before = optimism;
    const std::size_t n = optimism.size();
    for (std::size_t k = 0; k < ratio.size(); ++k) {
      if (ratio[k] <= kAccepted) continue;
      const std::size_t from = places[k < reach ? 0 : k - reach].interval;
      const std::size_t to = places[std::min(ratio.size() - 1, k + reach)].interval;
      for (std::size_t i = from == 0 ? 0 : from - 1; i <= std::min(n - 1, to + 1); ++i) {
        const double next = to_proven ? 1.0 : std::max(1.0, kRelief * before[i] / ratio[k]);
        optimism[i] = std::min(optimism[i], next);
      }
    }
  }

  const Course& course_;
  const PlanOptions& options_;
  const std::vector<double>& without_jerk_;
  double least_;
  std::stop_token stop_;
};

bool any_jerk(const Limits& limits) {
  return std::ranges::any_of(limits.axes, [](const AxisBounds& axis) { return axis.j_max > 0.0; });
}

Error too_many(double periods, std::int64_t most) {
  return Error{Issue{
      ErrorCode::too_many_periods, "motion", periods, static_cast<double>(most), "periods", {}}};
}

/// Samples the plan and stretches it while a limit is broken; a stretch by K divides v, a, j by K,
/// K^2, K^3.
Result<void> settle(Plan& out, const Course& course, const PlanOptions& options, bool jerk) {
  for (;;) {
    const double periods = periods_of(out.timing.time * out.stretch, course.machine.period);
    if (!(periods <= static_cast<double>(options.max_periods))) {
      return tl::unexpected<Error>(too_many(periods, options.max_periods));
    }
    out.places = sampled(out.timing, course.limits.d, static_cast<std::int64_t>(periods));
    out.uses = uses(course, out.places, jerk);
    const double worst = out.uses.worst();
    if (worst <= kLastCheck) return {};
    out.stretch *= std::min(1.5, worst * 1.0005);
  }
}

}  // namespace

double periods_of(double time, double period) {
  return std::max(1.0, std::ceil(time / period - 1e-6));
}

Result<Plan> plan(const Course& course, const PlanOptions& options, std::stop_token stop) {
  const Conditions base = without_jerk(course.limits);
  const std::vector<double> x = largest_profile(base.caps, course.limits.d, base.rows);
  Plan out;
  out.no_jerk = duration(x, course.limits.d);
  const double least = periods_of(out.no_jerk, course.machine.period);
  if (!(least <= static_cast<double>(options.max_periods))) {
    return tl::unexpected<Error>(too_many(least, options.max_periods));
  }
  const bool jerk = options.jerk && any_jerk(course.limits);
  if (jerk) {
    Search search(course, options, x, stop);
    out.timing = search.best(1.0, 1e300);
    out.proven = out.timing.time;
    const double bound = std::min(
        out.proven, course.machine.period * (static_cast<double>(options.max_periods) + 1.0));
    if (options.optimism > 1.0 && !search.good_enough(out.timing)) {
      if (Timing faster = search.best(options.optimism, bound); !faster.x.empty()) {
        out.timing = std::move(faster);
      }
    }
  } else {
    out.timing = {x, 0.0, out.no_jerk};
    out.proven = out.no_jerk;
  }
  if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
  if (auto ok = settle(out, course, options, jerk); !ok) {
    return tl::unexpected<Error>(ok.error());
  }
  return out;
}

}  // namespace tubecut::motion
