#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/joint/contour.hpp"
#include "tests/core/joint/random_nodes.hpp"

namespace tubecut::joint {
namespace {

constexpr std::uint64_t kSeed = 20260101;
constexpr int kRayNodes = 220;
constexpr int kRayPhases = 4000;
constexpr int kDenseNodes = 400;
constexpr int kDensePhases = 40'000;
constexpr double kTie = 1e-8;  // mm; nearer heights have no winner

double phase_distance(double a, double b) {
  const double d = std::abs(a - b);
  return std::min(d, kTwoPi - d);
}

bool near_event(const Contour& contour, double phi, double distance) {
  return std::ranges::any_of(contour.events, [&](const Event& event) {
    return phase_distance(event.phi, phi) < distance;
  });
}

/// Just before an event its `from` is the highest, just after it its `to`, in the oracle's eyes.
void expect_event(const RandomNode& node, const Contour& contour, const Event& event) {
  double reach = 1e-4;
  for (const auto& other : contour.events)
    if (&other != &event) reach = std::min(reach, 0.5 * phase_distance(other.phi, event.phi));
  if (reach < 1e-9) return;  // two events at one point cannot be separated
  const auto before = ray::highest(node.bodies, node.rho, event.phi - reach);
  const auto after = ray::highest(node.bodies, node.rho, event.phi + reach);
  ASSERT_TRUE(before && after);
  if (before->lead > 1e-9L) {
    EXPECT_EQ(before->body, event.from) << event.phi;
  }
  if (after->lead > 1e-9L) {
    EXPECT_EQ(after->body, event.to) << event.phi;
  }
  if (event.kind == EventKind::junction) {
    EXPECT_NE(event.from, event.to);
    EXPECT_NEAR(event.z_from, event.z_to, 1e-9);
  }
}

void expect_open(const RandomNode& node, const Error& error) {
  ASSERT_EQ(error.code(), ErrorCode::open_profile);
  const auto& open = std::get<Intervals>(error.issues.front().got);
  ASSERT_FALSE(open.empty());
  for (int k = 0; k < kRayPhases; ++k) {
    const double phi = 360.0 * k / kRayPhases;
    bool border = false;
    const bool said = std::ranges::any_of(open, [&](const auto& interval) {
      bool in = false;
      for (const double turn : {0.0, 360.0}) {
        in = in || (phi + turn > interval.first && phi + turn < interval.second);
        border = border || std::abs(phi + turn - interval.first) < 1e-8 ||
                 std::abs(phi + turn - interval.second) < 1e-8;
      }
      return in;
    });
    const bool missed = !ray::highest(node.bodies, node.rho, phi * kRadPerDeg);
    EXPECT_TRUE(border || said == missed) << phi;
  }
}

TEST(RayCaster, AgreesOnHeightPartnerAndEvents) {
  std::mt19937_64 random(kSeed);
  RecordProperty("seed", std::to_string(kSeed));
  std::cout << "seed " << kSeed << '\n';
  int closed = 0;
  int changes = 0;
  double worst = 0.0;
  for (int n = 0; n < kRayNodes; ++n) {
    const auto node = random_node(random, n % 5 != 0, n % 3 == 0, n % 2 == 0);
    const auto contour = trace(node.cutters, node.rho);
    if (!contour) {
      expect_open(node, contour.error());
      continue;
    }
    ++closed;
    std::size_t last = 0;
    for (int k = 0; k < kRayPhases; ++k) {
      const double phi = kTwoPi * k / kRayPhases;
      const auto want = ray::highest(node.bodies, node.rho, phi);
      ASSERT_TRUE(want) << n;
      if (near_event(*contour, phi, 1e-9)) continue;
      const auto got = contact_at(*contour, phi);
      if (!near_event(*contour, phi, 1e-5)) {
        const double off = static_cast<double>(std::abs(got.z - want->z));
        worst = std::max(worst, off);
        EXPECT_LT(off, 1e-10 + 1e-13 * std::abs(got.z)) << n << " at " << phi;
      }
      EXPECT_TRUE(got.cutter == want->body || want->lead < kTie) << n << " at " << phi;
      EXPECT_EQ(segment_at(*contour, phi).cutter, got.cutter) << n << " at " << phi;
      if (k > 0 && want->body != last) ++changes;
      last = want->body;
    }
    for (const auto& event : contour->events) expect_event(node, *contour, event);
  }
  std::cout << closed << " closed, " << changes << " changes, worst height " << worst << " mm\n";
  EXPECT_GE(closed, 200);
  EXPECT_GT(changes, kRayNodes);
}

/// Where a generator leaves a body, by the quadratic in space and in double: fast, for dense scans.
struct FastBody {
  explicit FastBody(const ray::Body& b) {
    for (std::size_t i = 0; i < 3; ++i) {
      q[i] = static_cast<double>(b.point[i]);
      d[i] = static_cast<double>(b.direction[i]);
    }
    r2 = static_cast<double>(b.radius * b.radius);
  }
  double top(double x, double y) const {
    const double px = x - q[0];
    const double py = y - q[1];
    const double pz = -q[2];
    const double along = px * d[0] + py * d[1] + pz * d[2];
    const double a = 1.0 - d[2] * d[2];
    const double b = pz - along * d[2];
    const double c = px * px + py * py + pz * pz - along * along - r2;
    const double root = b * b - a * c;
    return root < 0.0 ? -std::numeric_limits<double>::infinity() : (std::sqrt(root) - b) / a;
  }
  std::array<double, 3> q{}, d{};
  double r2 = 0.0;
};

TEST(Events, NoneMissedNoneExtraOnDenseScans) {
  std::mt19937_64 random(kSeed + 1);
  std::cout << "seed " << kSeed + 1 << '\n';
  std::vector<std::array<double, 2>> circle(kDensePhases);
  for (int k = 0; k < kDensePhases; ++k) {
    const double phi = kTwoPi * (k + 0.37) / kDensePhases;
    circle[static_cast<std::size_t>(k)] = {std::cos(phi), std::sin(phi)};
  }
  int changes = 0;
  int missed = 0;
  int extra = 0;
  int labels = 0;
  for (int n = 0; n < kDenseNodes; ++n) {
    const auto node = random_node(random, true, n % 3 == 0, false);
    const auto contour = trace(node.cutters, node.rho);
    ASSERT_TRUE(contour);
    std::vector<FastBody> bodies;
    for (const auto& body : node.bodies) bodies.emplace_back(body);
    std::size_t last = contour->segments.back().cutter;
    for (int k = 0; k < kDensePhases; ++k) {
      const double phi = kTwoPi * (k + 0.37) / kDensePhases;
      const auto& [c, s] = circle[static_cast<std::size_t>(k)];
      std::size_t best = 0;
      double z = -std::numeric_limits<double>::infinity();
      double second = -std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        const double top = bodies[i].top(node.rho * c, node.rho * s);
        if (top > z) {
          second = z;
          z = top;
          best = i;
        } else {
          second = std::max(second, top);
        }
      }
      const auto said = segment_at(*contour, phi).cutter;
      const bool tie = z - second < kTie;
      if (best != said && !tie && !near_event(*contour, phi, 1e-10)) ++labels;
      const auto now = tie ? said : best;
      if (now != last) {
        ++changes;
        const double step = kTwoPi / kDensePhases;
        missed += near_event(*contour, phi - 0.5 * step, 0.5 * step + 1e-9) ? 0 : 1;
      }
      last = now;
    }
    for (const auto& event : contour->events) {
      if (event.kind == EventKind::kink) continue;
      extra += event.from == event.to ? 1 : 0;
      expect_event(node, *contour, event);
    }
  }
  std::cout << changes << " changes, " << missed << " missed, " << extra << " extra, " << labels
            << " wrong labels\n";
  EXPECT_GT(changes, 2 * kDenseNodes);
  EXPECT_EQ(missed, 0);
  EXPECT_EQ(extra, 0);
  EXPECT_EQ(labels, 0);
}

}  // namespace
}  // namespace tubecut::joint
