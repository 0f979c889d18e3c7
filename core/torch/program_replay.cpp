#include "core/torch/program_replay.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/motion/replay/invariants.hpp"
#include "core/motion/replay/reconstruction.hpp"
#include "core/torch/stretches.hpp"
#include "core/torch/tab_width.hpp"
#include "core/torch/torch_stand.hpp"

namespace tubecut::torch {
namespace {

using Kind = Segment::Kind;
using motion::EventKind;
using motion::Worst;

constexpr double kRounding = 1e-9;     // s, mm
constexpr double kTabRounding = 2e-6;  // mm, tolerance of a tab's position

/// The worst of checks of one name.
class WorstOf {
 public:
  void see(const Check& check) {
    for (auto& [name, unit, worst] : all_)
      if (name == check.name) return worst.see(check.value, check.limit);
    all_.push_back({check.name, check.unit, {}});
    all_.back().worst.see(check.value, check.limit);
  }
  [[nodiscard]] std::vector<Check> checks() const {
    std::vector<Check> out;
    for (const auto& [name, unit, worst] : all_) out.push_back(worst.check(name, unit));
    return out;
  }

 private:
  struct One {
    std::string name, unit;
    Worst worst;
  };
  std::vector<One> all_ = {};
};

/// The input of the checks: the program as required and the counts as received.
struct ReplayInput {
  const ProgramSpec& spec;
  const std::vector<ProgramCut>& cuts;
  const std::vector<Segment>& segments;
  const std::vector<motion::Event>& events;
  const motion::Counted& counted;
};

/// Returns the number of borders at which the list of segments differs from the program.
double wrong_borders(const ReplayInput& l) {
  const auto& segments = l.segments;
  auto expected = expected_segments(l.cuts);
  if (segments.size() == expected.size() + 1) expected.push_back({Kind::rapid, l.cuts.size() - 1});
  if (segments.size() != expected.size()) return 1.0;
  double wrong = 0.0;
  std::int64_t at = 0;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const auto& s = segments[k];
    const bool right = s.kind == expected[k].kind && s.cut == expected[k].cut;
    if (!right || s.from != at || s.to < s.from) wrong += 1.0;
    at = s.to;
  }
  return wrong + (at == static_cast<std::int64_t>(l.counted.periods) ? 0.0 : 1.0);
}

/// The events that switch a tool on and off.
struct Switch {
  EventKind on = EventKind::torch_on, off = EventKind::torch_off;
};
constexpr Switch kTorch{}, kMarker{EventKind::mark_on, EventKind::mark_off};

/// Returns the periods of a segment in which a tool is on, from the events only.
std::int64_t lit(const Switch& tool, const std::vector<motion::Event>& events, std::int64_t from,
                 std::int64_t to) {
  std::int64_t out = 0, on = -1;
  for (const auto& event : events) {
    if (event.what == tool.on) on = event.period;
    if (event.what != tool.off || on < 0) continue;
    out += std::max<std::int64_t>(0, std::min(to, event.period) - std::max(from, on));
    on = -1;
  }
  return on < 0 ? out : out + std::max<std::int64_t>(0, to - std::max(from, on));
}

/// Returns the periods of cuts and marks in which their tool is off, and of all other segments in
/// which a tool is on.
double wrongly_lit(const ReplayInput& l) {
  std::int64_t out = 0;
  for (const auto& s : l.segments) {
    const auto burning = lit(kTorch, l.events, s.from, s.to);
    const auto marking = lit(kMarker, l.events, s.from, s.to);
    const auto all = s.to - s.from;
    if (s.kind != Kind::pierce) out += s.kind == Kind::cut ? all - burning : burning;
    out += s.kind == Kind::mark ? all - marking : marking;
  }
  return static_cast<double>(out);
}

/// Returns the counts of a segment, with all pulses before it.
motion::Counted stretch(const motion::Counted& whole, const Segment& segment,
                        std::vector<std::int64_t> before) {
  const auto from = static_cast<std::size_t>(segment.from);
  const auto size = static_cast<std::size_t>(segment.to - segment.from);
  motion::Counted out{whole.period, size, {}, whole.start, std::move(before)};
  for (const auto& counts : whole.counts)
    out.counts.push_back(counts.empty() ? counts : counts.subspan(from, size));
  return out;
}

void add_up(const motion::Counted& stretch, std::vector<std::int64_t>& sums) {
  for (std::size_t a = 0; a < sums.size(); ++a)
    for (std::size_t k = 0; k < stretch.counts[a].size() && !stops(k); ++k)
      sums[a] += stretch.counts[a][k];
}

/// Checks between the cuts: position and duration of the pierce, and the tip's height on the way.
class Between {
 public:
  explicit Between(const ReplayInput& l) : l_(l), machine_(l.spec.machine) {
    const auto lift = motion::lift_of(machine_);
    if (lift) {
      pivot_ = lift->pivot_length;
      lifts_ = true;
      motion::set_standoff(machine_, l.spec.setup.pierce_off());
    }
    for (std::size_t a = 0; a < machine_.axes.size(); ++a) {
      const auto& name = machine_.axes[a].name;
      high_.push_back(lift && (name == lift->axis || name == lift->fine));
      if (name == "B") swing_ = a;
    }
  }

