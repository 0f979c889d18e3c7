#include "core/torch/program_schedule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "core/torch/program_replay.hpp"

namespace tubecut::torch {
namespace {

using motion::EventKind;
using Kind = Segment::Kind;

constexpr double kRadius = 57.0, kWall = 5.0;

motion::CutPath on_tube(motion::Scrap scrap) {
  return {.outer_radius = kRadius, .wall = kWall, .closed = true, .scrap = scrap};
}

TorchCut end_cut(std::string name, double z, motion::Scrap scrap) {
  TorchCut out{.name = std::move(name), .path = on_tube(scrap), .kerf = 2.0};
  for (int i = 0; i < 180; ++i) {
    const double phi = kTwoPi * i / 180;
    out.path.phi.push_back(phi);
    out.path.z.push_back(z + 12.0 * std::cos(2.0 * phi));
    out.path.b.push_back(0.3 * std::cos(2.0 * phi + 0.4));
  }
  return out;
}

TorchCut hole_cut(std::string name, double phi, double z) {
  TorchCut out{.name = std::move(name), .path = on_tube(motion::Scrap::inside), .kerf = 2.0};
  for (int i = 0; i <= 90; ++i) {
    const double t = kTwoPi * (i % 90) / 90;
    out.path.phi.push_back(phi + 15.0 / kRadius * std::cos(t));
    out.path.z.push_back(z + 15.0 * std::sin(t));
    out.path.b.push_back(0.25 * std::sin(t));
  }
  return out;
}

ProgramSpec program() {
  ProgramSpec out;
  out.cuts = {hole_cut("hole 0", 0.7, 301.0), hole_cut("hole 1", 4.0, 199.3),
              end_cut("finish", 400.1, motion::Scrap::plus_z),
              end_cut("start", 30.7, motion::Scrap::minus_z)};
  out.machine = motion::catalogue().front().machine;
  std::get<motion::FiveAxisCutter>(out.machine.kinematics).standoff = 1.5;
  out.setup = {.lead = motion::Lead{.radius = 4.0},
               .clearance = 40.0,
               .cut_height = 1.5,
               .pierce_height = 4.0,
               .pierce_delay = 0.31};
  out.motion.speed = 20.0;
  return out;
}

/// Value of one axis, in its unit, after `periods` periods.
double value(const ProgramSpec& spec, const motion::Schedule& s, std::size_t axis,
             std::int64_t periods) {
  std::int64_t sum = 0;
  const auto& a = s.axes[axis];
  for (std::int64_t k = 0; k < periods && !a.idle(); ++k)
    sum += a.counts[static_cast<std::size_t>(k)];
  return a.start + static_cast<double>(sum) / spec.machine.axes[axis].pulses_per_axis_unit();
}

std::set<std::string> broken(const ProgramSpec& spec, const ProgramSchedule& schedule) {
  std::set<std::string> out;
  for (const auto& check : verify(spec, schedule))
    if (!check.passed()) out.insert(check.name);
  return out;
}

class Scheduled : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto made = schedule(program());
    ASSERT_TRUE(made) << made.error().issues.front().member << made.error().issues.front().hint;
    s_ = new ProgramSchedule(*std::move(made));
  }
  static void TearDownTestSuite() { delete s_; }
  static ProgramSchedule* s_;
};
ProgramSchedule* Scheduled::s_ = nullptr;

TEST_F(Scheduled, HoldsEveryInvariant) {
  std::set<std::string> names;
  for (const auto& check : verify(program(), *s_)) {
    EXPECT_TRUE(check.passed()) << check.name << " " << check.value << " " << check.limit;
    names.insert(check.name);
  }
  for (const char* const name : {"I1",
                                 "I2",
                                 "I4",
                                 "I5",
                                 "I6",
                                 "I7",
                                 "I8",
                                 "I9",
                                 "I10",
                                 "I11",
                                 "I12",
                                 "I13",
                                 "I14",
                                 "I15",
                                 "I16",
                                 "lead_clears_part",
                                 "segments_join",
                                 "torch_lit",
                                 "pierce_place",
                                 "pierce_delay",
                                 "rapid_clearance"})
    EXPECT_TRUE(names.contains(name)) << name;
}

