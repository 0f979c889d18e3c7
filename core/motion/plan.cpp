#include "core/motion/plan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/stop.hpp"
#include "core/motion/search.hpp"

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
constexpr double kCancels = 1.01;              // from here on, sums of magnitudes forbid too much

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
    return filtered_profile(course_.limits, without_jerk_, filter, optimism, rounds, stop_);
  }

  /// Scouts every octave with one round, then offers the best and its neighbours.
  std::vector<double> filters(double optimism) const {
    if (options_.filter) return {*options_.filter};
    const Optimism level(course_.limits.intervals(), optimism);
    return neighbours(best_octave(
        course_, [&](double filter) { return profile(filter, level, 1).time; }, stop_));
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
      const std::vector<Place> places = sampled(timing, course_.limits.d, count, stop_);
      const std::vector<double> ratio = ratios(course_, places, stop_).jerk;
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
    for (std::size_t k = 0; k < ratio.size() && !stops(stop_, k); ++k) {
      if (ratio[k] <= kAccepted) continue;
      for_reach_of(places, k, reach, optimism.size(), [&](std::size_t i) {
        const double next = to_proven ? 1.0 : std::max(1.0, kRelief * before[i] / ratio[k]);
        optimism[i] = std::min(optimism[i], next);
      });
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
Result<void> settle(Plan& out, const Course& course, const PlanOptions& options, bool jerk,
                    const std::stop_token& stop) {
  for (;;) {
    const double periods = periods_of(out.timing.time * out.stretch, course.machine.period);
    if (!(periods <= static_cast<double>(options.max_periods))) {
      return tl::unexpected<Error>(too_many(periods, options.max_periods));
    }
    out.places = sampled(out.timing, course.limits.d, static_cast<std::int64_t>(periods), stop);
    out.uses = uses(course, out.places, jerk, stop);
    if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
    const double worst = out.uses.worst();
    if (worst <= kLastCheck) return {};
    out.stretch *= std::min(1.5, worst * 1.0005);
  }
}

Timing fastest_of(const std::vector<double>& a, const std::vector<double>& b, double d) {
  const double time_a = duration(a, d), time_b = duration(b, d);
  return time_a <= time_b ? Timing{a, 0.0, time_a} : Timing{b, 0.0, time_b};
}

/// The proven plan, and the faster of it and the optimistic one.
void limit_jerk(Plan& out, Search search, const Course& course, const PlanOptions& options) {
  out.timing = search.best(1.0, 1e300);
  out.proven = out.timing.time;
  if (options.optimism <= 1.0 || search.good_enough(out.timing)) return;
  const double most = course.machine.period * (static_cast<double>(options.max_periods) + 1.0);
  Timing faster = search.best(options.optimism, std::min(out.proven, most));
  if (!faster.x.empty()) out.timing = std::move(faster);
}

}  // namespace

double periods_of(double time, double period) {
  return std::max(1.0, std::ceil(time / period - 1e-6));
}

Result<Plan> plan(const Course& course, const PlanOptions& options, std::stop_token stop) {
  Conditions base = without_jerk(course.limits, stop);
  if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
  const std::vector<double> x = largest_profile(base.caps, course.limits.d, base.rows, stop);
  base = {};  // to be freed at the end, with the rest, would hold up a stop
  HalfPlanes acceleration = acceleration_rows(course.limits, stop);
  if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
  const Profile by_signs = fastest_profile(speed_caps(course.limits, stop), acceleration, stop);
  if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
  Plan out;
  out.least = duration(by_signs.bound, course.limits.d);
  out.timing = fastest_of(x, by_signs.x, course.limits.d);
  out.no_jerk = out.proven = out.timing.time;
  const double least = periods_of(out.no_jerk, course.machine.period);
  if (!(least <= static_cast<double>(options.max_periods))) {
    return tl::unexpected<Error>(too_many(least, options.max_periods));
  }
  const bool jerk = options.jerk && any_jerk(course.limits);
  if (jerk) {
    const double by_magnitudes = duration(x, course.limits.d);
    limit_jerk(out, Search(course, options, x, stop), course, options);
    if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
    if (!options.filter && options.optimism > 1.0 && by_magnitudes > kCancels * out.least) {
      Timing faster =
          best_by_signed_rows(course, by_signs, std::move(acceleration), out.timing.time, stop);
      if (!faster.x.empty()) out.timing = std::move(faster);
    }
  }
  if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
  if (auto ok = settle(out, course, options, jerk, stop); !ok) {
    return tl::unexpected<Error>(ok.error());
  }
  return out;
}

}  // namespace tubecut::motion