  void see_pierce(const ProgramCut& cut, double turns, const motion::Counted& counted) {
    auto job = cut_job(l_.spec, cut, turns);
    job.machine = machine_;
    const motion::Reconstruction torch(job);
    motion::AxisValues values(counted, machine_);
    const auto x = torch.at(values.now());
    const auto sign = machine_.b_positive == motion::BPositive::outer_edge_to_waste ? -1.0 : 1.0;
    const auto quantum = torch.quantum(std::abs(cut.first().b));
    const double radius = cut.cut.path.outer_radius;
    const auto wanted = first_of(machine_, cut, turns, l_.spec.motion.lean);
    const double turned = cut.cut.path.section ? std::abs(x[0] - wanted[0])
                                               : std::abs(x[0] - cut.first().phi - turns);
    see(pierce_, turned * radius, radius * quantum[0]);
    see(pierce_, std::abs(x[1] - cut.first().z), quantum[1]);
    see(pierce_, std::abs(x[2] - sign * cut.first().b) * radius, radius * quantum[2]);
    if (cut.cut.path.section)
      see(pierce_, elementary::hypot(x[3] - wanted[3], x[4] - wanted[4]), quantum[3]);
    if (const auto off = torch.standoff_error(values.now()))
      see(pierce_, std::abs(*off), torch.standoff_quantum());
    const double asked = l_.spec.setup.pierce_delay;
    see(delay_, asked - static_cast<double>(still(counted)) * counted.period, 0.0);
  }

  /// Checks the tip's height over the tube while other axes move. Between two places B is linear,
  /// so the tip is lower by at most its bend. `highest`: of the outside over the axis, in any turn.
  void see_rapid(double highest, const motion::Counted& counted) {
    if (!lifts_) return;
    motion::AxisValues values(counted, machine_);
    double before = height(values.now());
    for (std::size_t k = 0; k < counted.periods && !stops(k); ++k) {
      const double b = swing(values.now());
      values.step(k);
      const double now = height(values.now());
      const double swung = (swing(values.now()) - b) * kRadPerDeg;
      const double bend = pivot_ * swung * swung / 8.0;
      if (level(counted, k))
        see(clear_, l_.spec.setup.clearance + highest - std::min(before, now) + bend,
            quantum() + bend);
      before = now;
    }
  }

  void report(WorstOf& out) const {
    const auto add = [&](const Worst& worst, const char* name, const char* unit) {
      if (worst.any()) out.see(worst.check(name, unit));
    };
    add(pierce_, "pierce_place", "mm");
    add(delay_, "pierce_delay", "s");
    add(clear_, "rapid_clearance", "mm");
  }

 private:
  static void see(Worst& worst, double value, double limit) {
    worst.see(worst_of({0.0, value}), limit + kRounding);
  }

  /// Computes the height of the tip over the tube's axis, independently of the code that made the
  /// counts.
  [[nodiscard]] double height(const std::vector<double>& q) const {
    double pivot = 0.0;
    for (std::size_t a = 0; a < q.size(); ++a)
      if (high_[a]) pivot += q[a];
    return pivot - pivot_ * elementary::cos(swing(q) * kRadPerDeg);
  }

  /// Returns the axis B in deg; 0 of a machine that does not swing.
  [[nodiscard]] double swing(const std::vector<double>& q) const {
    return swing_ ? q[*swing_] : 0.0;
  }