/// On a table the height is axis Z, also without a swing, and X rests over a round tube.
TEST(OnATable, HoldsEveryInvariant) {
  for (const bool swings : {true, false}) {
    auto spec = program();
    spec.machine = motion::catalogue().back().machine;
    spec.machine.kinematics = motion::TubeTable{.pivot_length = 150.0, .standoff = 1.5};
    if (swings)
      spec.machine.axes.push_back(program().machine.axes.back());
    else
      for (auto& cut : spec.cuts) std::ranges::fill(cut.path.b, 0.0);
    const auto made = schedule(spec);
    ASSERT_TRUE(made) << made.error().issues.front().member << made.error().issues.front().hint;
    EXPECT_TRUE(broken(spec, *made).empty()) << *broken(spec, *made).begin();
    EXPECT_TRUE(made->whole.axes[1].idle());
    std::int64_t sum = 0, highest = 0;
    for (const auto n : made->whole.axes[3].counts) highest = std::max(highest, sum += n);
    const double per_unit = spec.machine.axes[3].pulses_per_axis_unit();
    EXPECT_NEAR(made->whole.axes[3].start + static_cast<double>(highest) / per_unit,
                kRadius + 150.0 + 40.0, 0.01);
  }
}

// By formulas of its own: the pivot of a torch of 150 mm, and the axes' limits by differences.
TEST_F(Scheduled, StandsWhereTheTorchShould) {
  const auto spec = program();
  const auto& w = s_->whole;
  for (const auto& segment : s_->segments) {
    if (segment.kind != Kind::pierce) continue;
    const auto& first = s_->cuts[segment.cut].first();
    for (const auto& [at, off] : {std::pair{segment.from, 4.0}, std::pair{segment.to, 1.5}}) {
      const double arm = 150.0 + off;
      const double turned = (value(spec, w, 0, at) - first.phi * kDegPerRad) / 360.0;
      EXPECT_NEAR(turned, std::round(turned), 1e-5);
      EXPECT_NEAR(value(spec, w, 1, at), first.z + arm * std::sin(first.b), 6e-4);
      EXPECT_NEAR(value(spec, w, 2, at), kRadius + arm * std::cos(first.b), 6e-4);
      EXPECT_NEAR(value(spec, w, 4, at), first.b * kDegPerRad, 6e-4);
    }
  }
  EXPECT_NEAR(value(spec, w, 2, 0), kRadius + 150.0 + 40.0, 6e-4);
  EXPECT_NEAR(value(spec, w, 2, w.periods), kRadius + 150.0 + 40.0, 6e-4);
}

TEST_F(Scheduled, KeepsTheLimitsAcrossAllBorders) {
  const auto spec = program();
  const double t = spec.machine.period;
  for (std::size_t a = 0; a < spec.machine.axes.size(); ++a) {
    const auto& axis = spec.machine.axes[a];
    const auto& counts = s_->whole.axes[a].counts;
    const double k = axis.pulses_per_axis_unit();
    const auto at = [&](std::ptrdiff_t i) {
      return i < 0 || i >= std::ssize(counts) ? 0.0 : static_cast<double>(counts[i]);
    };
    for (std::ptrdiff_t i = -2; i < std::ssize(counts); ++i) {
      ASSERT_LE(std::abs(at(i)), static_cast<double>(*axis.n_max));
      ASSERT_LT(std::abs(at(i)), axis.v_max * t * k + 1.0);
      ASSERT_LT(std::abs(at(i + 1) - at(i)), axis.a_max * t * t * k + 2.0);
      ASSERT_LT(std::abs(at(i + 2) - 2 * at(i + 1) + at(i)), *axis.j_max * t * t * t * k + 4.0);
    }
  }
}

