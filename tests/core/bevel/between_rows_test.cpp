#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
#include <string>
#include <string_view>

#include "core/bevel/table/table.hpp"
#include "core/joint/placement.hpp"
#include "tests/support/cut_oracle.hpp"
#include "tests/support/random_cut.hpp"

// Between two rows a machine goes on straight: how deep does that wall enter a partner? The oracle
// knows only the partners' own solids and the rows of the answer.

namespace tubecut::bevel {
namespace {

/// A wall of four rows, flat at z = 0 but for one row's two edges.
oracle::Wall flat(double inner_z, double outer_z) {
  const std::vector<double> phi{0.0, 0.5 * kPi, kPi, 1.5 * kPi};
  return {.edges = {{20.0, phi, {0, 0, 0, inner_z}}, {25.0, phi, {0, 0, 0, outer_z}}},
          .turn = kTwoPi};
}

TEST(CutOracle, FindsTheDeepestPlaceOfAWallInAPlane) {
  const std::vector<oracle::Solid> plane{oracle::solid_of(joint::PlaneCutter{})};
  for (const double depth : {0.003, 0.7}) {
    const auto found = oracle::deepest(flat(-0.5 * depth, -depth), plane);
    EXPECT_NEAR(found.depth, depth, 1e-9);
    EXPECT_NEAR(found.radius, 25.0, 1e-6);
    EXPECT_NEAR(found.phi, 1.5 * kPi, 1e-6);
  }
  EXPECT_NEAR(oracle::deepest(flat(0.1, 0.2), plane).depth, 0.0, 1e-9);
}

// The ruled wall sags off a thin tube across the target by the axis distance: half way between the
// rows 0 and 90 deg both edges are at 45 deg.
TEST(CutOracle, FindsErrorsBetweenRows) {
  const double r = 1.0;
  const joint::AxisTube tube{.radius = r,
                             .axis = {.point = {0, 0, 0}, .direction = {1.0, 1.0, 0.0}}};
  const std::vector<oracle::Solid> solids{oracle::solid_of(tube)};
  const auto wall = flat(-3.0, -3.0);
  EXPECT_NEAR(oracle::deepest(wall, solids).depth, r, 1e-6);
  EXPECT_LT(oracle::deepest(wall, solids, {.rows_only = true}).depth, -10.0);
  // Grown by coating and gap it is nearer by as much.
  EXPECT_NEAR(oracle::solid_of(tube, 0.25)({9.0, 0.0, 0.0}), solids[0]({9.0, 0.0, 0.0}) - 0.25,
              1e-12);
}

// One tube by its four numbers and by its axis.
TEST(CutOracle, PlacesTubesByTheFrame) {
  oracle::Random random{std::mt19937_64(20261122)};
  for (int n = 0; n < 50; ++n) {
    const joint::TubeCutter tube{.radius = random.any(5, 50),
                                 .inclination = Angle::deg(random.any(10, 170)),
                                 .clocking = Angle::deg(random.any(0, 360)),
                                 .offset = random.any(-20, 20),
                                 .height = random.any(-20, 20)};
    const auto a = oracle::solid_of(tube);
    const auto b = oracle::solid_of(joint::AxisTube{tube.radius, joint::axis_of(tube)});
    const oracle::Point p{random.any(-50, 50), random.any(-50, 50), random.any(-50, 50)};
    EXPECT_NEAR(a(p), b(p), 1e-9);
  }
}

int count_of(const char* name, int otherwise) {
  const char* asked = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
  return asked != nullptr ? std::atoi(asked) : otherwise;
}

joint::TubeCutter tube(double diameter, double inclination, double clocking, double offset = 0.0) {
  return {.radius = 0.5 * diameter,
          .inclination = Angle::deg(inclination),
          .clocking = Angle::deg(clocking),
          .offset = offset};
}

TableSpec table_1() {
  TableSpec spec{.target = {.outer_radius = 35, .wall = 5},
                 .partners = {tube(110, 85, 0), tube(70, 65, 90, 15), tube(70, 35, 245, -5),
                              tube(40, 55, 320)}};
  spec.groove = HalfDihedral{};
  spec.smoothing = NoSmoothing{};
  spec.sampling.tolerance = joint::Tolerance{};
  return spec;
}

oracle::Found found_in(const TableSpec& spec, const Table& made) {
  return oracle::deepest(oracle::finished(spec, made), oracle::solids_of(spec));
}

bool passes(const std::vector<Check>& checks, std::string_view name = {}) {
  return std::ranges::all_of(checks, [&](const Check& check) {
    return (!name.empty() && check.name != name) || check.passed();
  });
}

const Warning* entering(const Table& made) {
  const auto at = std::ranges::find(made.warnings, WarningCode::enters_partner, &Warning::code);
  return at == made.warnings.end() ? nullptr : &*at;
}

/// The row after the deepest place's lowered by twice the tolerance, at every edge.
Table lowered(const TableSpec& spec, Table t, std::size_t gap) {
  const auto next = (gap + 1) % t.phi.size();
  for (auto* z : {&t.z_inner, &t.z_face, &t.z_outer})
    if (!z->empty()) (*z)[next] -= 2.0 * spec.sampling.tolerance->value;
  return t;
}

// The full count: TUBECUT_TABLES=2000.
TEST(BetweenRows, NoRandomTableEntersByMoreThanItsTolerance) {
  constexpr std::uint64_t kSeed = 20261122;
  const int tables = count_of("TUBECUT_TABLES", 60);
  std::cout << "seed " << kSeed << '\n';
  oracle::Random random{std::mt19937_64(kSeed)};
  std::map<std::string_view, int> refused;
  int answered = 0, promised = 0, lands = 0;
  double worst_share = 0.0, worst_stated = 0.0;
  for (int n = 0; n < tables; ++n) {
    const auto spec = oracle::random_cut(random);
    const auto made = table(spec);
    if (!made) {
      ++refused[info(made.error().code()).code];
      continue;
    }
    ++answered;
    const auto found = found_in(spec, *made);
    const double off = std::abs(std::max(0.0, found.depth) - made->penetration.depth);
    worst_stated = std::max(worst_stated, off);
    EXPECT_LE(off, 1e-3) << n << " stated " << made->penetration.depth << " found " << found.depth;
    for (const auto& check : verify(spec, *made))
      EXPECT_TRUE(check.passed()) << n << ' ' << check.name << ' ' << check.value;
    if (!promises_no_penetration(spec)) {
      EXPECT_EQ(entering(*made) != nullptr, made->penetration.depth > penetration_limit(spec)) << n;
      continue;
    }
    ++promised;
    lands += spec.root_face > 0.0 ? 1 : 0;
    const double share = found.depth / spec.sampling.tolerance->value;
    worst_share = std::max(worst_share, share);
    EXPECT_LE(share, 1.0) << n << " phi " << found.phi * kDegPerRad << " radius " << found.radius;
    EXPECT_EQ(entering(*made), nullptr) << n;
    EXPECT_FALSE(passes(verify(spec, lowered(spec, *made, found.gap)))) << n;
  }
  std::cout << answered << " answered, " << promised << " promise none, " << lands
            << " of them with a root face; deepest " << worst_share
            << " of the tolerance, stated within " << worst_stated << " mm\n";
  for (const auto& [code, count] : refused) std::cout << code << ' ' << count << '\n';
  EXPECT_GE(answered, tables * 4 / 5);
  EXPECT_GE(promised, tables / 2);
  EXPECT_GE(lands, tables / 10);
}

// The land's edge met a partner between the last row and the first, 0.17 mm deep.
TEST(BetweenRows, ALandIsHeldAcrossTheSeamToo) {
  TableSpec spec{.target = {.outer_radius = 57.15, .wall = 16},
                 .partners = {tube(182.88, 45, 0), tube(148.59, 60, 90)}};
  spec.sampling.tolerance = joint::Tolerance{};
  spec.groove = NoGroove{};
  spec.smoothing = NoSmoothing{};
  for (const double face : {0.0, 1.0, 3.0, 6.0}) {
    spec.root_face = face;
    const auto made = table(spec);
    ASSERT_TRUE(made);
    const auto found = found_in(spec, *made);
    EXPECT_LE(found.depth, 0.05) << face << " phi " << found.phi * kDegPerRad;
    EXPECT_NEAR(made->penetration.depth, found.depth, 1e-3);
    EXPECT_TRUE(passes(verify(spec, *made)));
  }
}

// A dent between two unchanged rows: only a check between rows can see it.
TEST(BetweenRows, AnOmittedRowIsDetected) {
  auto spec = table_1();
  auto made = table(spec);
  ASSERT_TRUE(made);
  EXPECT_TRUE(passes(verify(spec, *made)));
  int seen = 0;
  for (std::size_t i = 0; i < made->phi.size(); ++i) {
    auto bad = *made;
    for (auto* column :
         {&bad.phi, &bad.developed, &bad.length, &bad.z_inner, &bad.z_outer, &bad.dihedral,
          &bad.groove, &bad.tau, &bad.gamma, &bad.flush, &bad.b_raw, &bad.b_required, &bad.b,
          &bad.gap, &bad.beam, &bad.torch_inner, &bad.torch_outer})
      column->erase(column->begin() + static_cast<std::ptrdiff_t>(i));
    bad.cutter.erase(bad.cutter.begin() + static_cast<std::ptrdiff_t>(i));
    const double depth = found_in(spec, bad).depth;
    const auto checks = verify(spec, bad);
    EXPECT_TRUE(passes(checks, "penetration")) << i;  // of the rows, which are all unchanged
    if (depth < 1.2 * 0.05) continue;
    ++seen;
    EXPECT_FALSE(passes(checks, "penetration_stated")) << i << ' ' << depth;
  }
  EXPECT_GE(seen, 10);
}

// ---- without a guarantee, the deviation is measured and reported

TEST(BetweenRows, ContactNoneReportsPositionAndDepth) {
  struct Case {
    RootSurface root;
    Dihedral dihedral;
    double least;  // mm, seen on it
  };
  for (const auto& [root, dihedral, least] : {Case{RootSurface::outer, Dihedral::weld_side, 5.0},
                                              Case{RootSurface::outer, Dihedral::as_published, 0.5},
                                              Case{RootSurface::inner, Dihedral::weld_side, 0.1}}) {
    auto spec = table_1();
    spec.root_surface = root;
    spec.dihedral = dihedral;
    spec.contact = Contact::none;
    if (dihedral == Dihedral::as_published) spec.groove = NoGroove{};
    if (root == RootSurface::inner) spec.sampling = {.uniform_points = 360};
    const auto made = table(spec);
    ASSERT_TRUE(made);
    const auto found = found_in(spec, *made);
    std::cout << "contact none enters by " << found.depth << " mm\n";
    EXPECT_GT(found.depth, least);
    const auto& p = made->penetration;
    EXPECT_NEAR(p.depth, found.depth, 1e-3);
    EXPECT_EQ(p.solid, found.solid);
    const auto at = oracle::solids_of(spec)[p.solid](
        {p.radius * std::cos(p.phi), p.radius * std::sin(p.phi), p.z});
    EXPECT_NEAR(-at, p.depth, 1e-6);
    const auto* warning = entering(*made);
    ASSERT_NE(warning, nullptr);
    EXPECT_EQ(info(warning->code).severity, Severity::cut);
    EXPECT_EQ(warning->member, "cutters/" + std::to_string(p.solid));
    EXPECT_NE(warning->detail.find(brief(p.depth)), std::string::npos) << warning->detail;
    EXPECT_TRUE(passes(verify(spec, *made)));
  }
}

TEST(BetweenRows, ABareGridReportsTheErrorBetweenItsPoints) {
  auto spec = table_1();
  for (const std::size_t points : {24U, 36U, 90U, 1440U}) {
    spec.sampling = {.uniform_points = points};
    const auto made = table(spec);
    ASSERT_TRUE(made);
    const double depth = found_in(spec, *made).depth;
    std::cout << points << " points enter by " << depth << " mm\n";
    EXPECT_NEAR(made->penetration.depth, std::max(0.0, depth), 1e-3);
    EXPECT_EQ(entering(*made) != nullptr, made->penetration.depth > 0.05) << points;
    if (points <= 36U) {
      EXPECT_GT(depth, 0.05);
    }
    if (points >= 90U) {
      EXPECT_LT(depth, 0.05);
    }
  }
}

}  // namespace
}  // namespace tubecut::bevel
