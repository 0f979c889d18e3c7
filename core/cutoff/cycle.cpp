#include "core/cutoff/cycle.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/cutoff/preconditions.hpp"
#include "core/math/search.hpp"

namespace tubecut::cutoff {
namespace {

constexpr double kSecondsPerHour = 3600.0;
constexpr int kFeedSteps = 64;  // steps of the search for the slowest feed that meets a target
constexpr std::size_t kStopEvery = 4096;

CylinderLimits limits_of(const CycleSpec& spec) {
  return {spec.max_cylinder_speed, spec.max_cylinder_acceleration, spec.max_cylinder_jerk};
}

Result<void> check(const CycleSpec& spec) {
  Preconditions on("cycle/");
  on.positive("period", spec.period, "s");
  on.positive("max_cylinder_speed", spec.max_cylinder_speed, "mm_s");
  on.positive("max_cylinder_acceleration", spec.max_cylinder_acceleration, "mm_s2");
  on.positive("max_cylinder_jerk", spec.max_cylinder_jerk, "mm_s3");
  if (spec.max_feed) on.positive("max_feed", *spec.max_feed, "mm");
  on.not_negative("dwell", spec.dwell, "s");
  on.not_negative("handling", spec.handling, "s");
  if (spec.target) on.positive("target", *spec.target, "per_hour");
  return on.met();
}

/// One work window at any tool feed: speeds, accelerations and jerks scale with v, v^2, v^3.
struct Window {
  const Mechanism& mechanism;
  Work at_unit_feed;
  Inverse start;
  Inverse end;
};

Window window_of(const WorkFeed& work) {
  Work unit = work.work();
  const double v = unit.feed;
  unit.max_cylinder_speed /= v;
  unit.max_cylinder_acceleration /= v * v;
  unit.max_cylinder_jerk /= v * v * v;
  const auto& mechanism = work.mechanism();
  return {mechanism, unit, mechanism.inverse(unit.start_feed), mechanism.inverse(unit.end_feed)};
}

struct Plan {
  RapidMove approach;
  double work_duration = 0.0;
  Ramp stop;
  double stop_stroke = 0.0;
  double stop_feed = 0.0;
  RapidMove back;
  [[nodiscard]] double motion(double dwell) const {
    return approach.duration + work_duration + stop.duration + dwell + back.duration;
  }
};

tl::unexpected<Error> above(ErrorCode code, const char* member, double got, double limit,
                            const char* unit) {
  return fail({.code = code, .member = member, .got = got, .limit = limit, .unit = unit});
}

Result<Plan> plan(const Window& window, double v, const CycleSpec& spec) {
  const auto limits = limits_of(spec);
  const Work& unit = window.at_unit_feed;
  if (const double got = v * unit.max_cylinder_speed; got > limits.speed)
    return above(ErrorCode::work_speed_above_limit, "cycle/max_cylinder_speed", got, limits.speed,
                 "mm_s");
  if (const double got = v * v * unit.max_cylinder_acceleration; got > limits.acceleration)
    return above(ErrorCode::work_accel_above_limit, "cycle/max_cylinder_acceleration", got,
                 limits.acceleration, "mm_s2");
  if (const double got = v * v * v * unit.max_cylinder_jerk; got > limits.jerk)
    return above(ErrorCode::work_accel_above_limit, "cycle/max_cylinder_jerk", got, limits.jerk,
                 "mm_s3");
  Plan out;
  const double speed_in = v * window.start.first;
  const auto approach = rapid_move(unit.start_stroke, speed_in, limits);
  if (!approach)
    return fail({.code = ErrorCode::approach_too_short,
                 .member = "cut",
                 .got = unit.start_stroke,
                 .limit = ramp(0.0, speed_in, limits).distance,
                 .unit = "mm",
                 .hint = "cylinder stroke of the approach, and of the ramp to the work speed"});
  out.approach = *approach;
  out.work_duration = (unit.end_feed - unit.start_feed) / v;
  out.stop = ramp(v * window.end.first, 0.0, limits);
  out.stop_stroke = unit.end_stroke + out.stop.distance;
  const auto stop_feed = window.mechanism.tool_feed(out.stop_stroke);
  if (!stop_feed)
    return fail({.code = ErrorCode::unreachable_x,
                 .member = "cut",
                 .got = out.stop_stroke,
                 .limit = window.mechanism.geometry().stroke_high,
                 .unit = "mm",
                 .hint = "stroke of the stop ramp"});
  out.stop_feed = *stop_feed;
  if (spec.max_feed && out.stop_feed > *spec.max_feed)
    return above(ErrorCode::max_feed_exceeded, "cycle/max_feed", out.stop_feed, *spec.max_feed,
                 "mm");
  out.back = rapid_move(out.stop_stroke, 0.0, limits)
                 .value_or(RapidMove{});  // a move from rest to rest over > 0 always exists
  return out;
}

/// Returns the slowest feed whose cycle takes at most `seconds`. Plans are possible up to some feed
/// and impossible above it. Below it, a faster feed shortens the cycle except for the longer ramps,
/// so a scan finds the first step that meets the target.
std::optional<double> feed_for(const Window& window, const CycleSpec& spec, double seconds) {
  const auto possible = [&](double v) { return plan(window, v, spec).has_value(); };
  const auto meets = [&](double v) {
    const auto planned = plan(window, v, spec);
    return planned && planned->motion(spec.dwell) + spec.handling <= seconds;
  };
  const double slowest = (window.at_unit_feed.end_feed - window.at_unit_feed.start_feed) / seconds;
  const double limit = spec.max_cylinder_speed / window.at_unit_feed.max_cylinder_speed;
  if (!(slowest < limit) || !possible(slowest)) return std::nullopt;
  const double fastest = math::last_true(possible, slowest, limit);
  double below = slowest;
  for (int i = 1; i <= kFeedSteps; ++i) {
    const double step = static_cast<double>(i) / kFeedSteps;
    const double v = i == kFeedSteps ? fastest : slowest + (fastest - slowest) * step * step * step;
    if (meets(v))
      return math::sign_change([&](double x) { return meets(x) ? 1.0 : -1.0; }, below, v);
    below = v;
  }
  return std::nullopt;
}

CycleTarget target_of(const Window& window, const CycleSpec& spec, const Cycle& planned, double v) {
  const double seconds = kSecondsPerHour / *spec.target;
  const double work = planned.work_end - planned.work_start;
  const double left = seconds - (planned.cycle - work);
  CycleTarget out;
  out.met = planned.pieces_per_hour >= *spec.target;
  if (left > 0.0) out.estimated_feed = v * work / left;
  out.feed = feed_for(window, spec, seconds);
  return out;
}

/// Returns the constant-jerk phases of everything except the work feed, in time order.
std::vector<Phase> phases_of(const Plan& plan, const Cycle& c, double start_stroke,
                             double end_stroke, const CycleSpec& spec) {
  const auto limits = limits_of(spec);
  std::vector<Phase> motion;
  const auto cruise = [&motion](Phase at, double duration) {
    at.duration = duration;
    if (duration > 0.0) motion.push_back(at);
    return after(at, duration);
  };
  Phase here = append_ramp(motion, {}, 0.0, plan.approach.peak, 1.0, limits);
  here = cruise(here, plan.approach.cruise);
  here = append_ramp(motion, here, plan.approach.peak, c.speed_in, 1.0, limits);
  motion.push_back({c.work_start, plan.work_duration, start_stroke, c.speed_in, 0.0,
                    0.0});  // the work feed, computed from its map
  here = append_ramp(motion, {c.work_end, 0.0, end_stroke, c.speed_out, 0.0, 0.0}, c.speed_out, 0.0,
                     1.0, limits);
  here = cruise({c.stop, 0.0, plan.stop_stroke, 0.0, 0.0, 0.0}, spec.dwell);
  here = append_ramp(motion, here, 0.0, plan.back.peak, -1.0, limits);
  here = cruise(here, plan.back.cruise);
  here = append_ramp(motion, here, plan.back.peak, 0.0, -1.0, limits);
  motion.push_back({c.end, 0.0, 0.0, 0.0, 0.0, 0.0});
  return motion;
}

void push(CycleSamples& to, double time, const CylinderState& state, double feed_speed) {
  to.time.push_back(time);
  to.stroke.push_back(state.stroke);
  to.speed.push_back(state.speed);
  to.acceleration.push_back(state.acceleration);
  to.feed.push_back(state.feed);
  to.feed_speed.push_back(feed_speed);
}

Result<CycleSamples> sample(const WorkFeed& work, const Cycle& c, const std::vector<Phase>& motion,
                            double period) {
  const double count = std::ceil(c.end / period) + 1.0;
  if (!(count <= static_cast<double>(kMostSamples)))
    return fail({.code = ErrorCode::too_many_samples,
                 .member = "cycle/period",
                 .got = period,
                 .limit = c.end / static_cast<double>(kMostSamples - 1),
                 .unit = "s"});
  const auto n = static_cast<std::size_t>(count);
  CycleSamples out;
  for (auto* const column :
       {&out.time, &out.stroke, &out.speed, &out.acceleration, &out.feed, &out.feed_speed})
    column->reserve(n);
  StrokeCursor cursor(work.mechanism());
  std::size_t now = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (i % kStopEvery == 0 && stopped()) return fail({.code = ErrorCode::cancelled});
    const double time = std::min(static_cast<double>(i) * period, c.end);
    while (now + 1 < motion.size() && motion[now + 1].start <= time) ++now;
    if (motion[now].start >= c.work_start && time >= c.work_start && time <= c.work_end) {
      push(out, time, work.at(time - c.work_start, cursor), work.work().feed);
      continue;
    }
    const Phase here = after(motion[now], time - motion[now].start);
    const Forward tool = work.mechanism().forward(here.stroke);
    push(out, time, {tool.feed, here.stroke, here.speed, here.acceleration, here.jerk},
         tool.rate * here.speed);
  }
  return out;
}

}  // namespace