// Events of a cut follow each other, and the torch is dark before its pierce and behind its lead.
TEST_F(Scheduled, TellsTheCutOfEveryEvent) {
  const std::vector<EventKind> order{
      EventKind::rapid_start, EventKind::rapid_end, EventKind::pierce,  EventKind::torch_on,
      EventKind::pierce_end,  EventKind::cut_start, EventKind::cut_end, EventKind::torch_off};
  const auto& events = s_->whole.events;
  ASSERT_EQ(events.size(), 8 * s_->cuts.size() + 2);
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(events[i].what, order[i % 8]) << i;
    EXPECT_GE(events[i].period, i > 0 ? events[i - 1].period : 0);
    EXPECT_EQ(events[i].cut, std::min(i / 8, s_->cuts.size() - 1));
  }
  for (std::size_t i = 0; i + 2 < events.size(); i += 8)
    EXPECT_GE(static_cast<double>(events[i + 4].period - events[i + 3].period) * s_->whole.period,
              0.31 - 1e-9);
  const double all = static_cast<double>(s_->whole.periods) * s_->whole.period;
  EXPECT_NEAR(s_->whole.report.time, all, 1e-9);
  EXPECT_NEAR(s_->time_of(Kind::rapid) + s_->time_of(Kind::pierce) + s_->time_of(Kind::cut), all,
              1e-9);
}

// No cut goes back by the turn that the one before has gone on.
TEST_F(Scheduled, TurnsTheNearestWay) {
  const auto spec = program();
  for (const auto& segment : s_->segments) {
    if (segment.kind != Kind::rapid) continue;
    EXPECT_LE(
        std::abs(value(spec, s_->whole, 0, segment.to) - value(spec, s_->whole, 0, segment.from)),
        180.0 + 1e-6);
  }
}

// Twenty times the same place and back: nothing adds up.
TEST(ProgramSchedule, DriftsByNoPulse) {
  auto spec = program();
  spec.cuts.assign(20, hole_cut("again", 1.234567, 77.777777));
  const auto made = schedule(spec);
  ASSERT_TRUE(made);
  std::int64_t once = -1;
  std::vector<std::int64_t> sums(spec.machine.axes.size(), 0), first;
  for (const auto& segment : made->segments) {
    for (std::size_t a = 0; a < sums.size(); ++a)
      for (auto k = segment.from; k < segment.to && !made->whole.axes[a].idle(); ++k)
        sums[a] += made->whole.axes[a].counts[static_cast<std::size_t>(k)];
    if (segment.kind != Kind::pierce) continue;
    if (once < 0) first = sums;
    once = segment.to;
    EXPECT_EQ(sums, first);
  }
  EXPECT_TRUE(broken(spec, *made).empty());
}

TEST_F(Scheduled, EveryFaultIsSeen) {
  const auto spec = program();
  const auto sees = [&](const std::string& name, const ProgramSpec& asked,
                        const ProgramSchedule& s) {
    EXPECT_TRUE(broken(asked, s).contains(name)) << name;
  };
  auto s = *s_;
  s.segments[4].from += 1;
  sees("segments_join", spec, s);
  s = *s_;
  std::ranges::find(s.whole.events, EventKind::torch_on, &motion::Event::what)->period -= 1;
  sees("torch_lit", spec, s);
  s = *s_;
  std::ranges::find(s.whole.events, EventKind::torch_off, &motion::Event::what)->period += 1;
  sees("torch_lit", spec, s);
  s = *s_;  // without the retract and the moves that follow from it
  const auto& rapid = s.segments[3];
  for (auto k = rapid.from; k < rapid.to; ++k)
    s.whole.axes[2].counts[static_cast<std::size_t>(k)] = 0;
  sees("rapid_clearance", spec, s);
  s = *s_;
  s.whole.axes[1].counts[static_cast<std::size_t>(s.segments[3].from + 3)] += 2;
  sees("pierce_place", spec, s);
  sees("I16", spec, s);
  s = *s_;
  s.whole.axes[0].counts[static_cast<std::size_t>(s.segments[5].from + 30)] += 1;
  sees("I2", spec, s);
  auto asked = spec;
  asked.setup.clearance += 0.01;
  sees("rapid_clearance", asked, *s_);
  asked = spec;
  asked.setup.pierce_delay += 0.01;
  sees("pierce_delay", asked, *s_);
  asked = spec;
  asked.setup.pierce_height = 4.01;
  sees("pierce_place", asked, *s_);
  asked = spec;
  asked.machine.axes[2].n_max = s_->whole.axes[2].peak - 1;
  sees("I4", asked, *s_);
  asked = spec;
  asked.machine.axes[2].soft_max = kRadius + 150.0 + 39.0;
  sees("I8", asked, *s_);
}

