#include "core/motion/search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/stop.hpp"

namespace tubecut::motion {
namespace {

constexpr int kFullRounds = 4;
constexpr int kMostPasses = 20;  // then the filter is given up
constexpr double kStart = 3.0;   // optimism of the jerk rows
constexpr double kLeast = 0.3;   // at most this much below the rows that a proof would ask for
constexpr double kAccepted = 1.0 + 1e-9;
constexpr double kJerkRelief = 0.97;
constexpr double kShareRelief = 0.995;
constexpr double kWorthwhile = 0.999;  // of the time before, to go on to the next filter

/// Repairs plans by signed rows, filter by filter.
class SignedSearch {
 public:
  SignedSearch(const Course& course, SignedRows rows, const std::stop_token& stop)
      : course_(course), rows_(std::move(rows)), stop_(stop) {}

  Timing best(double bound) {
    const Optimism level(intervals(), kStart);
    rows_.share.assign(intervals(), 1.0);
    const double count = best_octave(
        course_,
        [&](double filter) {
          return filtered_signed_profile(course_.limits, rows_, filter, level, 1, stop_).time;
        },
        stop_);
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

  /// True where a filter of `count` periods is worth going on from.
  bool step_to(double count, Timing& found) {
    Timing next = repaired(count * period(), found.time);
    const bool better = next.time < kWorthwhile * found.time;
    if (next.time < found.time) found = std::move(next);
    return better;
  }

  /// Goes on until two filters in a row save nothing.
  void climb(double count, double (*next)(double), Timing& found) {
    for (int idle = 0; idle < 2 && !stop_.stop_requested();) {
      count = next(count);
      if (count < 1.0) return;
      idle = step_to(count, found) ? 0 : idle + 1;
    }
  }

  /// Lowers what the rows allow where a sample breaks a limit, until none does.
  Timing repaired(double filter, double bound) {
    Optimism optimism(intervals(), kStart);
    rows_.share.assign(intervals(), 1.0);
    for (int pass = 0; pass < kMostPasses && !stop_.stop_requested(); ++pass) {
      Timing timing =
          filtered_signed_profile(course_.limits, rows_, filter, optimism, kFullRounds, stop_);
      if (timing.time >= bound || stop_.stop_requested()) break;
      const auto count = static_cast<std::int64_t>(periods_of(timing.time, period()));
      const std::vector<Place> places = sampled(timing, course_.limits.d, count, stop_);
      if (!lower(optimism, places, ratios(course_, places, stop_), filter)) return timing;
    }
    return {{}, filter, 1e300};
  }

  /// False where nothing had to be lowered.
  bool lower(Optimism& optimism, const std::vector<Place>& places, const Ratios& ratio,
             double filter) {
    const auto reach = static_cast<std::size_t>(std::ceil(filter / period())) + 3;
    const std::vector<double> optimism_before = optimism, share_before = rows_.share;
    bool lowered = false;
    for (std::size_t k = 0; k < places.size() && !stops(stop_, k); ++k) {
      const double jerk = ratio.jerk[k], acceleration = ratio.acceleration[k];
      if (jerk <= kAccepted && acceleration <= kAccepted) continue;
      lowered = true;
      for_reach_of(places, k, reach, intervals(), [&](std::size_t i) {
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
  SignedRows rows_;
  std::stop_token stop_;
};

}  // namespace

double best_octave(const Course& course, const std::function<double(double)>& time_of,
                   const std::stop_token& stop) {
  const double period = course.machine.period;
  double longest = 0.0;
  for (const AxisBounds& axis : course.limits.axes) {
    if (axis.j_max > 0.0) longest = std::max(longest, 2.0 * axis.a_max / axis.j_max);
  }
  double best_count = 1.0, best_time = 1e300;
  for (double ideal = longest / period;; ideal *= 0.5) {
    const double count = std::max(1.0, std::floor(ideal + 0.5));
    const double time = time_of(count * period);
    if (time < best_time) {
      best_time = time;
      best_count = count;
    }
    if (count <= 1.0 || stop.stop_requested()) return best_count;
  }
}

void for_reach_of(const std::vector<Place>& places, std::size_t k, std::size_t reach,
                  std::size_t intervals, const std::function<void(std::size_t)>& lower) {
  const std::size_t from = places[k < reach ? 0 : k - reach].interval;
  const std::size_t to = places[std::min(places.size() - 1, k + reach)].interval;
  for (std::size_t i = from == 0 ? 0 : from - 1; i <= std::min(intervals - 1, to + 1); ++i) {
    lower(i);
  }
}

Timing best_by_signed_rows(const Course& course, const Profile& without_jerk,
                           HalfPlanes acceleration, double bound, const std::stop_token& stop) {
  return SignedSearch(course, {std::move(acceleration), without_jerk, {}}, stop).best(bound);
}

}  // namespace tubecut::motion
