#include "core/torch/program_schedule.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/motion/path/path_positions.hpp"
#include "core/motion/timing/straight_move.hpp"
#include "core/torch/tab_width.hpp"
#include "core/torch/torch_stand.hpp"

namespace tubecut::torch {
namespace {

using motion::EventKind;

/// Periods at rest after a leg, so that the third difference at its end includes no other leg.
constexpr std::int64_t kRest = 2;

/// Returns the text of an error or warning with the name of its cut before it.
std::string of_cut(const std::string& name, const std::string& text) {
  return name.empty() ? text : "cut " + name + (text.empty() ? "" : ": " + text);
}

Error told_of(const TorchCut& cut, Error error) {
  for (auto& issue : error.issues) {
    issue.hint = of_cut(cut.name, issue.hint);
    if (issue.member.starts_with("lead") || issue.member.starts_with("tabs"))
      issue.member = "motion/" + issue.member;
    if (!issue.member.starts_with("motion") && !issue.member.starts_with("machine"))
      issue.member = "part";
  }
  return error;
}

double& larger(double& most, double value) { return most = std::max(most, value); }

void add_uses(const std::vector<motion::Use>& uses, std::vector<motion::Use>& out) {
  for (const auto& use : uses) {
    const auto same = std::ranges::find_if(
        out, [&](const auto& o) { return o.axis == use.axis && o.limit == use.limit; });
    if (same == out.end())
      out.push_back(use);
    else
      larger(same->share, use.share);
  }
}

/// Combines the cuts' reports, without marks: sums of times and lengths, else the worst.
class WholeReport {
 public:
  void add(const motion::Report& r) {
    auto& all = all_;
    if (!any_) all.least_tip = r.least_tip;
    any_ = true;
    all.time += r.time;
    all.ideal += r.ideal;
    all.no_jerk += r.no_jerk;
    all.proven += r.proven;
    least_ += r.time / r.optimality;
    all.length += r.length;
    all.slow_time += r.slow_time;
    all.least_tip = std::min(all.least_tip, r.least_tip);
    for (const auto of :
         {&motion::Report::filter, &motion::Report::stretch, &motion::Report::deviation_tip,
          &motion::Report::deviation_b, &motion::Report::sag_tip, &motion::Report::sag_b,
          &motion::Report::standoff_growth, &motion::Report::closing_residual})
      larger(all.*of, r.*of);
    add_uses(r.max_use, all.max_use);
    all.slow.insert(all.slow.end(), r.slow.begin(), r.slow.end());
    if (r.lean) all.lean = std::max(*r.lean, all.lean.value_or(0.0));
    if (!r.edges) return;
    if (!all.edges) all.edges.emplace();
    larger(all.edges->outer, r.edges->outer);
    larger(all.edges->inner, r.edges->inner);
  }

  /// `time` is the total; the time between the cuts is the same in every plan.
  [[nodiscard]] motion::Report of_all(double time) const {
    motion::Report out = all_;
    const double beside = time - all_.time;
    for (const auto of : {&motion::Report::time, &motion::Report::ideal, &motion::Report::no_jerk,
                          &motion::Report::proven})
      out.*of += beside;
    out.optimality = time / (least_ + beside);
    return out;
  }

 private:
  motion::Report all_ = {};
  double least_ = 0.0;  // s, lower bound of every plan of the cuts
  bool any_ = false;
};

/// mm/s, the smallest and the largest requested speed.
struct Speeds {
  double least = 0.0, most = 0.0;
};
Speeds speeds(const motion::Speed& speed) {
  const auto* const table = std::get_if<motion::SpeedTable>(&speed);
  if (table == nullptr) return {std::get<double>(speed), std::get<double>(speed)};
  const auto [least, most] =
      std::ranges::minmax(table->pairs, {}, [](const auto& pair) { return pair.second; });
  return {least.second, most.second};
}

motion::Speed speed_of(const ProgramSpec& spec, const TorchCut& cut) {
  if (cut.mark && spec.setup.mark_speed) return *spec.setup.mark_speed;
  return spec.motion.speed;
}

/// Checks the periods of all paths at the fastest requested speed before any of them is planned:
/// smoothing shortens them by less than half.
Result<void> check_periods(const ProgramSpec& spec, const std::vector<ProgramCut>& cuts) {
  double seconds = 0.0;
  for (const auto& cut : cuts) {
    const auto& path = cut.cut.path;
    const bool inner = spec.motion.speed_on == motion::Surface::inner;
    const motion::Track way{cut.way.points.points, inner ? path.inner_radius() : path.outer_radius};
    for (std::size_t i = 1; i < way.points.size(); ++i)
      seconds += way.tip_step(i - 1, i) / speeds(speed_of(spec, cut.cut)).most;
    if (!cut.cut.mark) seconds += spec.setup.pierce_delay;
  }
  const double periods = seconds / spec.machine.period;
  if (0.5 * periods <= static_cast<double>(spec.max_periods)) return {};
  return motion::too_many_periods(periods, spec.max_periods);
}

class Scheduling {
 public:
  Scheduling(const ProgramSpec& spec, std::vector<ProgramCut> cuts, TorchStand stand)
      : spec_(spec),
        turns_(windings(cuts)),
        stand_(std::move(stand)),
        counter_(spec.machine, stand_.clear(over(cuts, 0))) {
    out_.cuts = std::move(cuts);
  }

