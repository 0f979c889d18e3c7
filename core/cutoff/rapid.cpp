#include "core/cutoff/rapid.hpp"

#include <cmath>

#include "core/math/search.hpp"

namespace tubecut::cutoff {
namespace {

struct RampTimes {
  double jerk = 0.0;      // s, of each jerk phase
  double constant = 0.0;  // s at the acceleration limit
};

RampTimes ramp_times(double change, const CylinderLimits& limits) {
  const double a = limits.acceleration;
  const double j = limits.jerk;
  if (change >= a * a / j) return {a / j, change / a - a / j};
  return {std::sqrt(change / j), 0.0};
}

}  // namespace

Phase after(const Phase& p, double t) {
  Phase out = p;
  out.start = p.start + t;
  out.duration = p.duration - t;
  out.acceleration = p.acceleration + p.jerk * t;
  out.speed = p.speed + t * (p.acceleration + 0.5 * p.jerk * t);
  out.stroke = p.stroke + t * (p.speed + t * (0.5 * p.acceleration + p.jerk * t / 6.0));
  return out;
}

Ramp ramp(double from, double to, const CylinderLimits& limits) {
  const auto times = ramp_times(std::abs(to - from), limits);
  const double duration = 2.0 * times.jerk + times.constant;
  return {duration, 0.5 * (from + to) * duration};
}

std::optional<RapidMove> rapid_move(double distance, double end_speed,
                                    const CylinderLimits& limits) {
  const auto ramps = [&](double peak) {
    const Ramp up = ramp(0.0, peak, limits);
    const Ramp down = ramp(peak, end_speed, limits);
    return Ramp{up.duration + down.duration, up.distance + down.distance};
  };
  if (!(distance > 0.0) || ramps(end_speed).distance > distance) return std::nullopt;
  double peak = limits.speed;
  if (ramps(peak).distance > distance)
    peak = math::last_true([&](double v) { return ramps(v).distance <= distance; }, end_speed,
                           limits.speed);
  if (!(peak > 0.0)) return std::nullopt;
  const Ramp both = ramps(peak);
  const double cruise = (distance - both.distance) / peak;
  return RapidMove{peak, cruise, both.duration + cruise};
}

Phase append_ramp(std::vector<Phase>& motion, const Phase& from, double from_speed, double to_speed,
                  double sign, const CylinderLimits& limits) {
  const auto times = ramp_times(std::abs(to_speed - from_speed), limits);
  const double jerk = (to_speed > from_speed ? sign : -sign) * limits.jerk;
  const double durations[] = {times.jerk, times.constant, times.jerk};
  const double jerks[] = {jerk, 0.0, -jerk};
  Phase here = from;
  for (int i = 0; i < 3; ++i) {
    if (!(durations[i] > 0.0)) continue;
    here.duration = durations[i];
    here.jerk = jerks[i];
    motion.push_back(here);
    here = after(here, durations[i]);
  }
  const Ramp whole = ramp(from_speed, to_speed, limits);
  return {from.start + whole.duration,
          0.0,
          from.stroke + sign * whole.distance,
          sign * to_speed,
          0.0,
          0.0};
}

}  // namespace tubecut::cutoff
