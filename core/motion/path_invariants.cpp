#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/motion/follower.hpp"
#include "core/motion/invariants.hpp"

namespace tubecut::motion {
namespace {

constexpr double kLook = 0.5;            // mm the follower looks ahead beyond all allowances
constexpr std::size_t kLongWindow = 25;  // periods of I15
constexpr double kLeadStep = 0.05;       // mm of tip path between looks at the lead's clearance

using Group = Coordinate::Group;

/// Allowances of the geometric invariants.
struct Allowance {
  double tip = 0.0;        // I10, mm
  double skipped = 0.0;    // I11, mm
  double bevel = 0.0;      // I12, rad
  double place = 0.0;      // I12: where along the path B may come from, mm
  double speed = 0.0;      // t_q of the speed's trace, mm
  double thickness = 0.0;  // what an error of B moves the beam on the far wall, mm
};

double largest_bevel(const Program& program) {
  double largest = 0.0;
  for (std::size_t c = 0; c < program.x.size(); ++c) {
    if (program.coordinates[c].group != Group::bevel) continue;
    for (const double b : program.x[c]) {
      largest = std::max(largest, std::abs(b) * program.coordinates[c].weight / kBevelWeight);
    }
  }
  return largest;
}

/// The axis values after each period, and what they make.
class Walker {
 public:
  Walker(const Counted& counted, const Prepared& job) : x_counted(counted), x_q(counted.start) {
    for (const Axis& axis : job.course.machine.axes)
      x_pulses.push_back(axis.pulses_per_axis_unit());
    x_sum.assign(x_q.size(), 0);
  }
  [[nodiscard]] const std::vector<double>& values() const { return x_q; }
  void step(std::size_t period) {
    for (std::size_t a = 0; a < x_q.size(); ++a) {
      if (x_counted.counts[a].empty()) continue;
      x_sum[a] += x_counted.counts[a][period];
      x_q[a] = x_counted.start[a] + static_cast<double>(x_sum[a]) / x_pulses[a];
    }
  }

 private:
  const Counted& x_counted;
  std::vector<double> x_q;
  std::vector<double> x_pulses;
  std::vector<std::int64_t> x_sum;
};

class Examination {
 public:
  Examination(const ScheduleSpec& spec, const Prepared& job, const Counted& counted, bool with_lead)
      : x_spec(spec),
        x_job(job),
        x_counted(counted),
        x_torch(spec),
        x_largest_b(largest_bevel(job.program)),
        x_quantum(x_torch.quantum(x_largest_b)) {
    set_allowances();
    if (with_lead && spec.motion.lead) {
      if (auto border = part_border(spec); border && border->cut.closed) x_border = *border;
    }
  }

  Followed run() {
    std::vector<bool> part;
    for (std::size_t c = 0; c < x_job.program.x.size(); ++c) part.push_back(takes_part(c));
    const double look = kLook + 2.0 * x_allow.tip + 2.0 * fastest() * x_counted.period;
    Follower follower(x_job.program, part, look);
    Walker walker(x_counted, x_job);
    for (std::size_t k = 0; k <= x_counted.periods; ++k) {
      if (k > 0) walker.step(k - 1);
      see(walker.values(), follower, k);
    }
    return result(follower);
  }

 private:
  [[nodiscard]] bool is_tip(std::size_t c) const {
    return x_job.program.coordinates[c].group == Group::tip;
  }
  /// Plain axes have no tip to go by: there every axis is followed, in generalised length.
  [[nodiscard]] bool plain() const {
    return std::holds_alternative<AxisColumns>(x_spec.cut) &&
           std::holds_alternative<Generic>(x_spec.machine.kinematics);
  }
  [[nodiscard]] bool takes_part(std::size_t c) const {
    return x_torch.knows(c) && (plain() || is_tip(c));
  }