  Result<ProgramSchedule> run() {
    TRY(stand_.check(counter_.at()));
    for (std::size_t i = 0; i < out_.cuts.size(); ++i) {
      const bool mark = out_.cuts[i].cut.mark;
      TRY(told(i, go_to(i)));
      if (!mark) TRY(told(i, pierce(i)));
      TRY(told(i, cut(i, mark)));
    }
    const std::size_t last = out_.cuts.size() - 1;
    if (stand_.lifts()) {
      begin(Segment::Kind::rapid, last);
      counter_.rest(kRest);
      TRY(told(last, leg({.to = stand_.clear(counter_.at())})));
      end();
    }
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    return finished();
  }

 private:
  /// Returns the axis values at the start of a cut's pierce, or of a mark's stroke.
  std::vector<double> over(const std::vector<ProgramCut>& cuts, std::size_t i) const {
    return cuts[i].cut.mark ? stand_.cutting(cuts[i], turns_[i])
                            : stand_.piercing(cuts[i], turns_[i]);
  }
  Result<void> told(std::size_t i, Result<void> result) const {
    if (result) return result;
    return tl::unexpected(told_of(out_.cuts[i].cut, std::move(result).error()));
  }
  void event(EventKind what, std::size_t i) {
    out_.whole.events.push_back({counter_.periods(), what, i});
  }
  void begin(Segment::Kind kind, std::size_t i) {
    out_.segments.push_back({.kind = kind, .cut = i, .from = counter_.periods()});
    if (kind == Segment::Kind::rapid) event(EventKind::rapid_start, i);
  }
  void end() {
    auto& segment = out_.segments.back();
    segment.to = counter_.periods();
    if (segment.kind == Segment::Kind::rapid) event(EventKind::rapid_end, segment.cut);
  }

  /// Samples one straight move and its rest.
  Result<void> leg(motion::StraightMove move) {
    move.from = counter_.at();
    TRY(stand_.check(move.to));
    const auto curve = motion::timed(move, spec_.machine, spec_.motion.jerk);
    if (!curve) return {};
    const double periods = motion::periods_of(curve->time(), spec_.machine.period);
    TRY(room_for(periods + static_cast<double>(kRest)));
    const auto n = static_cast<std::size_t>(periods);
    counter_.expect(static_cast<std::int64_t>(n) + kRest);
    auto q = move.to;
    for (std::size_t k = 1; k < n && !stops(k); ++k) {
      const double u = curve->at(curve->time() * static_cast<double>(k) / periods);
      for (std::size_t a = 0; a < q.size(); ++a)
        q[a] = move.from[a] + u * (move.to[a] - move.from[a]);
      counter_.step(q);
    }
    counter_.step(move.to);
    counter_.rest(kRest);
    return {};
  }

  /// Moves off the tube, turns and moves along it, and down again.
  Result<void> go_to(std::size_t i) {
    const auto to = over(out_.cuts, i);
    begin(Segment::Kind::rapid, i);
    if (i > 0) counter_.rest(kRest);
    if (stand_.lifts()) TRY(leg({.to = stand_.clear(counter_.at())}));
    TRY(leg({.to = stand_.clear(to)}));
    if (stand_.lifts()) TRY(leg({.to = to}));
    end();
    return {};
  }

  Result<void> pierce(std::size_t i) {
    begin(Segment::Kind::pierce, i);
    event(EventKind::pierce, i);
    event(EventKind::torch_on, i);
    const double dwell = std::ceil(spec_.setup.pierce_delay / spec_.machine.period - 1e-6);
    TRY(room_for(dwell));
    counter_.rest(static_cast<std::int64_t>(std::max(0.0, dwell)));
    event(EventKind::pierce_end, i);
    TRY(leg({.to = stand_.cutting(out_.cuts[i], turns_[i]),
             .length = std::abs(spec_.setup.pierce_off() - spec_.setup.cut_height),
             .speed = speeds(spec_.motion.speed).least}));
    end();
    return {};
  }

