// The border between a contour's points, against the contour that was sampled.
#include "core/motion/path/border.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/motion/path/lead.hpp"
#include "tests/core/motion/random_jobs.hpp"

namespace tubecut::motion::testing {
namespace {

constexpr double kRadius = 50.0;  // of the tube, mm

/// A window with rounded corners, mm.
struct Window {
  double along, round, corner;

  /// Distance beyond its edge, mm; negative within it.
  [[nodiscard]] double beyond(double s, double z) const {
    const double x = std::abs(z) - (along / 2 - corner), y = std::abs(s) - (round / 2 - corner);
    return std::hypot(std::max(x, 0.0), std::max(y, 0.0)) + std::min(std::max(x, y), 0.0) - corner;
  }
};

CutPath empty() { return {.outer_radius = kRadius, .wall = 0.0, .scrap = Scrap::inside}; }

void add(double s, double z, CutPath& out) {
  out.phi.push_back(s / kRadius);
  out.z.push_back(z);
  out.b.push_back(0.0);
}

/// A window's points: its corners in this number of chords, its sides in this number, begun at the
/// start of a side.
CutPath sampled(const Window& w, int chords, int pieces) {
  CutPath out = empty();
  for (int q = 0; q < 4; ++q) {
    const double sz = q == 0 || q == 3 ? 1.0 : -1.0, ss = q < 2 ? 1.0 : -1.0;
    const double cz = sz * (w.along / 2 - w.corner), cs = ss * (w.round / 2 - w.corner);
    for (int i = 0; i <= chords; ++i) {
      const double t = kPi / 2 * (q + static_cast<double>(i) / chords);
      add(cs + w.corner * std::sin(t), cz + w.corner * std::cos(t), out);
    }
    const double side = q % 2 == 0 ? w.along - 2 * w.corner : w.round - 2 * w.corner;
    const double t = kPi / 2 * (q + 1);
    const double s = cs + w.corner * std::sin(t), z = cz + w.corner * std::cos(t);
    for (int i = 1; i < pieces; ++i)
      add(s + side * i / pieces * std::cos(t), z - side * i / pieces * std::sin(t), out);
  }
  add(out.phi.front() * kRadius, out.z.front(), out);
  return out;
}

/// mm, between an arc's chord and the arc.
double sag_of(const Window& w, int chords) { return w.corner * (1.0 - std::cos(kPi / 4 / chords)); }

Window drawn(Dice& dice) {
  const double corner = dice.uniform(0.5, 8.0);
  return {2 * corner + dice.uniform(4.0, 80.0), 2 * corner + dice.uniform(4.0, 60.0), corner};
}

double depth_at(const PartBorder& border, double s, double z) {
  return intrusion(border, {.phi = s / kRadius, .z = z});
}

// With a side as one chord or as several, next to the short chords of an arc.
TEST(Borders, StraightSidesStayStraightNextToArcs) {
  Dice dice(71);
  for (int i = 0; i < 300; ++i) {
    const Window w = drawn(dice);
    const int chords = 4 + dice.below(12), pieces = 1 + dice.below(3);
    const auto border = part_border(sampled(w, chords, pieces), -1.0);
    ASSERT_TRUE(border);
    const double sag = sag_of(w, chords);
    EXPECT_LT(border->sag, 1.3 * sag + 1e-9) << i;
    for (int k = 0; k < 100; ++k) {
      const double s = dice.uniform(-0.55, 0.55) * w.round, z = dice.uniform(-0.55, 0.55) * w.along;
      const double beyond = w.beyond(s, z);
      EXPECT_NEAR(std::max(-w.corner, depth_at(*border, s, z)), std::max(-w.corner, beyond),
                  1.3 * sag + 0.002)
          << i << " " << s << " " << z;
    }
  }
}

// A polygon whose corners are cut by one short chord each has straight sides too.
TEST(Borders, StraightSidesStayStraightNextToOneShortChord) {
  constexpr int kSides = 24;  // turns of 15 deg, half of it at each end of a chord
  for (const double chord : {0.05, 0.3, 1.0})
    for (const int pieces : {1, 2}) {
      CutPath path = empty();
      double s = 0.0, z = 0.0;
      for (int i = 0; i < 2 * kSides; ++i) {
        const double t = kPi / kSides * i;
        const int parts = i % 2 == 0 ? pieces : 1;
        for (int k = 0; k < parts; ++k) {
          add(s, z, path);
          const double step = i % 2 == 0 ? 8.0 / pieces : chord;
          s += step * std::sin(t);
          z += step * std::cos(t);
        }
      }
      add(path.phi.front() * kRadius, path.z.front(), path);
      const auto border = part_border(path, -1.0);
      ASSERT_TRUE(border) << chord << " " << pieces;
      const double turn = kPi / kSides;
      for (double share = 0.05; share < 1.0; share += 0.05)
        EXPECT_LT(std::abs(depth_at(*border, 0.0, 8.0 * share)), 0.5 * chord * turn) << chord;
    }
}

// Long and short chords of one circle are no straight edges.
TEST(Borders, UnevenPointsOfACircleStayACircle) {
  Dice dice(72);
  constexpr double kCircle = 20.0, kApart = 0.12;  // mm, rad
  for (const int runs : {2, 3, 5}) {
    CutPath path = empty();
    std::vector<double> at;
    for (double t = 0.0; t < kTwoPi - 1e-9;) {
      const bool dense = static_cast<int>(at.size()) / 4 % runs == 1;
      at.push_back(t);
      t += std::min(dense ? 0.2 * kApart : kApart, kTwoPi - t);
    }
    for (const double t : at) add(kCircle * std::sin(t), kCircle * std::cos(t), path);
    add(path.phi.front() * kRadius, path.z.front(), path);
    const auto border = part_border(path, -1.0);
    ASSERT_TRUE(border);
    const double sag = kCircle * kApart * kApart / 8;
    EXPECT_NEAR(border->sag, sag, 0.2 * sag) << runs;
    for (int k = 0; k < 500; ++k) {
      const double t = dice.uniform(0.0, kTwoPi), r = kCircle + dice.uniform(-1.0, 1.0);
      EXPECT_NEAR(depth_at(*border, r * std::sin(t), r * std::cos(t)), r - kCircle, 0.2 * sag)
          << runs << " " << t;
    }
  }
}

// Leads and overcuts of any length: what is not refused is clear of the window that was sampled.
TEST(Borders, LeadsOutOfRoundedCornersStayOffTheWindow) {
  Dice dice(73);
  int clear = 0, refused = 0;
  for (int i = 0; i < 2000; ++i) {
    const Window w = drawn(dice);
    const int chords = 4 + dice.below(12);
    const auto path = sampled(w, chords, 2);
    const auto border = part_border(path, -1.0);
    ASSERT_TRUE(border);
    Start start{.at = Start::At::automatic, .seam = Angle{}};
    const auto cut = directed(*track(path), Direction::as_given, start);
    ASSERT_TRUE(cut);
    const Lead lead{.radius = w.corner * dice.uniform(0.8, 2.0),
                    .overcut = dice.uniform(0.0, 0.5 * std::max(w.along, w.round) + w.corner)};
    const auto with = clear_lead(*border, *cut, lead, 0.1);
    ++(with ? clear : refused);
    if (!with) continue;
    const double sag = sag_of(w, chords);
    for (std::size_t k = 0; k < with->points.size(); ++k) {
      if (k >= with->cut_first && k <= with->cut_last) continue;
      const auto& p = with->points[k];
      EXPECT_LT(w.beyond(kRadius * p.phi, p.z), kLeadTouch + 1.3 * sag + 0.002) << i;
    }
  }
  EXPECT_GT(clear, 1000);
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace tubecut::motion::testing
