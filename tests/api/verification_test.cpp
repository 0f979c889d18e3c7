#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <random>

#include "core/bevel/smoothing/smoothed_area.hpp"
#include "core/bevel/table/table.hpp"
#include "core/joint/intersection.hpp"
#include "tests/support/drawing_seed.hpp"

/// Does every check of an answer's own proof hold for good answers, and fail when one number of a
/// good answer is off by ten times that check's limit?
namespace tubecut {
namespace {

using bevel::Contact;
using bevel::Dihedral;
using bevel::RootSurface;

constexpr double kDeg = kRadPerDeg;
constexpr int kNodes = 200;

struct Random {
  std::mt19937_64 engine;
  double between(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(engine);
  }
  int upto(int last) { return std::uniform_int_distribution<int>(0, last)(engine); }
};

/// A chord that every generator meets, up to three braces, sometimes an end plane.
std::vector<joint::Partner> partners(Random& random, double radius) {
  const double chord = radius * random.between(1.25, 2.5);
  std::vector<joint::Partner> out{
      joint::TubeCutter{.radius = chord,
                        .inclination = Angle::deg(random.between(50, 130)),
                        .clocking = Angle::deg(random.between(0, 360)),
                        .offset = random.between(-0.9, 0.9) * (chord - radius)}};
  for (int braces = random.upto(3); braces > 0; --braces)
    out.push_back(joint::TubeCutter{.radius = radius * random.between(0.6, 1.3),
                                    .inclination = Angle::deg(random.between(30, 150)),
                                    .clocking = Angle::deg(random.between(0, 360)),
                                    .offset = radius * random.between(-0.3, 0.3),
                                    .height = radius * random.between(-0.2, 0.5)});
  if (random.upto(3) == 0)
    out.push_back(joint::PlaneCutter{.point = {0, 0, radius * random.between(0.0, 1.5)},
                                     .normal = {random.between(-0.3, 0.3), 0.1, 1.0}});
  return out;
}

joint::Target target(Random& random) {
  const double radius = random.between(10, 150);
  return {.outer_radius = radius, .wall = radius * random.between(0.03, 0.3)};
}

joint::Sampling sampling(int kind) {
  if (kind == 0) return {.uniform_points = 90};
  return {.tolerance = joint::Tolerance{.value = 0.2}};
}

joint::IntersectionSpec cut(Random& random, int kind) {
  joint::IntersectionSpec out{.target = target(random), .sampling = sampling(kind)};
  out.partners = partners(random, out.target.outer_radius);
  return out;
}

struct Way {
  RootSurface root;
  Contact contact;
  Dihedral dihedral;
};
constexpr Way kWays[] = {{RootSurface::inner, Contact::inner, Dihedral::weld_side},
                         {RootSurface::inner, Contact::none, Dihedral::weld_side},
                         {RootSurface::outer, Contact::none, Dihedral::weld_side},
                         {RootSurface::outer, Contact::none, Dihedral::inside},
                         {RootSurface::outer, Contact::none, Dihedral::as_published}};

bevel::TableSpec table_spec(Random& random, const Way& way, int kind) {
  bevel::TableSpec out{.target = target(random),
                       .sampling = sampling(kind),
                       .root_surface = way.root,
                       .dihedral = way.dihedral,
                       .contact = way.contact};
  out.partners = partners(random, out.target.outer_radius);
  const int rule = random.upto(3);
  if (rule == 0) out.groove = bevel::HalfDihedral{};
  if (rule == 1) out.groove = bevel::FixedGroove{Angle::deg(37.5)};
  if (rule == 2) out.groove = bevel::NoGroove{};
  if (rule == 3) out.groove = bevel::SquareCut{};
  out.torch = {.min = Angle::deg(-85), .max = Angle::deg(85)};
  bevel::EnvelopeSmoothing smoothing{.limits = {.slope = 3 * kDeg, .curvature = 0.7 * kDeg}};
  smoothing.along = random.upto(1) == 0 ? bevel::Along::developed : bevel::Along::length;
  out.smoothing = smoothing;
  return out;
}

const Check* find(const std::vector<Check>& checks, const std::string& name) {
  const auto at = std::ranges::find(checks, name, &Check::name);
  return at == checks.end() ? nullptr : &*at;
}

void expect_all_pass(const std::vector<Check>& checks, const std::string& about) {
  EXPECT_FALSE(checks.empty());
  for (const auto& check : checks)
    EXPECT_TRUE(check.passed()) << about << ": " << check.name << " " << check.value << " > "
                                << check.limit;
}

// ---- good answers pass

TEST(Verification, GoodIntersectionsPass) {
  Random random{std::mt19937_64(drawing_seed())};
  int answered = 0;
  for (int i = 0; i < kNodes; ++i) {
    const auto spec = cut(random, i % 2);
    const auto answer = joint::intersect(spec);
    if (!answer) continue;
    ++answered;
    expect_all_pass(joint::verify(spec, *answer), "node " + std::to_string(i));
  }
  EXPECT_EQ(answered, kNodes);
}

TEST(Verification, GoodTablesPass) {
  Random random{std::mt19937_64(drawing_seed())};
  int answered = 0;
  for (int i = 0; i < kNodes; ++i) {
    const auto spec =
        table_spec(random, kWays[static_cast<std::size_t>(i) % std::size(kWays)], i % 2);
    const auto table = bevel::table(spec);
    if (!table) {
      EXPECT_EQ(table.error().code(), ErrorCode::torch_range)
          << i;  // a partner too steep to keep out
      continue;
    }
    ++answered;
    expect_all_pass(bevel::verify(spec, *table), "node " + std::to_string(i));
  }
  EXPECT_GE(answered, kNodes * 9 / 10);
}

// ---- corrupted ones do not

/// The node of Table 1's kind that every corruption starts from: one seed, so that the places below
/// exist.
joint::IntersectionSpec fixed_cut(int kind) {
  joint::IntersectionSpec out{.target = {.outer_radius = 35, .wall = 5},
                              .sampling = sampling(kind)};
  const auto tube = [](double radius, double inclination, double clocking, double offset) {
    return joint::TubeCutter{.radius = radius,
                             .inclination = Angle::deg(inclination),
                             .clocking = Angle::deg(clocking),
                             .offset = offset};
  };
  out.partners = {tube(55, 85, 0, 0), tube(35, 65, 90, 15), tube(35, 35, 245, -5),
                  tube(20, 55, 320, 0)};
  return out;
}

/// Corrupts by ten times the limit and checks that this check fails, and only this one if `alone`.
void expect_seen(const joint::IntersectionSpec& spec, const joint::Intersection& good,
                 const std::string& name,
                 const std::function<void(joint::Intersection&, double)>& corrupt) {
  const double limit = find(joint::verify(spec, good), name)->limit;
  auto bad = good;
  corrupt(bad, 10.0 * limit);
  const auto checks = joint::verify(spec, bad);
  EXPECT_FALSE(find(checks, name)->passed())
      << name << " " << find(checks, name)->value << " limit " << find(checks, name)->limit;
}

class Intersections : public ::testing::TestWithParam<int> {};

TEST_P(Intersections, EveryCheckSeesItsCorruption) {
  const auto spec = fixed_cut(GetParam());
  const auto good = joint::intersect(spec);
  ASSERT_TRUE(good);
  expect_all_pass(joint::verify(spec, *good), "as it is");
  // Away from silhouettes, where a step in z is a step in distance times sin of the angle to the
  // surface.
  expect_seen(spec, *good, "on_cutter", [](auto& bad, double by) { bad.profiles[0].z[7] += by; });
  expect_seen(spec, *good, "labels", [](auto& bad, double by) { bad.profiles[1].z[7] += by; });
  // Height of the junction's two partners differs by as much as phi is off times the difference of
  // their slopes.
  expect_seen(spec, *good, "event_gap", [](auto& bad, double by) {
    for (auto& event : bad.profiles[0].events)
      if (event.kind == joint::EventKind::junction) event.phi += by / bad.profiles[0].radius;
  });
  if (!spec.sampling.tolerance) return;
  // The height at a junction that is a node: the other partner is higher then.
  expect_seen(spec, *good, "none_above", [](auto& bad, double by) {
    auto& p = bad.profiles[0];
    const auto at = std::ranges::find(p.events, joint::EventKind::junction, &joint::Event::kind);
    const auto node = std::ranges::find(p.phi, at->phi) - p.phi.begin();
    p.z.at(static_cast<std::size_t>(node)) -= by;
  });
}

INSTANTIATE_TEST_SUITE_P(Samplings, Intersections, ::testing::Values(0, 1));

TEST(Verification, AHeightThatIsNoNumberIsSeen) {
  const auto spec = fixed_cut(0);
  const auto good = *joint::intersect(spec);
  for (const std::size_t row : {std::size_t{0}, std::size_t{7}, good.profiles[1].z.size() - 1}) {
    auto bad = good;
    bad.profiles[1].z[row] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(find(joint::verify(spec, bad), "on_cutter")->passed()) << row;
  }
}

TEST(Verification, AWrongLabelIsSeen) {
  const auto spec = fixed_cut(0);
  auto bad = *joint::intersect(spec);
  bad.profiles[0].cutter[0] = (bad.profiles[0].cutter[0] + 1) % spec.partners.size();
  EXPECT_FALSE(find(joint::verify(spec, bad), "on_cutter")->passed());
}

struct Table {
  bevel::TableSpec spec;
  bevel::Table good;
};

Table fixed_table(const Way& way, int kind) {
  const auto cut = fixed_cut(kind);
  bevel::TableSpec spec{.target = cut.target,
                        .partners = cut.partners,
                        .sampling = cut.sampling,
                        .root_surface = way.root,
                        .dihedral = way.dihedral,
                        .contact = way.contact};
  spec.groove = bevel::HalfDihedral{};
  spec.smoothing = bevel::EnvelopeSmoothing{.limits = {.slope = 3 * kDeg, .curvature = 0.7 * kDeg}};
  return {spec, *bevel::table(spec)};
}

void expect_seen(const Table& t, const std::string& name,
                 const std::function<void(bevel::Table&, double)>& corrupt) {
  const auto before = bevel::verify(t.spec, t.good);
  const auto* check = find(before, name);
  ASSERT_NE(check, nullptr) << name;
  auto bad = t.good;
  corrupt(bad, 10.0 * check->limit);
  const auto after = bevel::verify(t.spec, bad);
  EXPECT_FALSE(find(after, name)->passed())
      << name << " " << find(after, name)->value << " limit " << find(after, name)->limit;
}

/// The node where `value` is largest.
std::size_t peak(const bevel::Table& t, const std::function<double(std::size_t)>& value) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < t.b.size(); ++i)
    if (value(i) > value(best)) best = i;
  return best;
}

