// Leads and pierces stay out of the finished part. The point-in-solid test here uses only the
// solid: the end is a function z(phi) with a bevel b(phi), the hole a closed curve, both in closed
// form.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "core/motion/path/program.hpp"
#include "core/motion/replay/replay.hpp"
#include "tests/core/motion/jobs.hpp"
#include "tests/core/motion/random_jobs.hpp"

namespace tubecut::motion::testing {
namespace {

constexpr double kHalfKerf =
    0.15;  // mm between the torch line and the finished edge: a fine plasma's

/// A tube with a bevelled end or a hole, b > 0 where the outer edge lies further into the part
/// (+z).
struct Solid {
  double outer = 50.0, wall = 5.0;
  bool hole = false;
  double amplitude = 10.0, order = 2.0, clocking = 0.0;  // of the end
  double bevel = 0.3, bevel_wave = 0.2;
  double size = 15.0, stretch = 0.2;  // of the hole

  [[nodiscard]] double end_z(double phi) const {
    return amplitude * std::cos(order * (phi - clocking));
  }
  [[nodiscard]] double end_b(double phi) const { return bevel + bevel_wave * std::cos(phi); }
  /// The hole's curve on the outer surface: (s, z) and its bevel.
  [[nodiscard]] std::pair<double, double> rim(double theta) const {
    const double r = size * (1.0 + stretch * std::cos(2.0 * theta));
    return {r * std::cos(theta), r * std::sin(theta)};
  }
  [[nodiscard]] double rim_b(double theta) const { return bevel_wave * std::sin(theta); }

  /// Is material left at (phi, rho, z)? Deeper than half a kerf behind the torch line.
  [[nodiscard]] bool inside(double phi, double rho, double z) const {
    return hole ? !in_hole(phi, rho, z) : behind_end(phi, rho, z);
  }