  Result<void> cut(std::size_t i, bool mark) {
    auto job = cut_job(spec_, out_.cuts[i], turns_[i]);
    job.max_periods = spec_.max_periods - counter_.periods();
    TRY(auto planned, in_room(motion::plan_cut(job)));
    begin(mark ? Segment::Kind::mark : Segment::Kind::cut, i);
    const auto from = counter_.periods();
    if (mark) event(EventKind::mark_on, i);
    for (auto event : planned.events) {
      if (mark) break;
      if (event.what == EventKind::pierce || event.what == EventKind::torch_on) continue;
      event.period += from;
      event.cut = i;
      out_.whole.events.push_back(event);
    }
    counter_.follow(planned);
    if (mark) event(EventKind::mark_off, i);
    end();
    for (auto& zone : planned.report.slow) {
      zone.from += from;
      zone.to += from;
    }
    if (mark) planned.report.slow.clear();  // nothing burns while the torch is off
    for (auto& warning : motion::warnings(job, planned.report)) {
      if (warning.member == "contour") warning.member = "part";
      warning.detail = of_cut(out_.cuts[i].cut.name, warning.detail);
      out_.whole.warnings.push_back(std::move(warning));
    }
    if (!mark) report_.add(planned.report);
    out_.segments.back().sums = counter_.sums_from(from);
    out_.segments.back().report = std::move(planned.report);
    return {};
  }

  Result<void> room_for(double periods) const {
    const double all = static_cast<double>(counter_.periods()) + periods;
    if (all <= static_cast<double>(spec_.max_periods)) return {};
    return motion::too_many_periods(all, spec_.max_periods);
  }

  /// Converts the cut's own limit of periods to that of the whole.
  Result<motion::PlannedCut> in_room(Result<motion::PlannedCut> planned) const {
    if (planned || planned.error().code() != ErrorCode::too_many_periods) return planned;
    auto& issue = planned.error().issues.front();
    const auto* const asked = std::get_if<double>(&issue.got);
    const double more = asked != nullptr ? *asked : 0.0;
    issue.got = static_cast<double>(counter_.periods()) + more;
    issue.limit = static_cast<double>(spec_.max_periods);
    return planned;
  }

  ProgramSchedule finished() {
    auto& whole = out_.whole;
    whole.period = spec_.machine.period;
    whole.periods = counter_.periods();
    whole.axes = counter_.take();
    whole.report = report_.of_all(static_cast<double>(whole.periods) * whole.period);
    return std::move(out_);
  }

  const ProgramSpec& spec_;
  std::vector<double> turns_;
  TorchStand stand_;
  motion::PulseCounter counter_;
  ProgramSchedule out_ = {};
  WholeReport report_ = {};
};

}  // namespace

std::vector<Expected> expected_segments(const std::vector<ProgramCut>& cuts) {
  using enum Segment::Kind;
  std::vector<Expected> out;
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    out.push_back({rapid, i});
    if (!cuts[i].cut.mark) out.push_back({pierce, i});
    out.push_back({cuts[i].cut.mark ? mark : cut, i});
  }
  return out;
}

double ProgramSchedule::time_of(Segment::Kind kind) const {
  std::int64_t periods = 0;
  for (const auto& segment : segments)
    if (segment.kind == kind) periods += segment.to - segment.from;
  return static_cast<double>(periods) * whole.period;
}

motion::ScheduleSpec cut_job(const ProgramSpec& spec, const ProgramCut& cut, double turns) {
  const auto sign = spec.machine.b_positive == motion::BPositive::outer_edge_to_waste ? -1.0 : 1.0;
  auto path =
      motion::as_machine_counts(motion::without_repeats(cut.cut.path), spec.machine.b_positive);
  path = motion::turned_on(std::move(path), turns);
  motion::ScheduleSpec out{.machine = spec.machine, .motion = spec.motion};
  if (!cut.cut.mark) out.motion.lead = spec.setup.lead;
  out.motion.speed = speed_of(spec, cut.cut);
  out.motion.direction = motion::Direction::as_given;
  out.motion.sector = {};
  out.motion.start = {};
  if (out.motion.lead) out.motion.lead->radius = cut.way.radius;
  if (out.motion.lead || cut.start != motion::Start::At::first_point || cut.way.points.stretch) {
    out.way = cut.way.points;
    for (auto& point : out.way->points) {
      point.phi += turns;
      point.b *= sign;
    }
  }
  out.cut = std::move(path);
  out.max_periods = spec.max_periods;
  return out;
}

Result<std::vector<ProgramCut>> program_cuts(const ProgramSpec& spec) {
  std::vector<ProgramCut> out;
  for (const auto& cut : spec.cuts) {
    if (!cut.path.a.empty())
      return tl::unexpected(told_of(
          cut,
          Issue{.code = ErrorCode::unsupported_combination,
                .hint = "its torch leans across the tube, and the machine has no axis for it"}));
    auto made = followed_cut(spec, cut, &cut == &spec.cuts.back());
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    if (!made) return tl::unexpected(told_of(cut, std::move(made).error()));
    std::ranges::move(*made, std::back_inserter(out));
  }
  return out;
}

Result<ProgramSchedule> schedule(const ProgramSpec& spec) {
  TRY(motion::check(spec.machine));
  TRY(auto cuts, program_cuts(spec));
  TRY(check_periods(spec, cuts));
  TRY(auto stand,
      TorchStand::of(spec.machine, cuts.front().cut.path, spec.setup, spec.motion.lean));
  return Scheduling(spec, std::move(cuts), std::move(stand)).run();
}

}  // namespace tubecut::torch