Result<Cycle> cycle(const WorkFeed& work, const CycleSpec& spec) {
  TRY(check(spec));
  const Window window = window_of(work);
  const double v = work.work().feed;
  TRY(const auto planned, plan(window, v, spec));
  Cycle out;
  out.work_start = planned.approach.duration;
  out.work_end = out.work_start + planned.work_duration;
  out.stop = out.work_end + planned.stop.duration;
  out.end = out.stop + spec.dwell + planned.back.duration;
  out.cycle = out.end + spec.handling;
  out.pieces_per_hour = kSecondsPerHour / out.cycle;
  out.stop_feed = planned.stop_feed;
  out.stop_stroke = planned.stop_stroke;
  out.overshoot = planned.stop_feed - work.work().end_feed;
  out.speed_in = v * window.start.first;
  out.speed_out = v * window.end.first;
  out.acceleration_step_in = std::abs(v * v * window.start.second);
  out.acceleration_step_out = std::abs(v * v * window.end.second);
  out.approach_peak = planned.approach.peak;
  out.return_peak = planned.back.peak;
  if (spec.target) out.target = target_of(window, spec, out, v);
  const auto motion =
      phases_of(planned, out, work.work().start_stroke, work.work().end_stroke, spec);
  TRY(out.samples, sample(work, out, motion, spec.period));
  return out;
}

}  // namespace tubecut::cutoff