TEST(ProgramSchedule, IsRefusedByCutAndReason) {
  auto spec = program();
  spec.machine.axes[2].soft_max = 220.0;
  auto made = schedule(spec);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code(), ErrorCode::soft_limit);
  EXPECT_EQ(made.error().issues.front().member, "machine/axes/2/soft_max");
  spec = program();
  spec.cuts[1].path.a.assign(spec.cuts[1].path.phi.size(), 0.1);
  made = schedule(spec);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code(), ErrorCode::unsupported_combination);
  EXPECT_NE(made.error().issues.front().hint.find("cut hole 1"), std::string::npos);
  spec = program();
  spec.max_periods = 5000;
  made = schedule(spec);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code(), ErrorCode::too_many_periods);
  EXPECT_EQ(std::get<double>(made.error().issues.front().limit), 5000.0);
}

// Without leads, from the first point on, and begun at a requested angle.
TEST(ProgramSchedule, ComesStraightOntoTheCut) {
  auto spec = program();
  spec.setup.lead = {};
  for (const bool at : {false, true}) {
    if (at) spec.setup.start = Angle::deg(90.0);
    const auto made = schedule(spec);
    ASSERT_TRUE(made);
    EXPECT_TRUE(broken(spec, *made).empty());
    for (std::size_t i = 2; i < 4; ++i)
      EXPECT_NEAR(made->cuts[i].first().phi, at ? 0.5 * kPi : 0.0, 1e-12);
  }
}

// B to the waste, and a machine that has no height.
TEST(ProgramSchedule, RunsOnOtherMachines) {
  auto spec = program();
  spec.machine.b_positive = motion::BPositive::outer_edge_to_waste;
  const auto other = schedule(spec);
  ASSERT_TRUE(other);
  EXPECT_TRUE(broken(spec, *other).empty());
  for (const auto& entry : motion::catalogue()) {
    if (entry.machine.name != "crawler" && entry.machine.name != "generic") continue;
    spec.machine = entry.machine;
    spec.setup.cut_height = 0.0;
    spec.setup.pierce_height = {};
    const auto made = schedule(spec);
    ASSERT_TRUE(made) << entry.machine.name;
    EXPECT_TRUE(broken(spec, *made).empty()) << entry.machine.name;
    EXPECT_EQ(made->segments.size(), 12u);
  }
}

/// Two strokes, a line along the tube and one round it, before the cuts.
ProgramSpec marked() {
  auto out = program();
  const auto stroke = [](std::string name, double phi, double z, double round, double along) {
    TorchCut mark{.name = std::move(name), .path = on_tube({}), .mark = true};
    mark.path.closed = false;
    for (const double u : {0.0, 0.5, 1.0}) {
      mark.path.phi.push_back(phi + u * round);
      mark.path.z.push_back(z + u * along);
      mark.path.b.push_back(0.0);
    }
    return mark;
  };
  out.cuts.insert(out.cuts.begin(),
                  {stroke("mark of the datum line", 0.0, 60.0, 0.0, 300.0),
                   stroke("mark of partner 7, round", 2.0, 150.0, 10.0 / kRadius, 0.0)});
  out.setup.mark_speed = 60.0;
  return out;
}

