#include "core/motion/replay/invariants.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/motion/path/lead.hpp"
#include "core/motion/path/upright.hpp"
#include "core/motion/schedule/schedule.hpp"

namespace tubecut::motion {
namespace {

constexpr double kSearchAhead = 0.5;     // mm that the follower searches beyond all allowances
constexpr std::size_t kLongWindow = 25;  // periods of I15
constexpr double kLeadStep = 0.05;       // mm of tip path between checks of the lead's clearance
/// The most that smoothing may move the tip off the outside of a section, mm.
constexpr double kOffSection = 0.05;

using Group = Coordinate::Group;

/// Allowances of the geometric invariants.
struct Allowance {
  double tip = 0.0;        // I10, mm
  double skipped = 0.0;    // I11, mm
  double bevel = 0.0;      // I12, rad
  double turn = 0.0;       // I12 of the angle of a section's normal, rad
  double standoff = 0.0;   // I13, mm
  double place = 0.0;      // I12: the path distance within which B may vary, mm
  double speed = 0.0;      // t_q of the speed's trace, mm
  double thickness = 0.0;  // shift of the beam on the far wall per rad of B, mm
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

class Examination {
 public:
  Examination(const ScheduleSpec& spec, const PreparedCut& job, const Counted& counted,
              bool with_lead)
      : spec_(spec),
        job_(job),
        counted_(counted),
        torch_(spec),
        largest_b_(largest_bevel(job.program)),
        quantum_(torch_.quantum(largest_b_)) {
    set_allowances();
    if (with_lead && spec.motion.lead) {
      const auto* const cut_path = std::get_if<CutPath>(&spec.cut);
      if (cut_path != nullptr && cut_path->closed) {
        if (auto border = part_border(*cut_path, spec.machine.sigma()))
          border_ = *std::move(border);
      }
    }
  }

  Followed run() {
    std::vector<bool> part;
    for (std::size_t c = 0; c < job_.program.x.size(); ++c) part.push_back(takes_part(c));
    Follower follower(job_.program, part, kSearchAhead + 2.0 * allow_.tip,
                      2.0 * fastest() * counted_.period);
    AxisValues values(counted_, job_.course.machine);
    for (std::size_t k = 0; k <= counted_.periods && !stopped(); ++k) {
      if (k > 0) values.step(k - 1);
      see(values.now(), follower, k);
    }
    return result(follower);
  }

 private:
  [[nodiscard]] bool is_tip(std::size_t c) const {
    return job_.program.coordinates[c].group == Group::tip;
  }
  /// Plain axes have no tip, so every axis is followed, in generalised length.
  [[nodiscard]] bool plain() const {
    const auto* const columns = std::get_if<AxisColumns>(&spec_.cut);
    return columns != nullptr && !columns->length.empty();
  }
  [[nodiscard]] bool takes_part(std::size_t c) const {
    return torch_.knows(c) && (plain() || is_tip(c));
  }

  void set_allowances() {
    const Path& path = job_.course.path;
    const Motion& motion = spec_.motion;
    double quanta = 0.0, bevel = 0.0, followed_bevels = 0.0;
    for (std::size_t c = 0; c < job_.program.x.size(); ++c) {
      const double q = job_.program.coordinates[c].weight * quantum_[c];
      if (takes_part(c)) quanta += q * q;
      if (is_tip(c)) continue;
      bevel = std::max(bevel, q / kBevelWeight);
      if (takes_part(c)) followed_bevels += kBevelWeight * (motion.eps_b.rad() + path.sag_b);
    }
    const double near = motion.eps_tip + std::sqrt(quanta) + followed_bevels;
    allow_.tip = near + path.sag_tip;
    // Smoothing is measured at the knots; a corner may be half a spacing away from one.
    allow_.place = allow_.tip + 0.5 * path.d;
    allow_.skipped = near + 0.5 * fastest() * counted_.period + 0.5 * path.d;
    allow_.bevel = motion.eps_b.rad() + path.sag_b + bevel;
    allow_.turn = motion.eps_b.rad() + quantum_[0] + rounded_turn(path.d);
    allow_.standoff = torch_.standoff_quantum() * (1.0 + 1e-6);
    if (path.turns()) allow_.standoff += kOffSection;
    for (const AxisFunction& f : job_.course.tip) {
      const double q = trace_quantum(f);
      allow_.speed += q * q;
    }
    allow_.speed = std::sqrt(allow_.speed);
    if (const auto* const cut_path = std::get_if<CutPath>(&spec_.cut)) {
      const double cos = elementary::cos(largest_b_);
      allow_.thickness = cut_path->wall * allow_.bevel / (cos * cos);
    }
  }