class Tables : public ::testing::TestWithParam<std::tuple<std::size_t, int>> {};

TEST_P(Tables, NanFails) {
  const auto& way = kWays[std::get<0>(GetParam())];
  const auto t = fixed_table(way, std::get<1>(GetParam()));
  const auto passes = [&](std::vector<double> bevel::Table::*column, std::size_t row) {
    auto bad = t.good;
    (bad.*column).at(row) = std::numeric_limits<double>::quiet_NaN();
    return std::ranges::all_of(bevel::verify(t.spec, bad), &Check::passed);
  };
  const auto last = t.good.b.size() - 1;
  for (const std::size_t row : {std::size_t{0}, std::size_t{5}, last}) {
    EXPECT_FALSE(passes(&bevel::Table::b, row)) << "b " << row;
    EXPECT_FALSE(passes(&bevel::Table::dihedral, row)) << "dihedral " << row;
    EXPECT_FALSE(passes(&bevel::Table::z_inner, row)) << "z_inner " << row;
    EXPECT_FALSE(passes(&bevel::Table::z_outer, row)) << "z_outer " << row;
    EXPECT_FALSE(passes(&bevel::Table::phi, row)) << "phi " << row;
    if (way.dihedral == Dihedral::as_published) continue;  // which has no such plane to be held to
    EXPECT_FALSE(passes(&bevel::Table::b_raw, row)) << "b_raw " << row;
    EXPECT_FALSE(passes(&bevel::Table::tau, row)) << "tau " << row;
  }
}