// Marks go before the cuts, at cutting height, with the torch dark and at their own speed.
TEST(ProgramSchedule, MarksBeforeItCuts) {
  const auto spec = marked();
  const auto made = schedule(spec);
  ASSERT_TRUE(made) << made.error().issues.front().hint;
  EXPECT_TRUE(broken(spec, *made).empty()) << *broken(spec, *made).begin();
  const auto& w = made->whole;
  for (std::size_t i : {0u, 1u}) {
    const auto &rapid = made->segments[2 * i], &mark = made->segments[2 * i + 1];
    EXPECT_EQ(rapid.kind, Kind::rapid);
    EXPECT_EQ(mark.kind, Kind::mark);
    EXPECT_EQ(mark.cut, i);
    const auto& path = spec.cuts[i].path;
    const double turned = value(spec, w, 0, mark.to) - value(spec, w, 0, mark.from);
    EXPECT_NEAR(turned, (path.phi.back() - path.phi.front()) * kDegPerRad, 1.1e-3);
    EXPECT_NEAR(value(spec, w, 1, mark.from), path.z.front(), 6e-4);
    EXPECT_NEAR(value(spec, w, 1, mark.to), path.z.back(), 6e-4);
    for (const auto period : {mark.from, (mark.from + mark.to) / 2, mark.to})
      EXPECT_NEAR(value(spec, w, 2, period), kRadius + 150.0 + 1.5, 6e-4);
  }
  // 300 mm at 60 mm/s, with the way up to it and down again.
  EXPECT_NEAR(made->time_of(Kind::mark), 300.0 / 60.0 + 10.0 / 60.0, 1.0);
  std::vector<EventKind> told;
  for (const auto& event : w.events)
    if (event.cut == 0) told.push_back(event.what);
  EXPECT_EQ(told, (std::vector{EventKind::rapid_start, EventKind::rapid_end, EventKind::mark_on,
                               EventKind::mark_off}));
  const auto without = schedule(program());
  ASSERT_TRUE(without);
  EXPECT_EQ(made->time_of(Kind::cut), without->time_of(Kind::cut));
  EXPECT_EQ(made->whole.report.length, without->whole.report.length);

  const auto sees = [&](const std::string& name, const ProgramSchedule& s) {
    EXPECT_TRUE(broken(spec, s).contains(name)) << name;
  };
  auto s = *made;
  std::ranges::find(s.whole.events, EventKind::mark_on, &motion::Event::what)->period += 1;
  sees("torch_lit", s);
  s = *made;
  std::ranges::find(s.whole.events, EventKind::mark_off, &motion::Event::what)->period += 1;
  sees("torch_lit", s);
  s = *made;
  std::ranges::find(s.whole.events, EventKind::mark_on, &motion::Event::what)->what =
      EventKind::torch_on;
  sees("torch_lit", s);
  s = *made;
  s.segments[1].kind = Kind::cut;
  sees("segments_join", s);
  s = *made;
  s.whole.axes[1].counts[static_cast<std::size_t>(s.segments[1].from + 200)] += 900;
  sees("I10", s);
}

// One tab leaves one stretch, with a lead and without: it is no closed cut, and its tab is held.
TEST(ProgramSchedule, KeepsASingleTab) {
  for (const bool lead : {true, false}) {
    auto spec = program();
    if (!lead) spec.setup.lead = {};
    spec.setup.tabs = Tabs{.count = 1, .width = 2.0};
    const auto made = schedule(spec);
    ASSERT_TRUE(made);
    std::set<std::string> names;
    for (const auto& check : verify(spec, *made)) {
      EXPECT_TRUE(check.passed()) << check.name;
      names.insert(check.name);
    }
    EXPECT_TRUE(names.contains("tab_width")) << lead;
    const auto last = std::ranges::find_if(
        made->segments, [](const Segment& s) { return s.kind == Kind::cut && s.cut == 3; });
    const auto& way = made->cuts[3].way.points;
    const double way_in = way.points[way.cut_first].phi - way.points.front().phi;
    const double begins = value(spec, made->whole, 0, last->from) * kRadPerDeg + way_in;
    const double ends = value(spec, made->whole, 0, last->to) * kRadPerDeg;
    // Less than a turn by the tab and a kerf, 4 mm of the inner wall; its contour leans a little.
    EXPECT_NEAR(kTwoPi - (ends - begins), 4.0 / (kRadius - kWall), 0.02) << lead;
  }
}

