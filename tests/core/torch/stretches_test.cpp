#include "core/torch/stretches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/torch/torch_program.hpp"
#include "tests/support/drawings.hpp"

namespace tubecut::torch {
namespace {

constexpr double kRadius = 57.0, kWall = 5.0, kKerf = 2.0;

TorchCut ring(double sway, double bevel, int waves, double shift) {
  TorchCut out{.path = {.outer_radius = kRadius, .wall = kWall, .scrap = motion::Scrap::minus_z},
               .kerf = kKerf};
  for (int i = 0; i < 360; ++i) {
    const double phi = kTwoPi * i / 360;
    out.path.phi.push_back(phi);
    out.path.z.push_back(sway * std::cos(waves * phi));
    out.path.b.push_back(bevel * std::cos(waves * phi + shift));
  }
  return out;
}

TorchCut hole(double radius, double bevel) {
  TorchCut out{.path = {.outer_radius = kRadius, .wall = kWall, .scrap = motion::Scrap::inside},
               .kerf = kKerf};
  for (int i = 0; i <= 180; ++i) {
    const double t = kTwoPi * (i % 180) / 180;
    out.path.phi.push_back(1.0 + radius / kRadius * std::cos(t));
    out.path.z.push_back(radius * std::sin(t));
    out.path.b.push_back(bevel * std::sin(t));
  }
  return out;
}

Setup setup(int count, double width, std::optional<double> lead) {
  Setup out{.tabs = Tabs{.count = count, .width = width}};
  if (lead) out.lead = motion::Lead{.radius = *lead};
  return out;
}

std::vector<ProgramCut> laid(const TorchCut& cut, const Setup& s) {
  auto out = program_cut(cut, s, true);
  EXPECT_TRUE(out) << out.error().issues.front().member << " " << out.error().issues.front().hint;
  return out ? *std::move(out) : std::vector<ProgramCut>{};
}

/// Where a beam is on the wall of radius rho: round it, and along.
struct At {
  double s, z;
};
At at(const motion::CutPoint& p, double rho) {
  return {rho * p.phi, p.z - (kRadius - rho) * std::tan(p.b)};
}

/// Points along a path, spaced at most 0.05 mm.
std::vector<motion::CutPoint> dense(const std::vector<motion::CutPoint>& way) {
  std::vector<motion::CutPoint> out;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const auto &a = way[i - 1], &b = way[i];
    const double length = std::hypot(kRadius * (b.phi - a.phi), b.z - a.z);
    const int n = std::max(1, static_cast<int>(std::ceil(length / 0.05)));
    for (int k = 0; k < n; ++k) {
      const double u = static_cast<double>(k) / n;
      out.push_back({a.phi + u * (b.phi - a.phi), a.z + u * (b.z - a.z), a.b + u * (b.b - a.b)});
    }
  }
  out.push_back(way.back());
  return out;
}

/// Metal between two ways by brute force: every place of one to every place of the other, as points
/// in space, on both walls.
double metal(const std::vector<motion::CutPoint>& one, const std::vector<motion::CutPoint>& other) {
  double least = 1e300;
  const auto from = dense(one), to = dense(other);
  for (const double rho : {kRadius, kRadius - kWall})
    for (const auto& p : from) {
      const At a = at(p, rho);
      for (const auto& q : to) {
        const At b = at(q, rho);
        const double turned = std::remainder(a.s - b.s, kTwoPi * rho);
        if (std::abs(turned) < least) least = std::min(least, std::hypot(turned, a.z - b.z));
      }
    }
  return least - kKerf;
}

/// Of the last places of one and the first of the next.
double metal_at(const ProgramCut& before, const ProgramCut& after) {
  const auto &one = before.way.points.points, &other = after.way.points.points;
  const auto first = static_cast<std::ptrdiff_t>(before.way.points.cut_first);
  const auto last = std::max<std::ptrdiff_t>(first, std::ssize(one) - 60);
  return metal({one.begin() + last, one.end()},
               {other.begin(), other.begin() + std::min<std::ptrdiff_t>(std::ssize(other), 60)});
}

double length(const ProgramCut& cut) {
  double out = 0.0;
  const auto& points = cut.way.points;
  for (auto i = points.cut_first + 1; i <= points.cut_last; ++i) {
    const auto &a = points.points[i - 1], &b = points.points[i];
    out += std::hypot(kRadius * (b.phi - a.phi), b.z - a.z);
  }
  return out;
}

// A square cut: the inner wall's chord is the tab and a kerf, and all else is cut.
TEST(Stretches, ASquareCutLeavesTheTabsOfItsInnerWall) {
  for (const int count : {1, 2, 3, 12}) {
    const auto cuts = laid(ring(0.0, 0.0, 1, 0.0), setup(count, 2.5, 4.0));
    ASSERT_EQ(cuts.size(), static_cast<std::size_t>(count));
    const double gap = (2.5 + kKerf) * kRadius / (kRadius - kWall);
    for (int k = 0; k < count; ++k) {
      EXPECT_NEAR(length(cuts[k]), kTwoPi * kRadius / count - gap, 1e-5) << count;
      EXPECT_NEAR(metal_at(cuts[k], cuts[(k + 1) % count]), 2.5, 1e-3);
      EXPECT_EQ(cuts[k].cut.name, std::to_string(k + 1) + " of " + std::to_string(count));
    }
  }
}

// For bevels that swing and contours that sway, with leads and without: by brute force no tab is
// narrower than requested, no tab is wider than a bevel's own difference of the walls explains, and
// the segments consist of the cut's own points.
TEST(Stretches, NoTabIsNarrowerThanRequestedOnEitherWall) {
  std::mt19937 draw(20261125);
  const auto of = [&](double from, double to) {
    return std::uniform_real_distribution(from, to)(draw);
  };
  int held = 0;
  const int cases = testing::drawings(12, 40);
  for (int i = 0; i < cases; ++i) {
    const bool opening = i % 4 == 3;
    const auto cut = opening ? hole(of(8.0, 30.0), of(0.0, 0.5))
                             : ring(of(0.0, 40.0), of(0.0, 0.9), 1 + i % 2, of(0.0, 6.0));
    const double width = of(0.5, 6.0);
    const int count = 1 + i % 4;
    auto asked = setup(count, width, i % 3 == 2 ? std::nullopt : std::optional(of(2.0, 6.0)));
    asked.tabs->of = Tabs::Of::all;
    const auto made = program_cut(cut, asked, true);
    if (!made) {
      EXPECT_TRUE(made.error().code() == ErrorCode::lead_blocked ||
                  made.error().issues.front().member == "tabs/count")
          << i;
      continue;
    }
    const auto& cuts = *made;
    ++held;
    ASSERT_EQ(cuts.size(), static_cast<std::size_t>(count)) << i;
    const auto border = torch_border(cut).value();
    for (int k = 0; k < count; ++k) {
      const auto& next = cuts[(k + 1) % count];
      const double left = metal_at(cuts[k], next);
      EXPECT_GT(left, width - 1e-4) << i << " " << k;
      const double told = metal_between(border, cut, *asked.tabs, cuts[k].way, next.way);
      EXPECT_NEAR(told, left, 2e-3) << i << " " << k;
      EXPECT_EQ(cuts[k].way.points.cut_last + 1, cuts[k].way.points.points.size());
    }
  }
  EXPECT_GT(held, 3 * cases / 4);
}

// Narrower by 0.1 mm if a segment is longer by that: the verification's own figure sees it.
TEST(Stretches, AnOverlongSegmentIsDetected) {
  const auto cut = ring(10.0, 0.4, 2, 0.7);
  const auto asked = setup(3, 2.0, 4.0);
  auto cuts = laid(cut, asked);
  ASSERT_EQ(cuts.size(), 3u);
  const auto border = torch_border(cut).value();
  const double before = metal_between(border, cut, *asked.tabs, cuts[0].way, cuts[1].way);
  EXPECT_NEAR(before, 2.0, 1e-6);
  auto& end = cuts[0].way.points.points;
  const auto &a = end[end.size() - 2], &b = end.back();
  const double step = std::hypot(kRadius * (b.phi - a.phi), b.z - a.z);
  auto on = b;
  on.phi += 0.1 / step * (b.phi - a.phi);
  on.z += 0.1 / step * (b.z - a.z);
  end.push_back(on);
  const double after = metal_between(border, cut, *asked.tabs, cuts[0].way, cuts[1].way);
  EXPECT_LT(after, 1.95);
}

// The way in is straight, across the cut, and as long as the lead.
TEST(Stretches, AreComeOntoSquare) {
  const auto cuts = laid(ring(10.0, 0.4, 2, 0.7), setup(4, 2.0, 4.0));
  for (const auto& cut : cuts) {
    const auto& points = cut.way.points.points;
    const auto first = cut.way.points.cut_first;
    ASSERT_GT(first, 0u);
    const auto &from = points.front(), &to = points[first], &on = points[first + 1];
    const At in{kRadius * (to.phi - from.phi), to.z - from.z};
    const At along{kRadius * (on.phi - to.phi), on.z - to.z};
    EXPECT_NEAR(std::hypot(in.s, in.z), 4.0, 1e-9);
    EXPECT_NEAR(in.s * along.s + in.z * along.z, 0.0, 1e-9);
    EXPECT_GT(in.z, 0.0);  // from the scrap, at lesser z
  }
}

TEST(Stretches, TabsKeepOffCorners) {
  auto cut = ring(10.0, 0.0, 2, 0.0);
  cut.path.corner.assign(cut.path.phi.size(), false);
  const std::size_t corner = 179;  // within half a mm of where the first of two tabs would end
  cut.path.corner[corner] = true;
  const double at = cut.path.phi[corner];
  auto asked = setup(2, 3.0, std::nullopt);
  const auto cuts = laid(cut, asked);
  ASSERT_EQ(cuts.size(), 2u);
  const double begins = cuts[0].last().phi, ends = cuts[1].first().phi;
  EXPECT_TRUE(at < begins - 1.0 / kRadius || at > ends + 1.0 / kRadius)
      << begins << " " << at << " " << ends;
  EXPECT_GT(ends, begins);
}

TEST(Stretches, AreRefusedWhereTheyDoNotFit) {
  auto asked = setup(12, 20.0, 4.0);
  const auto none = program_cut(ring(0.0, 0.0, 1, 0.0), asked, true);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code(), ErrorCode::out_of_range);
  EXPECT_EQ(none.error().issues.front().member, "tabs/count");
  auto published = ring(0.0, 0.1, 1, 0.0);
  published.counted_inward = true;
  EXPECT_FALSE(program_cut(published, setup(2, 2.0, std::nullopt), true));
}

TEST(Stretches, AreOfTheCutsThatAreAskedFor) {
  const auto end = ring(0.0, 0.0, 1, 0.0);
  const auto opening = hole(20.0, 0.0);
  auto mark = end;
  mark.mark = true;
  const auto has = [](Tabs::Of of, const TorchCut& cut, bool last) {
    return holds(Tabs{.of = of}, cut, last);
  };
  using enum Tabs::Of;
  EXPECT_TRUE(has(last, end, true));
  EXPECT_TRUE(has(last, opening, true));
  EXPECT_FALSE(has(last, end, false));
  EXPECT_TRUE(has(ends, end, false));
  EXPECT_FALSE(has(ends, opening, true));
  EXPECT_TRUE(has(holes, opening, false));
  EXPECT_FALSE(has(holes, end, true));
  EXPECT_TRUE(has(all, end, false) && has(all, opening, false));
  for (const auto of : {last, ends, holes, all}) EXPECT_FALSE(has(of, mark, true));
}

}  // namespace
}  // namespace tubecut::torch