TEST_P(Tables, EveryCheckSeesItsCorruption) {
  const auto& way = kWays[std::get<0>(GetParam())];
  const auto t = fixed_table(way, std::get<1>(GetParam()));
  expect_all_pass(bevel::verify(t.spec, t.good), "as it is");
  const std::size_t some = 5;
  expect_seen(t, "dihedral", [&](auto& bad, double by) { bad.dihedral[some] += by * kDeg; });
  if (way.dihedral != Dihedral::as_published) {
    // Where B is inside the torch's range; the sine of an angle.
    expect_seen(t, "bevel_plane", [&](auto& bad, double by) { bad.b_raw[some] += by; });
  }
  const auto input = [&](std::size_t i) {
    return way.contact == Contact::inner ? std::max(t.good.b_raw[i], t.good.b_required[i])
                                         : t.good.b_raw[i];
  };
  const auto touching = peak(t.good, [&](std::size_t i) { return input(i) - t.good.b[i]; });
  expect_seen(t, "above_required", [&](auto& bad, double by) { bad.b[touching] -= by * kDeg; });
  expect_seen(t, "slope", [&](auto& bad, double by) {
    bad.b[some] += by * kDeg * (bad.developed[some + 1] - bad.developed[some]);
  });
  expect_seen(t, "second_difference", [&](auto& bad, double by) {
    const double h = bad.developed[some + 1] - bad.developed[some];
    const double before = bad.developed[some] - bad.developed[some - 1];
    bad.b[some] += by * kDeg * h * before / 2.0;
  });
  expect_seen(t, "area_excess", [&](auto& bad, double by) {
    const double width = 0.5 * (bad.developed[some + 1] - bad.developed[some - 1]);
    const double area = bevel::smoothed_area(t.spec, t.good)->area;
    bad.b[some] += by * std::max(area, 1e-6 * bad.developed_total) / width;
  });
  expect_seen(t, "area_excess", [](auto& bad, double) { bad.multipliers = {}; });
  expect_seen(t, "torch_range",
              [&](auto& bad, double by) { bad.b[some] = t.spec.torch.max.rad() + by * kDeg; });
  if (way.contact == Contact::inner) {
    expect_seen(t, "penetration", [&](auto& bad, double by) { bad.z_inner[some] -= by; });
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, Tables,
                         ::testing::Combine(::testing::Values(0u, 1u, 2u, 3u, 4u),
                                            ::testing::Values(0, 1)));

}  // namespace
}  // namespace tubecut