 private:
  [[nodiscard]] bool behind_end(double phi, double rho, double z) const {
    const double slope = amplitude * order * std::sin(order * (phi - clocking)) / rho;
    const double edge = end_z(phi) + (rho - outer) * std::tan(end_b(phi));
    return z > edge + kHalfKerf * std::sqrt(1.0 + slope * slope);
  }
  [[nodiscard]] bool in_hole(double phi, double rho, double z) const {
    double turned = 0.0, nearest = 1e300;
    std::complex<double> before;
    for (int i = 0; i <= 720; ++i) {
      const double theta = kTwoPi * i / 720;
      const auto [s, rim_z] = rim(theta);
      const double shifted = rim_z + (rho - outer) * std::tan(rim_b(theta));
      const std::complex<double> to(rho * s / outer - rho * phi, shifted - z);
      nearest = std::min(nearest, std::abs(to));
      if (i > 0) turned += std::arg(to / before);
      before = to;
    }
    return std::abs(turned) > kPi || nearest < kHalfKerf;
  }
};

CutPath contour_of(const Solid& solid, double sigma) {
  CutPath c;
  c.outer_radius = solid.outer;
  c.wall = solid.wall;
  c.scrap = solid.hole ? Scrap::inside : Scrap::minus_z;
  const int n = 360;
  for (int i = 0; i <= n; ++i) {
    const double w = kTwoPi * (i % n) / n;
    if (solid.hole) {
      const auto [s, z] = solid.rim(w);
      c.phi.push_back(s / solid.outer);
      c.z.push_back(z);
      c.b.push_back(-sigma * solid.rim_b(w));
    } else {
      c.phi.push_back(i == n ? kTwoPi : w);
      c.z.push_back(solid.end_z(w));
      c.b.push_back(-sigma * solid.end_b(w));
    }
  }
  return c;
}

Solid random_solid(Dice& dice) {
  Solid s;
  s.outer = dice.uniform(25.0, 150.0);
  s.wall = dice.uniform(2.0, 12.0);
  s.hole = dice.below(2) == 0;
  s.amplitude = dice.uniform(0.0, 0.5) * s.outer;
  s.order = 1.0 + dice.below(2);
  s.clocking = dice.uniform(0.0, kTwoPi);
  s.bevel = dice.uniform(-0.6, 0.6);
  s.bevel_wave = dice.uniform(0.0, 0.3);
  s.size = std::min(dice.uniform(12.0, 40.0), 0.6 * s.outer);
  s.stretch = dice.uniform(-0.2, 0.2);
  return s;
}

ScheduleSpec led_job(const Solid& solid, Dice& dice) {
  ScheduleSpec spec;
  spec.machine = source_machine();
  if (dice.below(2) == 0) spec.machine.b_positive = BPositive::outer_edge_into_part;
  for (Axis& axis : spec.machine.axes) {
    axis.soft_min.reset();
    axis.soft_max.reset();
  }
  spec.cut = contour_of(solid, spec.machine.sigma());
  Lead lead;
  lead.radius = dice.uniform(2.0, 6.0);
  lead.sweep = Angle::deg(dice.uniform(30.0, 90.0));
  if (dice.below(2) == 0) lead.pierce_b = Angle::deg(dice.uniform(0.0, 30.0));
  lead.fan = dice.uniform(2.0, 10.0);
  spec.motion.lead = lead;
  spec.motion.direction = dice.below(2) == 0 ? Direction::ccw : Direction::cw;
  if (dice.below(3) == 0) spec.motion.start.at = Start::At::automatic;
  return spec;
}

/// Beam at a point of the surface against the solid, on both walls and between.
bool cuts_into(const Solid& solid, const ScheduleSpec& spec, double phi, double z, double b) {
  const double tilt = -spec.machine.sigma() * std::tan(b);  // dz per mm of radius
  for (const double share : {0.0, 0.5, 1.0}) {
    const double rho = solid.outer - share * solid.wall;
    if (solid.inside(phi, rho, z + tilt * (rho - solid.outer))) return true;
  }
  return false;
}

int lead_points_inside(const Solid& solid, const ScheduleSpec& spec, const Program& p) {
  int inside = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (i >= p.cut_first && i <= p.cut_last) continue;
    inside += cuts_into(solid, spec, p.x[0][i], p.x[1][i], p.x[2][i]) ? 1 : 0;
  }
  return inside;
}

/// Way from the pierce to the first point with the cut's own B, or to the cut: mm.
double fan_length(const Program& p) {
  double way = 0.0;
  for (std::size_t i = 0; i < p.cut_first && p.x[2][i] != p.x[2][p.cut_first]; ++i) {
    const double radius = p.coordinates[0].weight;
    way += std::hypot(radius * (p.x[0][i + 1] - p.x[0][i]), p.x[1][i + 1] - p.x[1][i]);
  }
  return p.x[2][0] == p.x[2][p.cut_first] ? 1e300 : way;
}

TEST(Leads, StayOutOfFiveHundredRandomParts) {
  Dice dice(500);
  int made = 0, blocked = 0;
  for (int i = 0; i < 500; ++i) {
    const Solid solid = random_solid(dice);
    const ScheduleSpec spec = led_job(solid, dice);
    const auto p = program(spec);
    if (!p) {
      ASSERT_EQ(p.error().code(), ErrorCode::lead_blocked) << i;
      ++blocked;
      continue;
    }
    ++made;
    EXPECT_EQ(lead_points_inside(solid, spec, *p), 0) << i << (solid.hole ? " hole" : " end");
    if (const auto& most = spec.motion.lead->pierce_b) {
      EXPECT_LE(std::abs(p->x[2][0]), most->rad() + 1e-12) << i;
    }
    if (spec.motion.lead->pierce_b) {
      EXPECT_GE(fan_length(*p), 0.999 * spec.motion.lead->fan) << i;  // chords of a 3 deg arc
    }
  }
  EXPECT_GE(made, 350) << blocked << " blocked";
  RecordProperty("made", made);
  RecordProperty("blocked", blocked);
}

/// The same leads on the wrong side are found by the same test.
TEST(Leads, OnTheWrongSideAreSeen) {
  Dice dice(501);
  int seen = 0, made = 0;
  for (int i = 0; i < 50; ++i) {
    Solid solid = random_solid(dice);
    solid.hole = false;
    ScheduleSpec spec = led_job(solid, dice);
    std::get<CutPath>(spec.cut).scrap = Scrap::plus_z;
    const auto p = program(spec);
    if (!p) continue;
    ++made;
    seen += lead_points_inside(solid, spec, *p) > 0 ? 1 : 0;
  }
  EXPECT_GT(made, 30);
  EXPECT_EQ(seen, made);
}

/// As cut: smoothed, timed and counted.
TEST(Leads, StayOutAsReplayed) {
  Dice dice(502);
  int made = 0;
  for (int i = 0; i < 12; ++i) {
    const Solid solid = random_solid(dice);
    const ScheduleSpec spec = led_job(solid, dice);
    const auto s = schedule(spec);
    if (!s) continue;
    ++made;
    for (const Check& check : verify(spec, *s)) {
      EXPECT_TRUE(check.passed()) << i << " " << check.name << " " << check.value << " > "
                                  << check.limit;
    }
    ReplaySpec sent{spec, s->period, {}, {}};
    for (const AxisPulses& axis : s->axes) {
      sent.counts.emplace_back(axis.counts.begin(), axis.counts.end());
      sent.start.push_back(axis.start);
    }
    const auto path = replay(sent);
    ASSERT_TRUE(path);
    const auto cut_start = static_cast<std::size_t>(s->events[2].period);
    const auto cut_end = static_cast<std::size_t>(s->events[3].period);
    EXPECT_LT(0U, cut_start);
    EXPECT_LT(cut_start, cut_end);
    int inside = 0;
    for (std::size_t k = 0; k < path->phi.size(); ++k) {
      if (k >= cut_start && k <= cut_end) continue;
      inside += cuts_into(solid, spec, path->phi[k], path->z[k], path->b[k]) ? 1 : 0;
    }
    EXPECT_EQ(inside, 0) << i;
    if (const auto& most = spec.motion.lead->pierce_b) {
      EXPECT_LE(std::abs(path->b.front()), most->rad() + 1e-9);
    }
  }
  EXPECT_GE(made, 8);
}

/// The arcs leave along the cut: no turn at the joins.
TEST(Leads, AreTangent) {
  Dice dice(503);
  Solid solid;
  for (const bool hole : {false, true}) {
    solid.hole = hole;
    ScheduleSpec spec = led_job(solid, dice);
    const auto p = program(spec);
    ASSERT_TRUE(p);
    for (const std::size_t join : {p->cut_first, p->cut_last}) {
      const auto step = [&](std::size_t a, std::size_t b) {
        return std::complex<double>(50.0 * (p->x[0][b] - p->x[0][a]), p->x[1][b] - p->x[1][a]);
      };
      EXPECT_LT(std::abs(std::arg(step(join, join + 1) / step(join - 1, join))), 4 * kRadPerDeg);
    }
  }
}

TEST(Leads, OvercutContinuesTheCut) {
  ScheduleSpec spec = table1(20);
  spec.motion.lead = Lead{};
  spec.motion.lead->overcut = 7.0;
  const auto p = program(spec);
  ASSERT_TRUE(p);
  double again = 0.0;
  for (std::size_t i = p->cut_first; i < p->cut_last; ++i) {
    const double s = 35.0 * (p->x[0][i + 1] - p->x[0][i]), z = p->x[1][i + 1] - p->x[1][i];
    again += std::hypot(s, z);
  }
  EXPECT_NEAR(again, 290.28 + 7.0, 0.05);
  const Schedule s = planned(spec);
  EXPECT_EQ(s.events.size(), 5U);
  for (const Check& check : verify(spec, s)) EXPECT_TRUE(check.passed()) << check.name;
}

/// A window of 12 mm by 12, with this spacing of points along the tube, begun in the middle of a
/// side.
CutPath window(double step) {
  CutPath out{.outer_radius = 30.15, .wall = 4.0, .scrap = Scrap::inside};
  const double wide = 12.0 / out.outer_radius;
  const int n = static_cast<int>(12.0 / step);
  const auto add = [&](double phi, double z) {
    out.phi.push_back(phi);
    out.z.push_back(z);
    out.b.push_back(0.0);
  };
  for (int i = n / 2; i < n; ++i) add(0.0, 100.0 + i * step);
  for (int i = 0; i < 20; ++i) add(wide * i / 20, 100.0 + n * step);
  for (int i = 0; i < n; ++i) add(wide, 100.0 + n * step - i * step);
  for (int i = 0; i < 20; ++i) add(wide - wide * i / 20, 100.0);
  for (int i = 0; i <= n / 2; ++i) add(0.0, 100.0 + i * step);
  return out;
}

// Except for rounding: a point next to the last would be that point again, and the path would have
// no direction there.
TEST(Leads, OvercutThatEndsAtAPointRepeatsNoPoint) {
  for (const double step : {0.1, 0.3, 0.7})
    for (int k = 1; k <= 12; ++k) {
      ScheduleSpec spec;
      spec.machine = source_machine();
      spec.cut = window(step);
      spec.motion.speed = kFeed;
      spec.motion.lead = Lead{.radius = 2.0, .overcut = k * step};
      const auto p = program(spec);
      if (!p) {  // round the corner a lead runs into the part
        EXPECT_EQ(p.error().code(), ErrorCode::lead_blocked);
        EXPECT_GT(k * step, 3.0);
        continue;
      }
      for (std::size_t i = 1; i < p->size(); ++i)
        EXPECT_GT(std::hypot(30.15 * (p->x[0][i] - p->x[0][i - 1]), p->x[1][i] - p->x[1][i - 1]),
                  1e-9)
            << step << " " << k << " " << i;
      const auto s = schedule(spec);
      ASSERT_TRUE(s);
      for (const auto& check : verify(spec, *s)) EXPECT_TRUE(check.passed()) << check.name;
    }
}

TEST(Leads, ThatDoNotFitAreRefused) {
  Solid solid;
  solid.hole = true;
  solid.size = 4.0;
  Dice dice(504);
  ScheduleSpec spec = led_job(solid, dice);
  spec.motion.lead->radius = 8.0;
  const auto p = program(spec);
  ASSERT_FALSE(p);
  EXPECT_EQ(p.error().code(), ErrorCode::lead_blocked);
}

/// A tube coped by a round tube through its axis: where the cutter's far side meets the generator.
struct Cope {
  double outer = 24.15, partner = 24.15, inclination = kPi / 4, clocking = 0.0;

