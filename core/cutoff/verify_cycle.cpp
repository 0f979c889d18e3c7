#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/cutoff/verify_parts.hpp"

namespace tubecut::cutoff {
namespace {

constexpr double kRounding =
    1e-11;  // of the largest stroke and speed: rounding in a short last interval

double largest(const std::vector<double>& values) {
  double out = 0.0;
  for (const double value : values) worsen(out, std::abs(value));
  return out;
}

/// Changes between neighbouring samples, as fractions of the maximum by the jerk limit and the
/// reported steps.
struct Steps {
  double stroke = 0.0;        // trapezium of the speeds against the stroke
  double speed = 0.0;         // trapezium of the accelerations against the speed
  double acceleration = 0.0;  // difference of the accelerations
};

Steps steps_of(const CycleSpec& spec, const Cycle& c) {
  const auto& s = c.samples;
  const double j = spec.max_cylinder_jerk;
  const double round_stroke = kRounding * largest(s.stroke);
  const double round_speed = kRounding * spec.max_cylinder_speed;
  Steps out;
  for (std::size_t i = 1; i < s.time.size(); ++i) {
    if (i % 1024 == 0 && stopped()) break;
    const double h = s.time[i] - s.time[i - 1];
    const auto inside = [&](double t) { return s.time[i - 1] <= t && t <= s.time[i]; };
    const double jump = (inside(c.work_start) ? c.acceleration_step_in : 0.0) +
                        (inside(c.work_end) ? c.acceleration_step_out : 0.0);
    const double stroke = s.stroke[i] - s.stroke[i - 1] - 0.5 * h * (s.speed[i] + s.speed[i - 1]);
    const double speed =
        s.speed[i] - s.speed[i - 1] - 0.5 * h * (s.acceleration[i] + s.acceleration[i - 1]);
    const double change = s.acceleration[i] - s.acceleration[i - 1];
    const double round_acceleration =
        kRounding * spec.max_cylinder_acceleration + kRounding * j * s.time[i];
    worsen(out.stroke,
           std::abs(stroke) / (j * h * h * h / 12.0 + jump * h * h / 8.0 + round_stroke));
    worsen(out.speed, std::abs(speed) / (j * h * h / 4.0 + jump * h / 2.0 + round_speed));
    worsen(out.acceleration, std::abs(change) / (j * h + jump + round_acceleration));
  }
  return out;
}

void push_feeds(const FeedCurveSpec& spec, const FeedCurve& curve, const ArmTip& tip,
                std::vector<Check>& checks) {
  const auto& c = *curve.cycle;
  const auto& s = c.samples;
  const TipFeed deepest = tip.at(c.stop_stroke);
  const double scale = feed_scale(spec.linkage, deepest);
  double feed = std::abs(deepest.feed - c.stop_feed) +
                std::abs(c.stop_feed - curve.work.end_feed - c.overshoot);
  double speed = 0.0;
  double fastest =
      curve.work.feed;  // at least the work feed, because a coarse period may skip every motion
  for (std::size_t i = 0; i < s.time.size() && !stopped(); ++i) {
    const TipFeed here = tip.at(s.stroke[i]);
    worsen(feed, std::abs(here.feed - s.feed[i]));
    // Near the tangent's pole the derivative loses digits as 1/cos psi.
    worsen(speed, here.elevation_cosine * std::abs(here.first * s.speed[i] - s.feed_speed[i]));
    worsen(fastest, std::abs(here.first * s.speed[i]));
  }
  checks.push_back(
      {"cycle_feed", feed / (scale + feed_scale(spec.linkage, tip.at(0.0))), limit::kFeed, ""});
  checks.push_back({"cycle_feed_speed", speed / fastest, limit::kSpeed, ""});
}

void push_times(const CycleSpec& spec, const FeedCurve& curve, std::vector<Check>& checks) {
  const auto& c = *curve.cycle;
  const auto& s = c.samples;
  const double times =
      worst_of({std::abs(c.work_end - c.work_start - curve.work.duration) / c.cycle,
                std::abs(s.time.back() - c.end) / c.cycle,
                std::abs(c.end + spec.handling - c.cycle) / c.cycle,
                std::abs(c.pieces_per_hour * c.cycle / 3600.0 - 1.0)});
  checks.push_back({"cycle_times", times, limit::kCycleTime, ""});
  const double rest = worst_of({std::abs(s.stroke.back()), std::abs(s.speed.back()),
                                std::abs(s.acceleration.back()), std::abs(s.feed.back()),
                                std::abs(s.feed_speed.back())});
  checks.push_back({"cycle_ends_at_rest", rest, limit::kRest, ""});
  if (!c.target || !c.target->estimated_feed) return;
  // At the estimate, the work feed takes the target's time less that of all other phases.
  const double others = c.cycle - (c.work_end - c.work_start);
  const double work = (curve.work.end_feed - curve.work.start_feed) / *c.target->estimated_feed;
  checks.push_back({"cycle_target_estimate",
                    std::abs((others + work) * *spec.target / 3600.0 - 1.0), limit::kCycleTime,
                    ""});
}

}  // namespace

void verify_cycle(const FeedCurveSpec& spec, const FeedCurve& curve, const ArmTip& tip,
                  std::vector<Check>& checks) {
  const auto& limits = *spec.cycle;
  const auto& s = curve.cycle->samples;
  checks.push_back(
      {"cycle_speed", largest(s.speed) / limits.max_cylinder_speed - 1.0, limit::kCycleLimit, ""});
  checks.push_back({"cycle_acceleration",
                    largest(s.acceleration) / limits.max_cylinder_acceleration - 1.0,
                    limit::kCycleLimit, ""});
  const Steps steps = steps_of(limits, *curve.cycle);
  checks.push_back({"cycle_jerk", steps.acceleration, limit::kCycleStep, ""});
  checks.push_back({"cycle_speed_steps", steps.speed, limit::kCycleStep, ""});
  checks.push_back({"cycle_stroke_steps", steps.stroke, limit::kCycleStep, ""});
  if (limits.max_feed)
    checks.push_back({"cycle_max_feed",
                      worst_of({largest(s.feed), curve.cycle->stop_feed}) / *limits.max_feed - 1.0,
                      limit::kCycleLimit, ""});
  push_feeds(spec, curve, tip, checks);
  push_times(limits, curve, checks);
}

}  // namespace tubecut::cutoff
