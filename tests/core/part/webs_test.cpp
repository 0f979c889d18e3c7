#include "core/part/webs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <random>

#include "tests/support/drawings.hpp"

namespace tubecut::part {
namespace {

double any(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

constexpr double kOuter = 100, kWall = 8;

/// An outline about (phi, z): an egg, the bore's smaller and shifted.
bevel::Hole egg(double phi, double z, double size, double shift) {
  bevel::Hole out;
  constexpr int kRows = 60;
  for (int i = 0; i < kRows; ++i) {
    const double w = kTwoPi * i / kRows, r = size * (1 + 0.3 * std::cos(w));
    out.phi.push_back(phi + r * std::cos(w) / kOuter);
    out.z.push_back(z + r * std::sin(w));
    out.phi_inner.push_back(phi + (0.9 * r * std::cos(w) + shift) / (kOuter - kWall));
    out.z_inner.push_back(z + 0.9 * r * std::sin(w));
  }
  return out;
}

Part part_of(std::vector<bevel::Hole> holes, double length) {
  Part out;
  for (auto& hole : holes) out.holes.push_back({std::move(hole), out.holes.size()});
  for (const bool finish : {false, true}) {
    auto& t = (finish ? out.finish : out.start).table;
    for (int i = 0; i < 180; ++i) {
      const double phi = kTwoPi * i / 180;
      t.phi.push_back(phi);
      t.z_outer.push_back((finish ? length : 0.0) + 12 * std::cos(2 * phi));
      t.z_inner.push_back((finish ? length : 0.0) + 9 * std::cos(2 * phi));
    }
  }
  return out;
}

PartSpec spec() {
  PartSpec out;
  out.target = {.outer_radius = kOuter, .wall = kWall};
  return out;
}

/// Points along a line, spaced a thirtieth of a millimetre.
std::vector<std::pair<double, double>> dense(const std::vector<double>& phi,
                                             const std::vector<double>& z, double radius,
                                             double closing) {
  std::vector<std::pair<double, double>> out;
  for (std::size_t i = 0; i < phi.size(); ++i) {
    const auto j = (i + 1) % phi.size();
    const double to = phi[j] + (j == 0 ? closing : 0.0);
    const double length = std::hypot(radius * (to - phi[i]), z[j] - z[i]);
    const int n = static_cast<int>(std::ceil(length * 30));
    for (int k = 0; k < n; ++k) {
      const double t = static_cast<double>(k) / n;
      out.emplace_back(phi[i] + t * (to - phi[i]), z[i] + t * (z[j] - z[i]));
    }
  }
  return out;
}

/// The shortest way over the cylinder between two sets of points, every one with every other.
double apart(const std::vector<std::pair<double, double>>& a,
             const std::vector<std::pair<double, double>>& b, double radius) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.size(); i += 3)
    for (std::size_t j = 0; j < b.size(); j += 3) {
      const double turn = std::remainder(a[i].first - b[j].first, kTwoPi);
      best = std::min(best, std::hypot(radius * turn, a[i].second - b[j].second));
    }
  return best;
}

// Holes anywhere round the tube, across the datum line too, against every point with every point.
TEST(Webs, AreThoseOfDensePointSets) {
  std::mt19937_64 random(11);
  double worst = 0;
  int between = 0, ends = 0;
  for (int round = 0; round < testing::drawings(4, 12); ++round) {
    std::vector<bevel::Hole> holes;
    for (int k = 0; k < 3; ++k)
      holes.push_back(egg(any(random, -1.5, 7.5), 60 + 75.0 * k + any(random, -4, 4),
                          any(random, 10, 22), any(random, -2, 2)));
    const auto part = part_of(holes, 280);
    const auto found = webs(spec(), part);
    ASSERT_TRUE(found.between_holes && found.to_end && found.to_seam);
    double web = 1e300, end = 1e300, seam = 1e300;
    for (const bool outer : {false, true}) {
      const double radius = outer ? kOuter : kOuter - kWall;
      std::vector<std::vector<std::pair<double, double>>> lines;
      for (const auto& h : holes)
        lines.push_back(dense(outer ? h.phi : h.phi_inner, outer ? h.z : h.z_inner, radius, 0));
      for (std::size_t i = 0; i < lines.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) web = std::min(web, apart(lines[i], lines[j], radius));
        for (const auto* t : {&part.start.table, &part.finish.table})
          end = std::min(
              end, apart(lines[i], dense(t->phi, outer ? t->z_outer : t->z_inner, radius, kTwoPi),
                         radius));
        for (const auto& [phi, z] : lines[i])
          seam = std::min(seam, radius * std::abs(std::remainder(phi, kTwoPi)));
      }
    }
    worst = std::max({worst, std::abs(found.between_holes->width - web),
                      std::abs(found.to_end->width - end), std::abs(found.to_seam->girth - seam)});
    found.narrowest()->beside == Beside::hole ? ++between : ++ends;
  }
  std::cout << "webs off by " << worst << " mm; " << between << " between holes, " << ends
            << " to an end\n";
  EXPECT_LT(worst, 0.11);
  EXPECT_GT(between, 0);
  EXPECT_GT(ends, 0);
}