  /// Returns the change of the tip's height by rounding to pulses.
  [[nodiscard]] double quantum() const {
    double out = 0.0;
    for (std::size_t a = 0; a < high_.size(); ++a) {
      const double half = 0.5 / machine_.axes[a].pulses_per_axis_unit();
      if (high_[a]) out += half;
      if (swing_ == a) out += pivot_ * half * kRadPerDeg;
    }
    return out;
  }

  [[nodiscard]] bool level(const motion::Counted& counted, std::size_t k) const {
    for (std::size_t a = 0; a < high_.size(); ++a)
      if (!high_[a] && !counted.counts[a].empty() && counted.counts[a][k] != 0) return true;
    return false;
  }

  /// Returns the periods at the segment's start without any pulse.
  [[nodiscard]] std::size_t still(const motion::Counted& counted) const {
    for (std::size_t k = 0; k < counted.periods && !stops(k); ++k)
      for (const auto& counts : counted.counts)
        if (!counts.empty() && counts[k] != 0) return k;
    return counted.periods;
  }

  const ReplayInput& l_;
  motion::Machine machine_;  // with the standoff of the pierce
  double pivot_ = 0.0;
  bool lifts_ = false;
  std::vector<bool> high_ = {};
  std::optional<std::size_t> swing_ = {};  // the axis B
  Worst pierce_ = {}, delay_ = {}, clear_ = {};
};

/// Measures the metal of every tab from the counts: from the segment that ends there to the one
/// that continues, or the first.
class SeenTabs {
 public:
  explicit SeenTabs(const ReplayInput& l) : l_(l) {
    for (std::size_t k = 0; k < l.cuts.size(); ++k) {
      const auto& cut = l.cuts[k];
      const bool any = cut.way.points.stretch;
      const auto beside =
          any ? beside_tab(cut.cut, tabs(), cut.way, l.cuts[next(k)].way) : BesideTab{};
      const auto into =
          any ? beside_tab(cut.cut, tabs(), l.cuts[before(k)].way, cut.way) : BesideTab{};
      trails_.emplace_back(cut.cut.path.radius(), into.start, beside.end);
    }
  }

  /// Follows the counts of a cut's segment; `turns`: of its winding.
  void follow(std::size_t k, double turns, const motion::Counted& counted) {
    const auto& cut = l_.cuts[k];
    if (!cut.way.points.stretch) return;
    const motion::Reconstruction torch(cut_job(l_.spec, cut, turns));
    if (!(torch.knows(0) && torch.knows(1))) return;
    const auto& machine = l_.spec.machine;
    const double sign = machine.b_positive == motion::BPositive::outer_edge_to_waste ? -1.0 : 1.0;
    motion::AxisValues values(counted, machine);
    const auto add = [&] {
      const auto x = torch.at(values.now());
      trails_[k].add({.phi = x[0] - turns, .z = x[1], .b = sign * x[2]});
    };
    add();
    for (std::size_t p = 0; p < counted.periods && !stops(p); ++p) {
      values.step(p);
      add();
    }
  }

  /// Errors  those of torch_border.
  Result<void> report(WorstOf& out) const {
    motion::PartBorder border;  // of the cut that these segments belong to
    for (std::size_t k = 0; k < l_.cuts.size(); ++k) {
      const auto& cut = l_.cuts[k];
      if (!cut.way.points.stretch) continue;
      if (cut.stretch == 0) {
        TRY(border, torch_border(cut.cut));
      }
      const auto &end = trails_[k].end(), &start = trails_[next(k)].start();
      if (end.empty() || start.empty()) continue;
      const double metal = metal_between(border, cut.cut.kerf, end, start);
      const motion::Reconstruction torch(cut_job(l_.spec, cut, 0.0));
      out.see({"tab_width", worst_of({0.0, tabs().width - metal}),
               tab_rounding(torch, cut) + kTabRounding, "mm"});
    }
    return {};
  }

 private:
  [[nodiscard]] const Tabs& tabs() const { return *l_.spec.setup.tabs; }
  [[nodiscard]] std::size_t next(std::size_t k) const {
    const auto& cut = l_.cuts[k];
    return cut.stretch + 1 == cut.stretches ? k - cut.stretch : k + 1;
  }
  [[nodiscard]] std::size_t before(std::size_t k) const {
    const auto& cut = l_.cuts[k];
    return cut.stretch == 0 ? k + cut.stretches - 1 : k - 1;
  }