  /// Returns how far the path's spline of spacing `d` rounds the angle of a section's normal, which
  /// is not smoothed, where a cut turns back over a corner: a jump K of the slope by K d / 6, and
  /// from 1 / r to -1 / r at most. A cut around the tube does not turn back.
  [[nodiscard]] double rounded_turn(double d) const {
    const auto* const cut_path = std::get_if<CutPath>(&spec_.cut);
    if (cut_path == nullptr || !cut_path->section) return 0.0;
    const bool around = cut_path->closed && cut_path->scrap != Scrap::inside;
    return around ? 0.0 : d / (3.0 * cut_path->section->corner);
  }

  [[nodiscard]] double trace_quantum(const AxisFunction& f) const {
    double q = 0.0;
    for (std::size_t c = 0; c < kMostCoordinates; ++c) q += std::abs(f.linear[c]) * quantum_[c];
    const double cos = elementary::cos(largest_b_);
    return f.tan_b == 0.0 ? q : q + std::abs(f.tan_b) / (cos * cos) * quantum_[2];
  }

  [[nodiscard]] double fastest() const {
    const SpeedAlong& speed = job_.course.speed;
    double most = 0.0;
    for (std::size_t i = 0; i < job_.program.size(); ++i) most = std::max(most, speed.at_point(i));
    return most;
  }

  [[nodiscard]] bool speed_known() const {
    for (const AxisFunction& f : job_.course.tip) {
      for (std::size_t c = 0; c < kMostCoordinates; ++c) {
        if (f.linear[c] != 0.0 && !torch_.knows(c)) return false;
      }
    }
    return true;
  }

  void see(const std::vector<double>& q, Follower& follower, std::size_t k) {
    const Coordinates x = torch_.at(q);
    const Follower::Found found = follower.follow(follower.tip_of(x));
    tip_.see(found.distance, allow_.tip);
    see_bevel(x, follower, found.at);
    if (const auto error = torch_.standoff_error(q)) {
      standoff_.see(std::abs(*error), allow_.standoff);
    }
    if (speed_known()) see_speed(x, follower, found, k);
    if (border_) see_lead(x, follower, found.at);
  }

  void see_bevel(const Coordinates& x, const Follower& follower, double at) {
    for (std::size_t c = 0; c < job_.program.x.size(); ++c) {
      const Coordinate& coordinate = job_.program.coordinates[c];
      if (is_tip(c) || !torch_.knows(c)) continue;
      const auto [low, high] = follower.range(c, at, allow_.place);
      const double off = std::max({0.0, low - x[c], x[c] - high});
      if (coordinate.group == Group::turn)
        bevel_.see(off * kDegPerRad, allow_.turn * kDegPerRad);
      else
        bevel_.see(off * coordinate.weight / kBevelWeight * kDegPerRad, allow_.bevel * kDegPerRad);
    }
  }

  /// Returns the largest requested speed near a place of the polyline, mm/s.
  [[nodiscard]] double asked(const Follower& follower, const Follower::Found& found) const {
    const SpeedAlong& speed = job_.course.speed;
    double most = std::max(speed.at_point(found.segment), speed.at_point(found.segment + 1));
    for (std::size_t i = found.segment; i > 0 && follower.tip_length(i) >= found.at - allow_.tip;
         --i) {
      most = std::max(most, speed.at_point(i - 1));
    }
    for (std::size_t i = found.segment + 1;
         i + 1 < job_.program.size() && follower.tip_length(i) <= found.at + allow_.tip; ++i) {
      most = std::max(most, speed.at_point(i + 1));
    }
    return most;
  }

