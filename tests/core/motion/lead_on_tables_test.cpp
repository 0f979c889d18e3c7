// Leads of cuts as they leave the service: bevel tables of everyday joints, their torch line cut
// with the default lead. The oracle is brute force in space: a straight axis of a beam against a
// net of points of the finished surface, which knows nothing of how leads are checked.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include "core/bevel/table/table.hpp"
#include "core/motion/path/lead.hpp"
#include "core/motion/path/program.hpp"
#include "tests/core/motion/jobs.hpp"
#include "tests/core/motion/random_jobs.hpp"

namespace tubecut::motion::testing {
namespace {

constexpr double kKerf = 1.5;

struct EverydayCut {
  bevel::TableSpec spec;
  bevel::Table table;

  [[nodiscard]] CutPath contour() const {
    CutPath out;
    out.phi = table.phi;
    out.z = table.torch_inner;
    out.b = table.b;
    out.outer_radius = spec.target.outer_radius;
    out.wall = spec.target.wall;
    out.surface = Surface::inner;
    out.corner.assign(out.phi.size(), false);
    for (const auto* events : {&table.inner_events, &table.outer_events})
      for (const auto& event : *events)
        for (std::size_t i = 0; i < out.phi.size(); ++i)
          if (out.phi[i] == event.phi) out.corner[i] = true;
    return out;
  }
};

std::optional<EverydayCut> everyday(Dice& dice) {
  struct Size {
    double outer, wall;
  };
  static constexpr std::array<Size, 6> kSizes{
      {{33.7, 2.6}, {42.4, 2.6}, {48.3, 3.2}, {60.3, 3.6}, {88.9, 5.0}, {114.3, 6.3}}};
  static constexpr std::array<double, 5> kRatio{1.0, 1.0, 1.27, 1.8, 3.0};
  static constexpr std::array<double, 5> kInclination{30.0, 45.0, 60.0, 75.0, 90.0};
  const Size size = kSizes[static_cast<std::size_t>(dice.below(6))];
  const double partner = 0.5 * size.outer * kRatio[static_cast<std::size_t>(dice.below(5))];
  EverydayCut out;
  out.spec.target = {.outer_radius = 0.5 * size.outer, .wall = size.wall};
  out.spec.partners = {
      joint::TubeCutter{partner, Angle::deg(kInclination[static_cast<std::size_t>(dice.below(5))]),
                        Angle::deg(90.0 * dice.below(4)), 0.0, 0.0}};
  out.spec.sampling.tolerance = joint::Tolerance{};
  out.spec.kerf = kKerf;
  out.spec.smoothing =
      bevel::EnvelopeSmoothing{.limits = {Angle::deg(5).rad(), Angle::deg(1).rad()}};
  out.spec.contact = dice.below(2) == 0 ? bevel::Contact::automatic : bevel::Contact::inner;
  if (dice.below(2) == 0) out.spec.groove = bevel::HalfDihedral{};
  auto made = bevel::table(out.spec);
  if (!made) return std::nullopt;
  out.table = *std::move(made);
  return out;
}

using Point = std::array<double, 3>;

/// The finished surface as a net of points, spaced a tenth of a mm along the cut.
std::vector<Point> net(const EverydayCut& cut) {
  const auto& t = cut.table;
  std::vector<Point> out;
  const double inner = cut.spec.target.inner_radius(), wall = cut.spec.target.wall;
  for (std::size_t i = 0; i < t.phi.size(); ++i) {
    const auto j = (i + 1) % t.phi.size();
    const double to = t.phi[j] + (j == 0 ? kTwoPi : 0.0);
    const double way = std::hypot(cut.spec.target.outer_radius * (to - t.phi[i]),
                                  t.z_outer[j] - t.z_outer[i], t.z_inner[j] - t.z_inner[i]);
    const int parts = 1 + static_cast<int>(way / 0.1);
    for (int k = 0; k < parts; ++k)
      for (int m = 0; m <= 16; ++m) {
        const double u = static_cast<double>(k) / parts, v = m / 16.0;
        const double phi = t.phi[i] + u * (to - t.phi[i]), rho = inner + v * wall;
        const double low = t.z_inner[i] + u * (t.z_inner[j] - t.z_inner[i]);
        const double high = t.z_outer[i] + u * (t.z_outer[j] - t.z_outer[i]);
        out.push_back({rho * std::cos(phi), rho * std::sin(phi), low + v * (high - low)});
      }
  }
  return out;
}

/// Depth that a beam as wide as the kerf on its lead reaches beyond the finished surface, mm; a net
/// of points every 0.1 mm shows it within 0.002.
double deepest(const EverydayCut& cut, const CutPath& contour, const ScheduleSpec& spec,
               LeadBevel bevel) {
  const auto points = net(cut);
  const auto whole = track(contour);
  const CutWithLead cut_with_lead =
      with_lead(*directed(*whole, spec.motion.direction, spec.motion.start), *spec.motion.lead,
                contour.scrap, bevel);
  const double inner = cut.spec.target.inner_radius();
  double out = -1e300;
  for (std::size_t i = 0; i < cut_with_lead.points.size(); ++i) {
    if (i >= cut_with_lead.cut_first && i <= cut_with_lead.cut_last) continue;
    const auto& p = cut_with_lead.points[i];
    const double tilt = -spec.machine.sigma() * std::tan(p.b);
    const Point foot{inner * std::cos(p.phi), inner * std::sin(p.phi), p.z};
    const Point way{std::cos(p.phi), std::sin(p.phi), tilt};
    const double square = 1.0 + tilt * tilt;
    for (const auto& q : points) {
      const Point off{q[0] - foot[0], q[1] - foot[1], q[2] - foot[2]};
      const double along = (off[0] * way[0] + off[1] * way[1] + off[2] * way[2]) / square;
      if (along < -0.5 * inner) continue;  // the far side of the tube
      const double apart = std::sqrt(std::max(
          0.0, off[0] * off[0] + off[1] * off[1] + off[2] * off[2] - along * along * square));
      out = std::max(out, 0.5 * kKerf - apart);
    }
  }
  return out;
}

// Refused only where a beam on the lead enters the finished part, B held or followed, and never
// made where it does.
TEST(LeadsOnTables, ThreeHundredEverydayCutsAreNeverBlockedFalsely) {
  Dice dice(315);
  int cuts = 0, held = 0, followed = 0, refused = 0;
  double deepest_made = -1.0;
  for (int asked = 0; cuts < 300 && asked < 600; ++asked) {
    const auto cut = everyday(dice);
    if (!cut) continue;
    ++cuts;
    ScheduleSpec spec;
    spec.machine = catalogue().front().machine;
    const CutPath contour = cut->contour();
    spec.cut = contour;
    spec.motion.lead = Lead{};
    const auto p = program(spec);
    const double holding = deepest(*cut, contour, spec, LeadBevel::held);
    const double following = deepest(*cut, contour, spec, LeadBevel::followed);
    if (!p) {
      ++refused;
      ASSERT_EQ(p.error().code(), ErrorCode::lead_blocked) << asked;
      EXPECT_GT(std::min(holding, following), 0.018) << asked << " is blocked falsely";
      std::cout << asked << " blocked: held " << holding << ", followed " << following << ", "
                << p.error().issues.front().hint << '\n';
      continue;
    }
    const bool holds = p->x[2][0] == p->x[2][p->cut_first];
    (holds ? held : followed) += 1;
    deepest_made = std::max(deepest_made, holds ? holding : following);
  }
  std::cout << cuts << " cuts: B held " << held << ", followed " << followed << ", refused "
            << refused << "; deepest of those made " << deepest_made << " mm\n";
  EXPECT_EQ(cuts, 300);
  EXPECT_GT(followed, 0);
  EXPECT_LE(deepest_made, 0.02 + 0.05);  // a touch and the tolerance of the rows
  EXPECT_LE(refused, 3);
}

}  // namespace
}  // namespace tubecut::motion::testing
