#include "core/motion/schedule/schedule.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"

namespace tubecut::motion {
namespace {

Coordinates end_of(const Path& path) { return path.at(path.intervals() - 1, path.d); }

bool is_moving(const Course& course, std::size_t axis) {
  return std::ranges::count(course.limits.axes, axis, &AxisBounds::axis) > 0;
}

/// Returns the pulses between the end and the start of a closed cut, modulo whole revolutions of a
/// rotary axis.
std::int64_t closure(const Axis& axis, const AxisFunction& f, const Course& course,
                     std::int64_t total) {
  if (axis.pulses_per_turn > 0) return total % axis.pulses_per_turn;
  const double start = f.at(course.path.at(0, 0.0)), end = f.at(end_of(course.path));
  return total - rounded(ideal_pulses(axis, end, start));
}

/// Computes the counts of the moving axes in one walk over the positions.
void count(const Course& course, const std::vector<PathPosition>& positions,
           std::vector<AxisPulses>& out) {
  std::vector<AxisFunction> functions;
  std::vector<std::size_t> moving;
  for (const AxisBounds& bounds : course.limits.axes) {
    moving.push_back(bounds.axis);
    functions.push_back(course.axes[bounds.axis]);
    out[bounds.axis].counts.reserve(positions.size() - 1);
  }
  ValueCursor cursor(course.path, functions);
  std::vector<std::int64_t> before(moving.size(), 0);
  for (std::size_t k = 0; k < positions.size() && !stops(k); ++k) {
    const auto& values = cursor.at(positions[k]);
    for (std::size_t i = 0; i < moving.size(); ++i) {
      AxisPulses& axis = out[moving[i]];
      const std::int64_t now =
          rounded(ideal_pulses(course.machine.axes[moving[i]], values[i], axis.start));
      if (k > 0) axis.counts.push_back(static_cast<std::int32_t>(now - before[i]));
      before[i] = now;
    }
  }
}

void sum_up(const PreparedCut& job, std::size_t a, AxisPulses& out) {
  const Course& course = job.course;
  for (const std::int32_t n : out.counts) {
    out.total += n;
    out.peak = std::max<std::int64_t>(out.peak, std::abs(n));
  }
  if (out.peak == 0) out.counts = {};
  if (is_moving(course, a) && job.program.closed) {
    out.closure = closure(course.machine.axes[a], course.axes[a], course, out.total);
  }
}

/// Returns the first sample at or after a point of the program.
std::int64_t passes(const Course& course, const std::vector<PathPosition>& positions,
                    std::size_t point) {
  const double mark = course.path.at_point[point] - 1e-9;
  const auto at = std::ranges::lower_bound(
      positions, mark, {}, [&](const PathPosition& p) { return p.u(course.path.d); });
  return at - positions.begin();
}

std::vector<Event> events(const PreparedCut& job, const Plan& plan) {
  const auto periods = static_cast<std::int64_t>(plan.positions.size()) - 1;
  return {{0, EventKind::pierce},
          {0, EventKind::torch_on},
          {passes(job.course, plan.positions, job.program.cut_first), EventKind::cut_start},
          {std::min(periods, passes(job.course, plan.positions, job.program.cut_last)),
           EventKind::cut_end},
          {periods, EventKind::torch_off}};
}

std::string mm(double value) { return brief(value) + " mm"; }

}  // namespace

double ideal_pulses(const Axis& axis, double q, double start) {
  if (axis.pulses_per_turn > 0) {
    return (q - start) / 360.0 * static_cast<double>(axis.pulses_per_turn);
  }
  return (q - start) * axis.pulses_per_unit;
}

std::int64_t rounded(double pulses) { return static_cast<std::int64_t>(std::floor(pulses + 0.5)); }

std::vector<Warning> warnings(const ScheduleSpec& spec, const Report& report) {
  std::vector<Warning> out;
  const Motion& motion = spec.motion;
  const bool coarse =
      report.sag_tip > 5.0 * motion.eps_tip || report.sag_b > 5.0 * motion.eps_b.rad();
  if (coarse && motion.expert.sag_warning) {
    out.push_back({WarningCode::contour_too_coarse, "contour",
                   "between its points the curve leaves the contour's chords by " +
                       mm(report.sag_tip) + " and " + brief(report.sag_b * kDegPerRad) + " deg"});
  }
  for (const SlowZone& zone : report.slow) {
    out.push_back({WarningCode::slow_zone, "contour",
                   "periods " + std::to_string(zone.from) + " to " + std::to_string(zone.to) +
                       ": down to " + brief(60.0 * zone.least_speed) + " mm/min, axis " +
                       zone.axis});
  }
  if (report.standoff_growth > motion.eps_tip) {
    out.push_back({WarningCode::standoff, "machine", "grows by " + mm(report.standoff_growth)});
  }
  return out;
}

std::vector<AxisPulses> pulses(const PreparedCut& job, const Plan& plan) {
  const Course& course = job.course;
  std::vector<AxisPulses> out;
  for (std::size_t a = 0; a < course.axes.size(); ++a) {
    const Axis& axis = course.machine.axes[a];
    out.push_back(
        {.name = axis.name, .unit = axis.unit, .start = course.axes[a].at(course.path.at(0, 0.0))});
  }
  count(course, plan.positions, out);
  for (std::size_t a = 0; a < out.size() && !stopped(); ++a) sum_up(job, a, out[a]);
  return out;
}

Result<PlannedCut> plan_cut(const ScheduleSpec& spec) {
  TRY(auto job, prepare_cut(spec));
  const PlanOptions options{spec.motion.jerk, spec.motion.expert.optimism,
                            spec.motion.expert.filter, spec.max_periods};
  TRY(auto timed, plan(job.course, options));
  PlannedCut out{.job = std::move(job), .plan = std::move(timed)};
  out.events = events(out.job, out.plan);
  out.report = report(spec, out.job, out.plan);
  out.report.lean = largest_lean(spec, out.job.course.path);
  out.report.edges = edge_deviation(spec, out.job.program, out.job.course.path);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  return out;
}

Result<Schedule> schedule(const ScheduleSpec& spec) {
  TRY(auto cut, plan_cut(spec));
  Schedule out;
  out.period = spec.machine.period;
  out.periods = static_cast<std::int64_t>(cut.plan.positions.size()) - 1;
  out.axes = pulses(cut.job, cut.plan);
  out.events = std::move(cut.events);
  out.report = std::move(cut.report);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  if (spec.motion.compare) out.comparison = comparison(cut.job);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  out.warnings = warnings(spec, out.report);
  return out;
}

}  // namespace tubecut::motion