  void see_speed(const Coordinates& x, const Follower& follower, const Follower::Found& found,
                 std::size_t k) {
    std::vector<double> trace;
    for (const AxisFunction& f : job_.course.tip) trace.push_back(f.at(x));
    const double now = asked(follower, found);
    if (k > 0) {
      double square = 0.0;
      for (std::size_t i = 0; i < trace.size(); ++i) {
        square += (trace[i] - trace_[i]) * (trace[i] - trace_[i]);
      }
      const double way = std::sqrt(square);
      const double limit = std::max(now, asked_.back());
      speed_.see(way / counted_.period, limit + 2.0 * allow_.speed / counted_.period);
    }
    asked_.push_back(now);
    traces_.push_back(trace);
    if (traces_.size() > kLongWindow + 1) {
      traces_.erase(traces_.begin());
      asked_.erase(asked_.begin());
    }
    if (traces_.size() == kLongWindow + 1) see_long_window();
    trace_ = std::move(trace);
  }

  void see_long_window() {
    double square = 0.0;
    for (std::size_t i = 0; i < traces_.front().size(); ++i) {
      const double step = traces_.back()[i] - traces_.front()[i];
      square += step * step;
    }
    const double time = static_cast<double>(kLongWindow) * counted_.period;
    const double limit = *std::ranges::max_element(asked_);
    long_.see(std::sqrt(square) / time, limit + 2.0 * allow_.speed / time);
  }

  void see_lead(const Coordinates& x, const Follower& follower, double at) {
    const Program& program = job_.program;
    const bool lead =
        at < follower.tip_length(program.cut_first) || at > follower.tip_length(program.cut_last);
    if (!lead || std::abs(at - lead_at_) < kLeadStep) return;
    lead_at_ = at;
    CutPoint point{x[0], x[1], x[2], false, 0.0};
    if (const auto& section = border_->cut.section)
      point.phi = girth_at(*section, {x[3], x[4]}) / border_->cut.radius;
    lead_.see(intrusion(*border_, point),
              lead_touch(*border_, spec_.motion.eps_tip) + allow_.tip + allow_.thickness);
  }

  Followed result(const Follower& follower) const {
    Followed out;
    const auto add = [&out](const Worst& worst, const char* name, const char* unit) {
      if (worst.any()) out.checks.push_back(worst.check(name, unit));
    };
    Worst skipped;
    skipped.see(follower.farthest_missed(), allow_.skipped);
    add(tip_, "I10", "mm");
    add(skipped, "I11", "mm");
    add(bevel_, "I12", "deg");
    add(standoff_, "I13", "mm");
    add(speed_, "I14", "mm/s");
    add(long_, "I15", "mm/s");
    add(lead_, "lead_clears_part", "mm");
    out.deviation = tip_.check({}, {}).value;
    return out;
  }

  const ScheduleSpec& spec_;
  const PreparedCut& job_;
  const Counted& counted_;
  Reconstruction torch_;
  double largest_b_;
  Coordinates quantum_;
  Allowance allow_ = {};
  std::optional<PartBorder> border_ = {};
  std::vector<double> trace_ = {};
  std::vector<std::vector<double>> traces_ = {};
  std::vector<double> asked_ = {};
  double lead_at_ = -1e300;
  Worst tip_, bevel_, standoff_, speed_, long_, lead_;
};

bool any_tip_known(const PreparedCut& job, const Reconstruction& torch) {
  for (std::size_t c = 0; c < job.program.x.size(); ++c) {
    if (job.program.coordinates[c].group == Group::tip && torch.knows(c)) return true;
  }
  return false;
}

}  // namespace

void Worst::see(double value, double limit) {
  // compares value / limit without a division, because a limit may be zero
  const bool worse = !any_ || value * limit_ > value_ * limit ||
                     (limit == 0.0 && limit_ == 0.0 && value > value_) || std::isnan(value);
  if (worse && !std::isnan(value_)) {
    value_ = value;
    limit_ = limit;
  }
  any_ = true;
}

Followed path_invariants(const ScheduleSpec& spec, const PreparedCut& job, const Counted& counted,
                         bool with_lead) {
  if (!any_tip_known(job, Reconstruction(spec))) return {};
  return Examination(spec, job, counted, with_lead).run();
}

}  // namespace tubecut::motion