  [[nodiscard]] double z(double phi) const {
    const double across = outer * std::sin(phi - clocking);
    const double along = outer * std::cos(phi - clocking);
    const double chord = std::sqrt(std::max(0.0, partner * partner - across * across));
    return (along * std::cos(inclination) + chord) / std::sin(inclination);
  }
};

Cope everyday(Dice& dice) {
  static constexpr std::array<double, 6> kOuter{33.7, 42.4, 48.3, 60.3, 88.9, 114.3};
  static constexpr std::array<double, 5> kRatio{1.0, 1.0, 1.27, 1.8, 3.0};
  static constexpr std::array<double, 5> kInclination{30.0, 45.0, 60.0, 75.0, 90.0};
  Cope c;
  c.outer = 0.5 * kOuter[static_cast<std::size_t>(dice.below(6))];
  c.partner = c.outer * kRatio[static_cast<std::size_t>(dice.below(5))];
  c.inclination = kInclination[static_cast<std::size_t>(dice.below(5))] * kRadPerDeg;
  c.clocking = 90.0 * dice.below(4) * kRadPerDeg;
  return c;
}

/// Points whose chords deviate from the cope by `tolerance`, with at most 5 deg between them.
CutPath sampled_cope(const Cope& cope, double tolerance) {
  CutPath c;
  c.outer_radius = cope.outer;
  c.wall = 0.07 * cope.outer;
  const auto sag = [&](double from, double to) {
    double most = 0.0;
    for (const double share : {0.25, 0.5, 0.75}) {
      const double chord = (1.0 - share) * cope.z(from) + share * cope.z(to);
      most = std::max(most, std::abs(chord - cope.z(from + share * (to - from))));
    }
    return most;
  };
  for (double phi = 0.0; phi < kTwoPi - 1e-9;) {
    c.phi.push_back(phi);
    double step = 5.0 * kRadPerDeg;
    const double corner = 0.5 * kPi * (std::floor(phi / (0.5 * kPi) + 1e-9) + 1.0);
    while (sag(phi, std::min(phi + step, corner)) > tolerance) step *= 0.9;
    phi = std::min(phi + step, corner);
  }
  c.phi.push_back(kTwoPi);
  for (const double phi : c.phi) c.z.push_back(phi == kTwoPi ? cope.z(0.0) : cope.z(phi));
  c.b.assign(c.phi.size(), 0.0);
  return c;
}

/// How deep the lead of a job reaches into the cope's own surface on the outside, mm: along the
/// nearest of many places of it.
double deepest_in(const Cope& cope, const ScheduleSpec& spec) {
  const auto& contour = std::get<CutPath>(spec.cut);
  const auto whole = track(contour);
  const CutWithLead cut = with_lead(*directed(*whole, spec.motion.direction, spec.motion.start),
                                    *spec.motion.lead, contour.scrap);
  double deepest = 0.0;
  for (std::size_t i = 0; i < cut.points.size(); ++i) {
    if (i >= cut.cut_first && i <= cut.cut_last) continue;
    const CutPoint& p = cut.points[i];
    if (p.z <= cope.z(p.phi)) continue;
    double nearest = 1e300;
    for (int k = -2000; k <= 2000; ++k) {
      const double phi = p.phi + 1e-4 * k;
      nearest = std::min(nearest, std::hypot(cope.outer * (phi - p.phi), cope.z(phi) - p.z));
    }
    deepest = std::max(deepest, nearest);
  }
  return deepest;
}

/// Leads on copes sampled within a tolerance, default ones and long ones: refused only where they
/// enter the true surface by more than the tolerance can explain, and wherever they do.
TEST(Leads, OfThreeHundredEverydayCutsAreNotBlockedFalsely) {
  static constexpr std::array<double, 3> kTolerance{0.01, 0.02, 0.05};
  Dice dice(300);
  int made = 0, refused = 0;
  for (int i = 0; i < 300; ++i) {
    const Cope cope = everyday(dice);
    const double tolerance = kTolerance[static_cast<std::size_t>(dice.below(3))];
    ScheduleSpec spec;
    spec.machine = source_machine();
    spec.cut = sampled_cope(cope, tolerance);
    for (const double radius : {5.0, 25.0}) {
      spec.motion.lead = Lead{.radius = radius};
      const auto p = program(spec);
      const double depth = deepest_in(cope, spec);
      if (!p) {
        ASSERT_EQ(p.error().code(), ErrorCode::lead_blocked) << i;
        EXPECT_GT(depth, 0.02) << i << " radius " << radius << " is blocked falsely";
      }
      if (depth > 0.02 + 2.0 * tolerance) {
        EXPECT_FALSE(p) << i << " radius " << radius << " enters by " << depth;
      }
      made += p && radius == 5.0 ? 1 : 0;
      refused += p ? 0 : 1;
    }
  }
  RecordProperty("made", made);
  RecordProperty("refused", refused);
  EXPECT_GT(made, 280);
  EXPECT_GT(refused, 20);
}

}  // namespace
}  // namespace tubecut::motion::testing