// Each stretch between tabs is a cut with its rapid and pierce; the whole holds all its invariants,
// and a narrower tab is seen.
TEST(ProgramSchedule, CutsFromTabToTab) {
  auto spec = program();
  spec.setup.tabs = Tabs{.count = 3, .width = 2.0, .of = Tabs::Of::all};
  for (const bool lead : {true, false}) {
    if (!lead) spec.setup.lead = {};
    const auto made = schedule(spec);
    ASSERT_TRUE(made) << made.error().issues.front().hint;
    std::set<std::string> names;
    for (const auto& check : verify(spec, *made)) {
      EXPECT_TRUE(check.passed()) << check.name << " " << check.value << " " << check.limit;
      names.insert(check.name);
    }
    EXPECT_TRUE(names.contains("tab_width"));
    EXPECT_EQ(made->cuts.size(), 12u);
    EXPECT_EQ(made->segments.size(), 37u);
    EXPECT_EQ(made->cuts[10].cut.name, "start, 2 of 3");
    auto of_last = spec;
    of_last.setup.tabs->of = Tabs::Of::last;
    const auto last = schedule(of_last);
    ASSERT_TRUE(last);
    EXPECT_EQ(last->cuts.size(), 6u);
    EXPECT_TRUE(broken(of_last, *last).empty());
    // A program with wider tabs is not accepted for narrower requested ones.
    auto wider = of_last;
    wider.setup.tabs->width = 3.0;
    EXPECT_FALSE(broken(wider, *last).empty());
  }
}

// Tabs that end at points of the cut except for rounding: no point occurs twice in a segment.
TEST(ProgramSchedule, BeginsAndEndsStretchesAtPoints) {
  for (const int count : {9, 10}) {
    auto spec = program();
    spec.cuts.resize(2);
    spec.setup.tabs = Tabs{.count = count, .width = 0.5, .of = Tabs::Of::all};
    const auto made = schedule(spec);
    ASSERT_TRUE(made) << made.error().issues.front().hint;
    EXPECT_TRUE(broken(spec, *made).empty());
    for (const auto& cut : made->cuts) {
      const auto& points = cut.way.points.points;
      for (std::size_t i = 1; i < points.size(); ++i)
        EXPECT_GT(std::hypot(kRadius * (points[i].phi - points[i - 1].phi),
                             points[i].z - points[i - 1].z),
                  1e-9)
            << cut.cut.name << " " << i;
    }
  }
}

// Holes in a spiral: the tube turns on by the shorter way to each, eleven times round in all.
TEST(ProgramSchedule, WindsOnRoundAfterRound) {
  auto spec = program();
  spec.cuts.clear();
  for (int i = 0; i < 26; ++i)
    spec.cuts.push_back(
        hole_cut("hole " + std::to_string(i), std::fmod(160.0 * i, 360.0) * kRadPerDeg, 40.0 * i));
  const auto made = schedule(spec);
  ASSERT_TRUE(made) << made.error().issues.front().hint;
  EXPECT_TRUE(broken(spec, *made).empty());
  const auto& whole = made->whole;
  EXPECT_NEAR(value(spec, whole, 0, whole.periods) - whole.axes[0].start, 25 * 160.0, 40.0);
}

}  // namespace
}  // namespace tubecut::torch