  void set_allowances() {
    const Path& path = x_job.course.path;
    const Motion& motion = x_spec.motion;
    double quanta = 0.0, bevel = 0.0, followed_bevels = 0.0;
    for (std::size_t c = 0; c < x_job.program.x.size(); ++c) {
      const double q = x_job.program.coordinates[c].weight * x_quantum[c];
      if (takes_part(c)) quanta += q * q;
      if (is_tip(c)) continue;
      bevel = std::max(bevel, q / kBevelWeight);
      if (takes_part(c)) followed_bevels += kBevelWeight * (motion.eps_b.rad() + path.sag_b);
    }
    const double near = motion.eps_tip + std::sqrt(quanta) + followed_bevels;
    x_allow.tip = near + path.sag_tip;
    // Smoothing is measured at the knots; a corner may lie half a spacing beside one.
    x_allow.place = x_allow.tip + 0.5 * path.d;
    x_allow.skipped = near + 0.5 * fastest() * x_counted.period + 0.5 * path.d;
    x_allow.bevel = motion.eps_b.rad() + path.sag_b + bevel;
    for (const AxisFunction& f : x_job.course.tip) {
      const double q = trace_quantum(f);
      x_allow.speed += q * q;
    }
    x_allow.speed = std::sqrt(x_allow.speed);
    if (const auto* const contour = std::get_if<Contour>(&x_spec.cut)) {
      const double cos = elementary::cos(x_largest_b);
      x_allow.thickness = contour->wall * x_allow.bevel / (cos * cos);
    }
  }

  [[nodiscard]] double trace_quantum(const AxisFunction& f) const {
    double q = 0.0;
    for (std::size_t c = 0; c < kMostCoordinates; ++c) q += std::abs(f.linear[c]) * x_quantum[c];
    const double cos = elementary::cos(x_largest_b);
    return f.tan_b == 0.0 ? q : q + std::abs(f.tan_b) / (cos * cos) * x_quantum[2];
  }

  [[nodiscard]] double fastest() const {
    const SpeedAlong& speed = x_job.course.speed;
    double most = 0.0;
    for (std::size_t i = 0; i < x_job.program.size(); ++i) most = std::max(most, speed.at_point(i));
    return most;
  }

  [[nodiscard]] bool speed_known() const {
    for (const AxisFunction& f : x_job.course.tip) {
      for (std::size_t c = 0; c < kMostCoordinates; ++c) {
        if (f.linear[c] != 0.0 && !x_torch.knows(c)) return false;
      }
    }
    return true;
  }

  void see(const std::vector<double>& q, Follower& follower, std::size_t k) {
    const Coordinates x = x_torch.at(q);
    const Follower::Found found = follower.follow(follower.tip_of(x));
    x_tip.see(found.distance, x_allow.tip);
    see_bevel(x, follower, found.at);
    if (const auto error = x_torch.standoff_error(q)) {
      x_standoff.see(std::abs(*error), x_torch.standoff_quantum() * (1.0 + 1e-6));
    }
    if (speed_known()) see_speed(x, follower, found, k);
    if (x_border) see_lead(x, follower, found.at);
  }

  void see_bevel(const Coordinates& x, const Follower& follower, double at) {
    for (std::size_t c = 0; c < x_job.program.x.size(); ++c) {
      const Coordinate& coordinate = x_job.program.coordinates[c];
      if (coordinate.group != Group::bevel || !x_torch.knows(c)) continue;
      const auto [low, high] = follower.range(c, at, x_allow.place);
      const double off = std::max({0.0, low - x[c], x[c] - high});
      x_bevel.see(off * coordinate.weight / kBevelWeight * kDegPerRad, x_allow.bevel * kDegPerRad);
    }
  }

  /// Largest speed asked for near a place of the polyline, mm/s.
  [[nodiscard]] double asked(const Follower& follower, const Follower::Found& found) const {
    const SpeedAlong& speed = x_job.course.speed;
    double most = std::max(speed.at_point(found.segment), speed.at_point(found.segment + 1));
    for (std::size_t i = found.segment; i > 0 && follower.tip_length(i) >= found.at - x_allow.tip;
         --i) {
      most = std::max(most, speed.at_point(i - 1));
    }
    for (std::size_t i = found.segment + 1;
         i + 1 < x_job.program.size() && follower.tip_length(i) <= found.at + x_allow.tip; ++i) {
      most = std::max(most, speed.at_point(i + 1));
    }
    return most;
  }

