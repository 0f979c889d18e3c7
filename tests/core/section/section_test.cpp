#include "core/section/section.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/core/section/golden_ends.hpp"

namespace tubecut::section {
namespace {

using testing::golden_section;
using testing::number;
using testing::numbers;

/// Distance on a closed outline.
double apart(double a, double b, double girth) {
  const double d = std::abs(a - b);
  return std::min(d, std::abs(girth - d));
}

TEST(Section, StandardsGiveGoldenRadiiAreasAndSeams) {
  const auto golden = testing::golden("sections.json");
  const auto& all = *testing::at(golden, "standards").as<api::Json::Array>();
  ASSERT_EQ(all.size(), 11U);
  for (const auto& one : all) {
    const auto want = golden_section(one);
    const auto name = testing::text(one, "standard");
    const auto standard = name == "EN 10210"   ? Standard::en_10210
                          : name == "EN 10219" ? Standard::en_10219
                                               : Standard::astm_a500;
    const auto radii = corner_radii(standard, want.wall);
    EXPECT_NEAR(radii.outer, want.corner, 1e-12) << name;
    EXPECT_NEAR(radii.inner, want.inner_corner, 1e-12) << name;
    ASSERT_TRUE(check(want));
    EXPECT_NEAR(area(want), number(one, "area"), 1e-9);
    EXPECT_NEAR(mass_per_metre(want), number(one, "mass_kg_per_m"), 1e-11);
    const Wall wall(want);
    EXPECT_NEAR(wall.outer().girth(), number(one, "girth"), 1e-9);
    EXPECT_NEAR(wall.bore().girth(), number(one, "bore_girth"), 1e-9);
    const auto middle = wall.outer().at(wall.outer().on_corner(1, 0.25 * kPi));
    EXPECT_NEAR(wall.across(middle).wall, number(one, "wall_at_corner"), 1e-12);
    // The golden seams are those of both outlines, seen from outside.
    const double girth = wall.outer().girth();
    const auto seams = numbers(one, "seams");
    std::size_t own = wall.outer().seams().size();
    for (const double s : wall.bore().seams()) {
      const double outside = wall.outside_of(wall.bore().at(s));
      bool known = false;
      for (const double other : wall.outer().seams())
        known = known || apart(other, outside, girth) < 1e-9;
      own += known ? 0 : 1;
      bool found = false;
      for (const double want_s : seams) found = found || apart(want_s, outside, girth) < 1e-9;
      EXPECT_TRUE(found) << name << " " << outside;
    }
    EXPECT_EQ(own, seams.size()) << name;
  }
}

TEST(Section, StationsAndWallsAreGolden) {
  const auto golden = testing::golden("sections.json");
  for (const auto& end : testing::golden_ends(golden)) {
    SCOPED_TRACE(end.name);
    const Wall wall(end.section);
    const auto& rows = testing::at(*end.json, "rows");
    const auto s = numbers(rows, "s"), nu = numbers(rows, "nu_deg"), x = numbers(rows, "x"),
               y = numbers(rows, "y"), across = numbers(rows, "wall"), xi = numbers(rows, "x_in"),
               yi = numbers(rows, "y_in"), si = numbers(rows, "s_in"),
               nui = numbers(rows, "nu_in_deg");
    for (std::size_t i = 0; i < s.size(); ++i) {
      const auto at = wall.outer().at(s[i]);
      EXPECT_NEAR(at.point.x(), x[i], 1e-10);
      EXPECT_NEAR(at.point.y(), y[i], 1e-10);
      EXPECT_NEAR(std::remainder(at.nu * kDegPerRad - nu[i], 360.0), 0.0, 1e-9);
      const auto in = wall.across(at);
      EXPECT_NEAR(in.wall, across[i], 1e-10) << s[i];
      EXPECT_NEAR(in.bore.point.x(), xi[i], 1e-10);
      EXPECT_NEAR(in.bore.point.y(), yi[i], 1e-10);
      EXPECT_LT(apart(in.bore.s, si[i], wall.bore().girth()), 1e-9) << s[i];
      EXPECT_NEAR(std::remainder(in.bore.nu * kDegPerRad - nui[i], 360.0), 0.0, 1e-8) << s[i];
    }
  }
}

TEST(Section, APlaceAfterAnotherIsThatPlace) {
  for (const auto& curve : {section::Curve(100, 60, 8), section::Curve(40, 90, 20),
                            section::Curve(50, 50, 25), section::Curve(80, 80, 0)})
    for (int i = 0; i < 200; ++i)
      for (const double way : {0.0, 0.01, 0.7, 3.0, 25.0, 140.0}) {
        const auto from = curve.at(curve.girth() * i / 200.0);
        const auto got = curve.after(from, way), want = curve.at(from.s + way);
        ASSERT_LT((got.point - want.point).norm(), 1e-13);
        ASSERT_LT((got.normal - want.normal).norm(), 1e-14);
        ASSERT_NEAR(got.s, want.s, 1e-13);
        ASSERT_NEAR(got.nu, want.nu, 1e-14);
        ASSERT_NEAR(got.along, want.along, 1e-13);
        ASSERT_EQ(got.on_corner, want.on_corner);
        ASSERT_EQ(got.face, want.face);
      }
}

TEST(Section, EveryPlaceOfTheBoreHasItsLineOutside) {
  std::mt19937_64 random(20261127);
  const auto any = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int used = 0;
  while (used < 300) {
    Section s{.height = any(20, 200), .width = any(20, 200), .wall = any(1, 9)};
    s.corner = any(1.0, 4.0) * s.wall;
    s.inner_corner = any(0.0, 3.0) * s.wall;
    if (2.0 * s.wall >= std::min(s.height, s.width) || !check(s)) continue;
    ++used;
    const Wall wall(s);
    for (int k = 0; k < 100; ++k) {
      const auto bore = wall.bore().at(any(0.0, wall.bore().girth()));
      const auto outside = wall.outer().at(wall.outside_of(bore));
      const auto across = wall.across(outside);
      EXPECT_LT((across.bore.point - bore.point).norm(), 1e-9);
      EXPECT_LT((outside.point - across.wall * outside.normal - bore.point).norm(), 1e-9);
      EXPECT_LT(apart(across.bore.s, bore.s, wall.bore().girth()), 1e-7);
      EXPECT_GT(across.wall, 0.5 * s.wall);
    }
  }
}

TEST(Section, OvalHasFourSeamsAndRoundNone) {
  const Curve oval(120, 60, 30), round(88.9, 88.9, 44.45);
  EXPECT_EQ(oval.seams().size(), 4U);
  EXPECT_EQ(oval.segments().size(), 4U);
  EXPECT_TRUE(round.seams().empty());
  ASSERT_EQ(round.segments().size(), 1U);
  for (double phi = 0.0; phi < 6.2; phi += 0.1) {
    const auto at = round.at(44.45 * phi);
    EXPECT_NEAR(at.nu, phi, 1e-14);
    EXPECT_NEAR(at.curvature, 1.0 / 44.45, 1e-16);
  }
}

TEST(Section, RefusesCornersThatCannotBeCut) {
  const Section good{.height = 100, .width = 50, .wall = 4, .corner = 6, .inner_corner = 4};
  EXPECT_TRUE(check(good));
  const auto refused = [](Section s) {
    const auto result = check(s);
    return result ? std::string() : result.error().issues.front().member;
  };
  auto bad = good;
  bad.corner = 25.1;
  EXPECT_EQ(refused(bad), "corner_radius");
  bad.corner = 4.1;  // its centre lies in the wall
  bad.inner_corner = 0.1;
  EXPECT_EQ(refused(bad), "corner_radius");
  bad = good;
  bad.corner = 5.0;  // an inner radius that reaches beyond it
  bad.inner_corner = 8.0;
  EXPECT_EQ(refused(bad), "corner_radius");
  bad = good;
  bad.corner = 15.0;  // little metal on the diagonal
  bad.inner_corner = 2.0;
  EXPECT_EQ(refused(bad), "inner_corner_radius");
  bad = good;
  bad.inner_corner = 21.1;
  EXPECT_EQ(refused(bad), "inner_corner_radius");
}

}  // namespace
}  // namespace tubecut::section