TEST(Webs, NameTheirPlaces) {
  const auto part = part_of({egg(0.1, 100, 20, 0), egg(kTwoPi + 0.1, 170, 20, 0)}, 400);
  const auto found = webs(spec(), part);
  ASSERT_TRUE(found.between_holes);
  const auto& web = *found.between_holes;
  EXPECT_EQ(web.hole, 0u);
  EXPECT_EQ(web.other, 1u);
  EXPECT_NEAR(web.width, std::hypot(kOuter * 0.0, web.to.z - web.from.z), 1e-9);
  EXPECT_GT(web.to.z, web.from.z);
  EXPECT_NEAR(found.to_seam->girth, 0.0, 0.0);  // both lie across the datum line
}

TEST(Webs, AreZeroIfHolesMeetOrReachIntoAnEnd) {
  const auto meeting = webs(spec(), part_of({egg(1, 100, 20, 0), egg(1.2, 110, 20, 0)}, 400));
  EXPECT_EQ(meeting.between_holes->width, 0.0);
  const auto within = webs(spec(), part_of({egg(1, 100, 20, 0), egg(7.28, 100, 5, 0)}, 400));
  EXPECT_EQ(within.between_holes->width, 0.0);
  const auto across = webs(spec(), part_of({egg(1, 10, 20, 0)}, 400));
  EXPECT_EQ(across.to_end->width, 0.0);
  EXPECT_EQ(across.to_end->beside, Beside::start);
  const auto beyond = webs(spec(), part_of({egg(1, 480, 20, 0)}, 400));
  EXPECT_EQ(beyond.to_end->width, 0.0);
  EXPECT_EQ(beyond.to_end->beside, Beside::finish);
  EXPECT_FALSE(beyond.between_holes);
  EXPECT_FALSE(webs(spec(), part_of({}, 400)).narrowest());
}

TEST(Webs, MirrorTurnAndScaleCarryThem) {
  const auto base = std::vector{egg(0.2, 100, 20, 1), egg(1.0, 150, 15, -1)};
  const auto one = webs(spec(), part_of(base, 300));
  auto turned = base;
  for (auto& h : turned)
    for (auto* column : {&h.phi, &h.phi_inner})
      for (double& phi : *column) phi += kPi;  // the ends have that period
  const auto two = webs(spec(), part_of(turned, 300));
  auto mirrored = base;
  for (auto& h : mirrored)
    for (auto* column : {&h.phi, &h.phi_inner})
      for (double& phi : *column) phi = -phi;
  const auto three = webs(spec(), part_of(mirrored, 300));
  auto large = part_of(base, 300);
  for (auto& placed : large.holes)
    for (auto* column : {&placed.hole.z, &placed.hole.z_inner})
      for (double& z : *column) z *= 2;
  for (auto* end : {&large.start.table, &large.finish.table})
    for (auto* column : {&end->z_inner, &end->z_outer})
      for (double& z : *column) z *= 2;
  auto doubled = spec();
  doubled.target = {.outer_radius = 2 * kOuter, .wall = 2 * kWall};
  const auto four = webs(doubled, large);
  for (const auto* other : {&two, &three}) {
    EXPECT_NEAR(other->between_holes->width, one.between_holes->width, 1e-9);
    EXPECT_NEAR(other->to_end->width, one.to_end->width, 1e-9);
  }
  EXPECT_NEAR(four.between_holes->width, 2 * one.between_holes->width, 1e-9);
  EXPECT_NEAR(four.to_end->width, 2 * one.to_end->width, 1e-9);
  EXPECT_NEAR(three.to_seam->girth, one.to_seam->girth, 1e-9);
}

}  // namespace
}  // namespace tubecut::part