  void see_speed(const Coordinates& x, const Follower& follower, const Follower::Found& found,
                 std::size_t k) {
    std::vector<double> trace;
    for (const AxisFunction& f : x_job.course.tip) trace.push_back(f.at(x));
    const double now = asked(follower, found);
    if (k > 0) {
      double square = 0.0;
      for (std::size_t i = 0; i < trace.size(); ++i) {
        square += (trace[i] - x_trace[i]) * (trace[i] - x_trace[i]);
      }
      const double way = std::sqrt(square);
      const double limit = std::max(now, x_asked.back());
      x_speed.see(way / x_counted.period, limit + 2.0 * x_allow.speed / x_counted.period);
    }
    x_asked.push_back(now);
    x_traces.push_back(trace);
    if (x_traces.size() > kLongWindow + 1) {
      x_traces.erase(x_traces.begin());
      x_asked.erase(x_asked.begin());
    }
    if (x_traces.size() == kLongWindow + 1) see_long_window();
    x_trace = std::move(trace);
  }

  void see_long_window() {
    double square = 0.0;
    for (std::size_t i = 0; i < x_traces.front().size(); ++i) {
      const double step = x_traces.back()[i] - x_traces.front()[i];
      square += step * step;
    }
    const double time = static_cast<double>(kLongWindow) * x_counted.period;
    const double limit = *std::ranges::max_element(x_asked);
    x_long.see(std::sqrt(square) / time, limit + 2.0 * x_allow.speed / time);
  }

  void see_lead(const Coordinates& x, const Follower& follower, double at) {
    const Program& program = x_job.program;
    const bool lead =
        at < follower.tip_length(program.cut_first) || at > follower.tip_length(program.cut_last);
    if (!lead || std::abs(at - x_lead_at) < kLeadStep) return;
    x_lead_at = at;
    const ContourPoint point{x[0], x[1], x[2], false, 0.0};
    x_lead.see(intrusion(*x_border, point), kLeadTouch + x_allow.tip + x_allow.thickness);
  }

  Followed result(const Follower& follower) const {
    Followed out;
    const auto add = [&out](const Worst& worst, const char* name, const char* unit) {
      if (worst.any()) out.checks.push_back(worst.check(name, unit));
    };
    Worst skipped;
    skipped.see(follower.farthest_missed(), x_allow.skipped);
    add(x_tip, "I10", "mm");
    add(skipped, "I11", "mm");
    add(x_bevel, "I12", "deg");
    add(x_standoff, "I13", "mm");
    add(x_speed, "I14", "mm/s");
    add(x_long, "I15", "mm/s");
    add(x_lead, "lead_clears_part", "mm");
    out.deviation = x_tip.check({}, {}).value;
    return out;
  }

  const ScheduleSpec& x_spec;
  const Prepared& x_job;
  const Counted& x_counted;
  Reconstruction x_torch;
  double x_largest_b;
  Coordinates x_quantum;
  Allowance x_allow = {};
  std::optional<PartBorder> x_border = {};
  std::vector<double> x_trace = {};
  std::vector<std::vector<double>> x_traces = {};
  std::vector<double> x_asked = {};
  double x_lead_at = -1e300;
  Worst x_tip, x_bevel, x_standoff, x_speed, x_long, x_lead;
};

bool any_tip_known(const Prepared& job, const Reconstruction& torch) {
  for (std::size_t c = 0; c < job.program.x.size(); ++c) {
    if (job.program.coordinates[c].group == Group::tip && torch.knows(c)) return true;
  }
  return false;
}

}  // namespace

Followed path_invariants(const ScheduleSpec& spec, const Prepared& job, const Counted& counted,
                         bool with_lead) {
  if (!any_tip_known(job, Reconstruction(spec))) return {};
  return Examination(spec, job, counted, with_lead).run();
}

}  // namespace tubecut::motion
