#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <random>
#include <set>

#include "core/bevel/table/required.hpp"
#include "core/bevel/table/table.hpp"
#include "tests/core/joint/degenerate_cases.hpp"
#include "tests/core/joint/published.hpp"
#include "tests/core/joint/random_nodes.hpp"
#include "tests/support/drawings.hpp"

namespace tubecut::bevel {
namespace {

using joint::kGolden;
using joint::Partner;
using testing::numbers;

std::vector<Partner> partners(const std::vector<joint::Cutter>& cutters) {
  std::vector<Partner> out;
  for (const auto& cutter : cutters)
    std::visit([&](const auto& c) { out.emplace_back(c); }, cutter);
  return out;
}

TableSpec table_1(Contact contact) {
  TableSpec spec{.target = {.outer_radius = 35, .wall = 5}, .partners = partners(joint::table1())};
  spec.sampling.uniform_points = 360;
  spec.contact = contact;
  spec.groove = HalfDihedral{};
  spec.smoothing = NoSmoothing{};
  return spec;
}

double largest(const std::vector<double>& v) { return *std::ranges::max_element(v); }

bool warned(const Table& table, WarningCode code) {
  return std::ranges::any_of(table.warnings, [&](const Warning& w) { return w.code == code; });
}

void expect_proved(const TableSpec& spec, const Table& table) {
  for (const auto& check : verify(spec, table))
    EXPECT_TRUE(check.passed()) << check.name << " " << check.value << " > " << check.limit;
}

TEST(Contact, SquareCutOfTable1IsTheGolden) {
  const auto golden = testing::golden(kGolden);
  const std::string block = "seed000_table1_wall/";
  auto spec = table_1(Contact::automatic);
  spec.groove = SquareCut{};
  const auto got = table(spec);
  ASSERT_TRUE(got);
  expect_proved(spec, *got);
  const auto z = numbers(golden, block + "square_cut_auto_z");
  const auto share = numbers(golden, block + "square_cut_contact_fraction");
  const auto contour = joint::trace(joint::table1(), 30);
  ASSERT_TRUE(contour);
  int inner = 0, outer = 0;
  for (std::size_t i = 0; i < 360; ++i) {
    EXPECT_EQ(got->b[i], 0.0);
    EXPECT_NEAR(got->z_inner[i], z[i], 1e-10) << i;
    EXPECT_EQ(got->z_outer[i], got->z_inner[i]);
    // It touches exactly at the golden's point.
    const auto line = joint::generator_at(30.0 + 5.0 * share[i], got->phi[i]);
    EXPECT_NEAR(joint::highest(contour->cutters, line)->z, z[i], 1e-9) << i;
    inner += share[i] < 1e-9 ? 1 : 0;
    outer += share[i] > 1.0 - 1e-9 ? 1 : 0;
  }
  EXPECT_EQ(inner, 146);
  EXPECT_EQ(outer, 203);
}

TEST(Contact, LiftedSmoothedFloorIsTheGolden) {
  const auto golden = testing::golden(kGolden);
  const auto contour = joint::trace(joint::table1(), 30);
  ASSERT_TRUE(contour);
  const auto b = numbers(golden, "seed000_table1_wall/floor_smoothed_K5_A1_norefine");
  const auto z = numbers(golden, "seed000_table1_wall/z_in_lifted");
  for (std::size_t i = 0; i < 360; ++i)
    EXPECT_NEAR(lift(contour->cutters, {30, 35},
                     joint::generator_at(30, Angle::deg(static_cast<double>(i)).rad()),
                     std::tan(Angle::deg(b[i]).rad())),
                z[i], 1e-9)
        << i;
}

TEST(Contact, EccentricLiftIsTheGolden) {
  const auto golden = testing::golden(kGolden);
  TableSpec spec{.target = {.outer_radius = 60, .wall = 6},
                 .partners = partners(joint::eccentric_cutters(golden))};
  spec.sampling.uniform_points = 360;
  spec.smoothing = NoSmoothing{};
  spec.contact = Contact::automatic;
  spec.groove = HalfDihedral{};
  spec.torch = {Angle::deg(-89), Angle::deg(89)};
  const auto got = table(spec);
  ASSERT_TRUE(got);
  expect_proved(spec, *got);
  const auto z = numbers(golden, "eccentric/wall/z_in_lifted");
  ASSERT_EQ(z.size(), 360U);
  for (std::size_t i = 0; i < 360; ++i) EXPECT_NEAR(got->z_inner[i], z[i], 1e-9) << i;
}

TEST(Contact, ATorchOf45DegreesOpensTheRoot) {
  auto spec = table_1(Contact::automatic);
  spec.torch = {Angle::deg(-45), Angle::deg(45)};
  spec.smoothing = EnvelopeSmoothing{.limits = {Angle::deg(5).rad(), Angle::deg(1).rad()}};
  spec.sampling = {.uniform_points = 360, .tolerance = joint::Tolerance{.value = 0.01}};
  const auto got = table(spec);
  ASSERT_TRUE(got);
  expect_proved(spec, *got);
  std::cout << "root opens by up to " << largest(got->gap) << " mm\n";
  EXPECT_NEAR(largest(got->gap), 2.17, 0.005);
  EXPECT_LE(largest(got->b), Angle::deg(45).rad());
  EXPECT_TRUE(warned(*got, WarningCode::root_opens));
  EXPECT_TRUE(warned(*got, WarningCode::torch_range_binds));
  ASSERT_FALSE(got->torch_binds.empty());
  double window = 0.0;
  for (const auto& binding : got->torch_binds) window = std::max(window, binding.root_gap);
  EXPECT_EQ(window, largest(got->gap));
  // Without the limit the root is closed.
  auto wide = spec;
  wide.torch = {};
  const auto closed = table(wide);
  ASSERT_TRUE(closed);
  EXPECT_LT(largest(closed->gap), 1e-6);
  EXPECT_FALSE(warned(*closed, WarningCode::root_opens));
}

TEST(Contact, OuterIsFlushOrAnError) {
  TableSpec spec{.target = {.outer_radius = 35, .wall = 5},
                 .partners = {joint::tube_deg(55, 60, 20, 5)}};
  spec.sampling.uniform_points = 180;
  spec.smoothing = NoSmoothing{};
  spec.root_surface = RootSurface::outer;
  spec.contact = Contact::outer;
  spec.groove = NoGroove{};
  const auto flush = table(spec);
  ASSERT_TRUE(flush);
  expect_proved(spec, *flush);
  const auto contour = joint::trace(std::vector<joint::Cutter>{joint::tube_deg(55, 60, 20, 5)}, 35);
  for (std::size_t i = 0; i < 180; ++i) {
    EXPECT_NEAR(flush->z_outer[i], joint::contact_at(*contour, flush->phi[i]).z, 1e-12);
    EXPECT_GE(flush->gap[i], -1e-12);
  }
  spec.groove = SquareCut{};
  const auto square = table(spec);
  ASSERT_FALSE(square);
  EXPECT_EQ(square.error().code(), ErrorCode::cut_enters);
  EXPECT_FALSE(std::get<Intervals>(square.error().issues.front().got).empty());
}

/// Least distance of a point to any body, mm; negative inside.
long double clearance(const std::vector<ray::Body>& bodies, double rho, double phi, long double z) {
  const ray::Point p{rho * std::cos(static_cast<long double>(phi)),
                     rho * std::sin(static_cast<long double>(phi)), z};
  long double least = 1e9L;
  for (const auto& body : bodies)
    least = std::min(
        least,
        std::sqrt(std::max(0.0L, ray::outside(body, p) + body.radius * body.radius)) - body.radius);
  return least;
}

struct Scan {
  long double deepest = 0, furthest = 0;  // into a partner; from any, where it should touch
};

/// Rows and straight interpolation between them, 33 points across the wall each.
void scan(const joint::RandomNode& node, const TableSpec& spec, const Table& t, Scan& out) {
  constexpr int kAcross = 32, kBetween = 3;
  const double inner = spec.target.inner_radius();
  for (std::size_t i = 0; i < t.phi.size(); ++i) {
    const auto j = (i + 1) % t.phi.size();
    const double turn = t.phi[j] - t.phi[i] + (j == 0 ? kTwoPi : 0.0);
    for (int m = 0; m < kBetween; ++m) {
      const double u = static_cast<double>(m) / kBetween;
      long double least = 1e9L;
      for (int k = 0; k <= kAcross; ++k) {
        const double v = static_cast<double>(k) / kAcross;
        const double low = t.z_inner[i] + v * (t.z_outer[i] - t.z_inner[i]);
        const double high = t.z_inner[j] + v * (t.z_outer[j] - t.z_inner[j]);
        least = std::min(least, clearance(node.bodies, inner + v * spec.target.wall,
                                          t.phi[i] + u * turn, low + u * (high - low)));
      }
      out.deepest = std::max(out.deepest, -least);
      if (m == 0 && spec.contact == Contact::automatic)
        out.furthest = std::max(out.furthest, least);
    }
  }
}

// All thousand: TUBECUT_JOINTS=1000.
TEST(Contact, NoRandomJointIsEnteredAndAutoTouches) {
  constexpr std::uint64_t kSeed = 20260127;
  const char* asked = std::getenv("TUBECUT_JOINTS");  // NOLINT(concurrency-mt-unsafe)
  const int joints = asked != nullptr ? std::atoi(asked) : 150;
  std::cout << "seed " << kSeed << '\n';
  std::mt19937_64 random(kSeed);
  Scan worst;
  int cut = 0, refused = 0;
  for (int n = 0; n < joints; ++n) {
    const auto node = joint::random_node(random, true, n % 3 == 0, false);
    TableSpec spec{.target = {.outer_radius = node.rho, .wall = 0.12 * node.rho},
                   .partners = partners(node.cutters)};
    spec.sampling.tolerance = joint::Tolerance{.value = 0.01};
    spec.contact = n % 4 == 0 ? Contact::inner : Contact::automatic;
    spec.groove = HalfDihedral{};
    spec.smoothing = NoSmoothing{};
    if (n % 4 == 2) spec.groove = SquareCut{};
    if (n % 4 == 3) spec.torch = {Angle::deg(-45), Angle::deg(45)};
    if (n % 2 == 0)
      spec.smoothing =
          EnvelopeSmoothing{.limits = {Angle::deg(5).rad(), Angle::deg(1).rad()}, .refine = false};
    const auto got = table(spec);
    if (!got) {
      EXPECT_EQ(got.error().code(), ErrorCode::torch_range) << n;
      ++refused;
      continue;
    }
    expect_proved(spec, *got);
    scan(node, spec, *got, worst);
    ++cut;
  }
  std::cout << cut << " joints, " << refused << " beyond the torch; penetration " << worst.deepest
            << " mm, off where it touches " << worst.furthest << " mm\n";
  EXPECT_GT(cut, joints * 3 / 4);
  EXPECT_LE(worst.deepest, 0.01L);
  EXPECT_LE(worst.furthest, 0.01L);
}

TEST(Contact, DegenerateJointsAreProvedOrNamed) {
  using enum ErrorCode;
  const std::set<ErrorCode> typed{open_profile, no_contact,  parallel_axes,
                                  zero_length,  torch_range, cut_enters};
  const int each = tubecut::testing::drawings(3, 1);
  int answered = 0, at = 0;
  for (const auto& c : joint::degenerate::cases()) {
    if (at++ % each != 0) continue;
    for (const auto contact : {Contact::inner, Contact::outer, Contact::automatic, Contact::none})
      for (const bool uniform : {true, false}) {
        TableSpec spec{.target = {.outer_radius = joint::degenerate::kRadius, .wall = 4.0},
                       .partners = c.partners,
                       .groove = HalfDihedral{},
                       .contact = contact,
                       .smoothing = NoSmoothing{}};
        if (contact == Contact::outer) {
          spec.root_surface = RootSurface::outer;
          spec.groove = NoGroove{};
        }
        if (uniform)
          spec.sampling.uniform_points = 90;
        else
          spec.sampling.tolerance = joint::Tolerance{};
        const auto made = table(spec);
        if (!made) {
          EXPECT_TRUE(typed.contains(made.error().code()))
              << c.name << ": " << info(made.error().code()).code;
          continue;
        }
        ++answered;
        for (const auto& check : verify(spec, *made))
          EXPECT_TRUE(check.passed()) << c.name << ": " << check.name << ' ' << check.value;
      }
  }
  EXPECT_GE(answered, 75 / each);  // of 208 / each
}

TEST(Contact, CorruptedNumbersAreSeen) {
  auto spec = table_1(Contact::automatic);
  const auto good = table(spec);
  ASSERT_TRUE(good);
  const auto fails = [&](const Table& bad, const std::string& name) {
    for (const auto& check : verify(spec, bad))
      if (check.name == name) return !check.passed();
    return false;
  };
  for (const auto* name : {"touch", "penetration"}) {
    auto bad = *good;
    const double by = std::string(name) == "touch" ? 1e-5 : -1e-5;
    for (auto* z : {&bad.z_inner, &bad.z_outer, &bad.gap}) (*z)[77] += 2.0 * by;
    EXPECT_TRUE(fails(bad, name)) << name;
    EXPECT_FALSE(fails(*good, name));
  }
}

// Source 002 by its own formulas: chord coordinates u, v, theta; no sheet, no placement.
TEST(OffsetPair, EqualsTheSourcesOwnFormulas) {
  std::mt19937_64 random(20260128);
  const auto any = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  double worst_z = 0.0, worst_omega = 0.0, worst_outer = 0.0;
  for (int n = 0; n < 100; ++n) {
    const double big = 100.0, r = any(20, 70), t = any(2, 0.3 * r), a = any(0.4, 2.7);
    const double e = any(-1, 1) * (big - r) * 0.9;
    TableSpec spec{.target = {.outer_radius = r, .wall = t},
                   .partners = {joint::TubeCutter{big, Angle::rad(a), Angle::deg(90), -e, 0.0}}};
    spec.sampling.uniform_points = 60;
    spec.smoothing = NoSmoothing{};
    spec.groove = HalfDihedral{};
    spec.torch = {Angle::deg(-89), Angle::deg(89)};
    const auto got = table(spec);
    ASSERT_TRUE(got) << n;
    for (std::size_t i = 0; i < 60; ++i) {
      const double f = got->phi[i];
      EXPECT_GT(f, i == 0 ? -1.0 : got->phi[i - 1]);  // counter-clockwise, seen against z
      const double x = (r - t) * std::cos(f), y = (r - t) * std::sin(f), v = y - e;
      const double z = (x * std::cos(a) + std::sqrt(big * big - v * v)) / std::sin(a);
      const double u = x * std::cos(a) - z * std::sin(a);
      const double cos_th = u / big, sin_th = v / big;
      const double psi = std::acos(-(std::cos(f) * cos_th * std::cos(a) + std::sin(f) * sin_th));
      const double bevel = psi > kPi / 2 ? kPi / 4 : psi / 2;
      const double tau = kPi / 2 - psi + bevel;
      const double gamma = std::atan((-std::sin(f) * std::cos(a) * cos_th + std::cos(f) * sin_th) /
                                     (-std::sin(a) * cos_th));
      const double omega = std::atan(std::tan(tau) / std::cos(gamma));
      worst_z = std::max(worst_z, std::abs(got->z_inner[i] - z));
      worst_omega = std::max(worst_omega, std::abs(got->b_raw[i] - omega));
      worst_outer = std::max(worst_outer, std::abs(got->z_outer[i] - (z + t * std::tan(omega))) *
                                              std::cos(omega) * std::cos(omega));
    }
  }
  std::cout << "z " << worst_z << " mm, omega " << worst_omega << " rad, Z' " << worst_outer
            << '\n';
  EXPECT_LT(worst_z, 1e-11);
  EXPECT_LT(worst_omega, 1e-12);
  EXPECT_LT(worst_outer, 1e-9);
}

TEST(RootAndCoating, KeepTheirDistanceFromTheMetal) {
  auto spec = table_1(Contact::inner);
  spec.coating = 0.4;
  spec.root_gap = 2.0;
  const auto got = table(spec);
  ASSERT_TRUE(got);
  expect_proved(spec, *got);
  std::vector<ray::Body> bodies;
  for (const auto& cutter : joint::table1()) bodies.push_back(joint::body_of(cutter));
  for (std::size_t i = 0; i < 360; ++i) {
    EXPECT_NEAR(static_cast<double>(clearance(bodies, 30, got->phi[i], got->z_inner[i])), 2.4,
                1e-11);
    for (int k = 0; k <= 10; ++k)
      EXPECT_GE(clearance(bodies, 30 + 0.5 * k, got->phi[i],
                          got->z_inner[i] + 0.1 * k * (got->z_outer[i] - got->z_inner[i])),
                2.4 - 1e-9);
  }
}

TEST(RootFace, IsALandOfThatHeight) {
  auto spec = table_1(Contact::inner);
  spec.root_face = 1.5;
  const auto got = table(spec);
  ASSERT_TRUE(got);
  expect_proved(spec, *got);
  const auto plain = table(table_1(Contact::inner));
  ASSERT_TRUE(plain);
  EXPECT_TRUE(plain->z_face.empty());
  std::vector<ray::Body> bodies;
  for (const auto& cutter : joint::table1()) bodies.push_back(joint::body_of(cutter));
  int square = 0, steep = 0;
  for (std::size_t i = 0; i < 360; ++i) {
    EXPECT_EQ(got->z_inner[i], plain->z_inner[i]);
    EXPECT_GE(got->b_face[i], 0.0);
    EXPECT_NEAR(got->z_face[i] - got->z_inner[i], 1.5 * std::tan(got->b_face[i]), 1e-12);
    EXPECT_NEAR(got->z_outer[i] - got->z_face[i], 3.5 * std::tan(got->b[i]), 1e-9);
    // The bevel's own line, prolonged to the inner wall, is where the torch goes.
    EXPECT_NEAR(got->torch_outer[i] - got->torch_inner[i], 5.0 * std::tan(got->b[i]), 1e-9);
    for (int k = 0; k <= 10; ++k)
      EXPECT_GE(clearance(bodies, 30 + 0.15 * k, got->phi[i],
                          got->z_inner[i] + 0.1 * k * (got->z_face[i] - got->z_inner[i])),
                -1e-9L);
    square += got->b_face[i] == 0.0 ? 1 : 0;
    steep += got->b_face[i] > 0.0 ? 1 : 0;
  }
  EXPECT_GT(square, 0);
  EXPECT_GT(steep, 0);
  spec.root_face = 5.0;
  EXPECT_EQ(table(spec).error().code(), ErrorCode::out_of_range);
  spec.root_face = 1.0;
  spec.contact = Contact::automatic;
  EXPECT_EQ(table(spec).error().code(), ErrorCode::unsupported_combination);
}

ZonedGroove procedure(double overlap_deg) {
  const auto zone = [](const char* id, double from, double to, double g_from, double g_to) {
    return GrooveZone{id, Angle::deg(from), Angle::deg(to), Angle::deg(g_from), Angle::deg(g_to)};
  };
  return {{zone("A", 120, 180, 45, 45), zone("B", 60, 120, 30, 40), zone("C", 0, 60, 0, 20)},
          Angle::deg(overlap_deg)};
}

TEST(Zones, StraightInsideFloatingBetween) {
  const Zones zones(procedure(10));
  const auto at = [&](double deg) { return zones.at(Angle::deg(deg).rad()); };
  EXPECT_NEAR(at(90).groove * kDegPerRad, 35.0, 1e-12);
  EXPECT_EQ(at(90).zone, 1U);
  EXPECT_NEAR(at(150).groove * kDegPerRad, 45.0, 1e-12);
  EXPECT_EQ(at(150).zone, 0U);
  EXPECT_NEAR(at(120).groove * kDegPerRad, 42.5, 1e-12);  // half way across 115..125
  EXPECT_EQ(at(119.9).zone, 1U);
  EXPECT_EQ(at(120.1).zone, 0U);
  EXPECT_NEAR(at(60).groove * kDegPerRad, 25.0, 1e-12);
  EXPECT_NEAR(at(55).groove * kDegPerRad, 20.0 * 55 / 60, 1e-9);
  double before = at(0).groove;
  for (double deg = 0.0; deg <= 180.0; deg += 0.01) {  // no step anywhere
    EXPECT_LT(std::abs(at(deg).groove - before), Angle::deg(0.02).rad()) << deg;
    EXPECT_TRUE(at(deg).inside);
    before = at(deg).groove;
  }
  const Zones steps(procedure(0));
  EXPECT_NEAR(steps.at(Angle::deg(119.999).rad()).groove * kDegPerRad, 40.0, 1e-3);
  EXPECT_NEAR(steps.at(Angle::deg(120.001).rad()).groove * kDegPerRad, 45.0, 1e-3);
}

TEST(Zones, AreChecked) {
  EXPECT_TRUE(check_zones(procedure(5)));
  auto gap = procedure(5);
  gap.zones[1].dihedral_from = Angle::deg(61);
  EXPECT_FALSE(check_zones(gap));
  EXPECT_FALSE(check_zones(procedure(80)));  // the two bands meet
  auto reversed = procedure(5);
  std::swap(reversed.zones[0].dihedral_from, reversed.zones[0].dihedral_to);
  EXPECT_FALSE(check_zones(reversed));
  EXPECT_FALSE(check_zones({}));
}

TEST(Zones, NameEveryPointOfATable) {
  auto spec = table_1(Contact::inner);
  spec.groove = procedure(10);
  const auto got = table(spec);
  ASSERT_TRUE(got);
  expect_proved(spec, *got);
  ASSERT_EQ(got->zone.size(), 360U);
  const Zones zones(procedure(10));
  for (std::size_t i = 0; i < 360; ++i) {
    EXPECT_EQ(got->zone[i], zones.at(got->dihedral[i]).zone);
    EXPECT_EQ(got->groove[i], zones.at(got->dihedral[i]).groove);
    EXPECT_NEAR(got->tau[i], kPi / 2 - got->dihedral[i] + got->groove[i], 1e-15);
  }
  auto narrow = procedure(10);
  narrow.zones.pop_back();
  spec.groove = narrow;
  const auto missing = table(spec);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().issues.front().member, "groove/zones");
  EXPECT_FALSE(std::get<Intervals>(missing.error().issues.front().got).empty());
}

// Lengths by 2^k, limits by 2^-k and 4^-k: every angle keeps its bits, every length is scaled.
TEST(Scaling, ByPowersOfTwoIsExactThroughTheWholeTable) {
  for (const bool uniform : {true, false})
    for (const auto contact : {Contact::inner, Contact::automatic}) {
      auto spec = table_1(contact);
      spec.kerf = 1.5;
      spec.root_gap = 0.5;
      if (!uniform) spec.sampling = {.tolerance = joint::Tolerance{.value = 0.0625}};
      const auto with_limits = [&](double k) {
        auto out = spec;
        out.target.outer_radius *= k;
        out.target.wall *= k;
        out.kerf *= k;
        out.root_gap *= k;
        for (auto& partner : out.partners) {
          auto& tube = std::get<joint::TubeCutter>(partner);
          tube.radius *= k;
          tube.offset *= k;
          tube.height *= k;
        }
        if (out.sampling.tolerance) out.sampling.tolerance->value *= k;
        out.smoothing =
            EnvelopeSmoothing{.limits = {Angle::deg(5).rad() / k, Angle::deg(1).rad() / k / k}};
        return out;
      };
      const auto one = table(with_limits(1.0));
      ASSERT_TRUE(one);
      for (const double k : {0.25, 8.0, 64.0}) {
        const auto got = table(with_limits(k));
        ASSERT_TRUE(got);
        EXPECT_EQ(one->phi, got->phi);
        EXPECT_EQ(one->cutter, got->cutter);
        EXPECT_EQ(one->dihedral, got->dihedral);
        EXPECT_EQ(one->b_raw, got->b_raw);
        EXPECT_EQ(one->b_required, got->b_required);
        EXPECT_EQ(one->b, got->b);
        const auto scaled = [&](std::vector<double> v) {
          for (auto& x : v) x *= k;
          return v;
        };
        EXPECT_EQ(scaled(one->z_inner), got->z_inner);
        EXPECT_EQ(scaled(one->z_outer), got->z_outer);
        // The permitted loss of the part is 0.01 mm at any size: a large one's torch is lower.
        const auto inner = scaled(one->torch_inner), outer = scaled(one->torch_outer);
        for (std::size_t i = 0; i < inner.size(); ++i) {
          EXPECT_LE(got->torch_inner[i], inner[i]);
          EXPECT_LE(got->torch_outer[i], outer[i]);
        }
        if (k <= 8.0) {
          EXPECT_EQ(inner, got->torch_inner);
          EXPECT_EQ(outer, got->torch_outer);
        }
        EXPECT_EQ(scaled(one->length), got->length);
        EXPECT_EQ(scaled(one->gap), got->gap);
      }
    }
}

/// Values of the warnings `wall_overhangs`: from, to in deg, and the overhang in mm.
std::vector<std::array<double, 3>> overhangs(const Table& table) {
  std::vector<std::array<double, 3>> out;
  for (const auto& w : table.warnings) {
    if (w.code != WarningCode::wall_overhangs) continue;
    std::array<double, 3> said{};
    EXPECT_EQ(std::sscanf(w.detail.c_str(),  // NOLINT(cert-err34-c): the test requires three values
                          "phi %lf to %lf deg, its outer surface passes up to %lf", &said[0],
                          &said[1], &said[2]),
              3)
        << w.detail;
    out.push_back(said);
  }
  std::ranges::sort(out, {}, [](const auto& said) { return said[2]; });
  return out;
}

// A bore that meets its partner all round and a wall that does not: on each side it reaches beyond
// the partner's by plain sums of radii, over the arc of that sine. If the partner is equally wide
// or wider, there is no warning.
TEST(Contact, AWallWiderThanItsPartnerReportsItsOverhang) {
  for (const double inclination : {45.0, 60.0, 90.0})
    for (const double offset : {0.0, 0.6}) {
      const double outer = 30.15, partner = 26.0;
      TableSpec spec{.target = {.outer_radius = outer, .wall = 5.0},
                     .partners = {joint::TubeCutter{partner, Angle::deg(inclination),
                                                    Angle::deg(20), offset, 0.0}}};
      spec.sampling.uniform_points = 180;
      spec.smoothing = NoSmoothing{};
      const auto got = table(spec);
      ASSERT_TRUE(got);
      const auto said = overhangs(*got);
      ASSERT_EQ(said.size(), 2U);
      for (std::size_t side = 0; side < 2; ++side) {
        const double shift = side == 0 ? -offset : offset;
        EXPECT_NEAR(said[side][2], outer - partner + shift, 2e-2);
        const double silhouette = std::asin((partner - shift) / outer) * kDegPerRad;
        EXPECT_NEAR(said[side][1] - said[side][0], 180.0 - 2.0 * silhouette, 1e-2);
      }
      spec.partners = {
          joint::TubeCutter{outer + offset, Angle::deg(inclination), Angle::deg(20), offset, 0.0}};
      const auto wide = table(spec);
      ASSERT_TRUE(wide);
      EXPECT_TRUE(overhangs(*wide).empty());
    }
}

// A tube whose bore touches two set-in partners tangentially where they meet: turning all partners
// about it moves every place of the cut, and changes no height.
TEST(Contact, TurningAllPartnersChangesNoLength) {
  const auto turned = [](double degrees) {
    const double low = 40.41337530811;
    const auto partner = [&](double inclination, double clocking) {
      return joint::TubeCutter{19.05, Angle::deg(inclination), Angle::deg(clocking)};
    };
    TableSpec spec{.target = {.outer_radius = 19.05, .wall = 2.5},
                   .partners = {partner(low, degrees), partner(90.0 - low, degrees + 180.0)}};
    spec.stated.assign(2, joint::Joint{.kind = joint::JointKind::set_in, .depth = 2.5});
    spec.groove = NoGroove{};
    spec.contact = Contact::automatic;
    spec.smoothing = NoSmoothing{};
    spec.sampling.tolerance = joint::Tolerance{0.05, joint::Metric::developed};
    spec.kerf = 1.0;
    return table(spec);
  };
  const auto drawn = turned(0.0);
  ASSERT_TRUE(drawn);
  const auto least = [](const std::vector<double>& z) { return *std::ranges::min_element(z); };
  for (const double degrees : {5.0, 20.0, 84.0, 85.0, 180.0, 301.7}) {
    const auto other = turned(degrees);
    ASSERT_TRUE(other);
    EXPECT_NEAR(least(other->z_outer), least(drawn->z_outer), 1e-6) << degrees;
    EXPECT_NEAR(least(other->z_inner), least(drawn->z_inner), 1e-6) << degrees;
    EXPECT_NEAR(least(other->torch_outer), least(drawn->torch_outer), 0.05) << degrees;
    EXPECT_EQ(other->torch_binds.size(), drawn->torch_binds.size()) << degrees;
  }
}

}  // namespace
}  // namespace tubecut::bevel