  const ReplayInput& l_;
  std::vector<Trail> trails_ = {};
};

/// Runs all checks that are possible if the segments are the program's.
///
/// Errors  those of motion::prepare_cut.
Result<void> examine(const ReplayInput& l, bool own, std::vector<Check>& out, double& deviation) {
  WorstOf all;
  Between between(l);
  SeenTabs tabs(l);
  const auto turns = windings(l.cuts);
  std::vector<std::int64_t> sums(l.counted.counts.size(), 0);
  for (const auto& segment : l.segments) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    const auto part = stretch(l.counted, segment, sums);
    const auto& cut = l.cuts[segment.cut];
    if (segment.kind == Kind::rapid) between.see_rapid(highest(cut.cut.path), part);
    if (segment.kind == Kind::pierce) between.see_pierce(cut, turns[segment.cut], part);
    if (segment.kind == Kind::cut || segment.kind == Kind::mark) {
      const auto job = cut_job(l.spec, cut, turns[segment.cut]);
      TRY(const auto prepared, motion::prepare_cut(job));
      for (const auto& check : motion::place_invariants(prepared, part)) all.see(check);
      const auto followed = motion::path_invariants(job, prepared, part, own);
      for (const auto& check : followed.checks) all.see(check);
      worsen(deviation, followed.deviation);
      tabs.follow(segment.cut, turns[segment.cut], part);
    }
    add_up(part, sums);
  }
  const auto& machine = l.spec.machine;
  for (const auto& check : motion::rate_invariants(machine, l.counted, l.spec.motion.jerk))
    all.see(check);
  all.see({"torch_lit", wrongly_lit(l), 0.0, "periods"});
  TRY(tabs.report(all));
  between.report(all);
  for (auto& check : all.checks()) out.push_back(std::move(check));
  return {};
}

}  // namespace

std::vector<Check> verify(const ProgramSpec& spec, const ProgramSchedule& schedule) {
  const auto& whole = schedule.whole;
  const std::vector<Check> misfit{{"replayable", 1.0, 0.0, ""}};
  const auto cuts = program_cuts(spec);
  if (!cuts || whole.axes.size() != spec.machine.axes.size() ||
      whole.period != spec.machine.period || whole.periods <= 0)
    return misfit;
  motion::Counted counted{whole.period, static_cast<std::size_t>(whole.periods), {}, {}, {}};
  for (const auto& axis : whole.axes) {
    if (!axis.idle() && axis.counts.size() != counted.periods) return misfit;
    counted.counts.emplace_back(axis.counts);
    counted.start.push_back(axis.start);
  }
  const ReplayInput input{spec, *cuts, schedule.segments, whole.events, counted};
  std::vector<Check> out{{"I1", 0.0, 0.0, "pulses"},
                         {"segments_join", wrong_borders(input), 0.0, ""}};
  double deviation = 0.0;
  if (!out.back().passed()) return out;
  return examine(input, true, out, deviation) ? out : misfit;
}

Result<motion::Replay> replay(const ProgramReplaySpec& spec) {
  TRY(motion::check(spec.job.machine));
  TRY(const auto cuts, program_cuts(spec.job));
  TRY(const auto whole, motion::received(spec.job.machine, spec.period, spec.counts, spec.start));
  const auto counted = whole.counted();
  auto segments = spec.segments;
  const auto expected = expected_segments(cuts);
  for (std::size_t k = 0; k < segments.size(); ++k)
    segments[k].cut = k < expected.size() ? expected[k].cut : cuts.size() - 1;
  const ReplayInput input{spec.job, cuts, segments, spec.events, counted};
  motion::Replay out;
  out.invariants = {{"I1", whole.worst, 0.0, "pulses"},
                    {"segments_join", wrong_borders(input), 0.0, ""}};
  motion::rebuild(cut_job(spec.job, cuts.front(), 0.0), counted, out);
  if (out.invariants.back().passed()) {
    if (auto ok = examine(input, false, out.invariants, out.deviation); !ok)
      return tl::unexpected<Error>(ok.error());
  }
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  return out;
}

}  // namespace tubecut::torch
