#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "api/formats/drawing/chart.hpp"
#include "tests/support/call.hpp"

namespace tubecut::testing {
namespace {

constexpr double kPrinted = 0.011;  // px, to which coordinates are printed
constexpr int kColumns = 960;       // px

struct Dot {
  double x = 0.0, y = 0.0;
};

/// The points of the curves of a drawing, one list a curve.
std::vector<std::vector<Dot>> drawn(const std::string& svg) {
  std::vector<std::vector<Dot>> out;
  const std::string key = " points=\"";
  for (auto at = svg.find(key); at != svg.npos; at = svg.find(key, at)) {
    at += key.size();
    const char* text = svg.c_str() + at;
    auto& list = out.emplace_back();
    for (char* end = nullptr; *text != '"'; text = end + 1) {
      const double x = std::strtod(text, &end);
      list.push_back({x, std::strtod(end + 1, &end)});
    }
  }
  return out;
}

/// Range of a pixel column that a line covers.
struct Covered {
  double low = 1e9, high = -1e9;
  void add(double y) {
    low = std::min(low, y);
    high = std::max(high, y);
  }
};

/// By each column, widened by `margin` px on both sides.
std::vector<Covered> covered(const std::vector<Dot>& line, double margin) {
  std::vector<Covered> out(kColumns);
  for (std::size_t i = 1; i < line.size(); ++i) {
    const auto [a, b] = std::minmax(line[i - 1], line[i], [](Dot p, Dot q) { return p.x < q.x; });
    const auto y = [a = a, b = b](double x) {
      return b.x > a.x ? a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x) : a.y;
    };
    for (int c = static_cast<int>(a.x - margin); c <= static_cast<int>(b.x + margin); ++c) {
      const double from = std::max(a.x, c - margin), to = std::min(b.x, c + 1.0 + margin);
      if (from > to) continue;
      auto& column = out.at(static_cast<std::size_t>(c));
      if (a.x == b.x) column.add(a.y), column.add(b.y);
      column.add(y(from));
      column.add(y(to));
    }
  }
  return out;
}

/// The farthest that `a` reaches beyond `b` in any column, px. A point at a column's edge may be
/// printed beyond it.
double beyond(const std::vector<Dot>& a, const std::vector<Dot>& b) {
  const auto narrow = covered(a, 0.0), wide = covered(b, kPrinted);
  double worst = 0.0;
  for (std::size_t c = 0; c < narrow.size(); ++c)
    if (narrow[c].low <= narrow[c].high)
      worst = std::max({worst, wide[c].low - narrow[c].low, narrow[c].high - wide[c].high});
  return worst;
}

std::string chart(std::vector<double> x, std::vector<double> y) {
  return api::print_charts({{.title = "t",
                             .x_label = "x",
                             .y_label = "y",
                             .series = {{.name = "s", .x = std::move(x), .y = std::move(y)}}}},
                           {});
}

/// The points where the chart's own scale puts them: found by a line between its extremes, whose
/// two points are always drawn.
std::vector<Dot> placed(const std::vector<double>& x, const std::vector<double>& y) {
  const auto [x0, x1] = std::ranges::minmax(x);
  const auto [y0, y1] = std::ranges::minmax(y);
  const auto two = drawn(chart({x0, x1}, {y0, y1})).at(0);
  std::vector<Dot> out;
  for (std::size_t i = 0; i < x.size(); ++i)
    out.push_back({two[0].x + (two[1].x - two[0].x) * (x[i] - x0) / (x1 - x0),
                   two[0].y + (two[1].y - two[0].y) * (y[i] - y0) / (y1 - y0)});
  return out;
}

/// Curves of all kinds: even, uneven, noisy, with lonely peaks, and one that turns back in x.
std::pair<std::vector<double>, std::vector<double>> curve(int kind, std::size_t n,
                                                          std::mt19937& random) {
  std::uniform_real_distribution<double> noise(-1.0, 1.0);
  std::vector<double> x, y;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(n - 1);
    x.push_back(kind == 1 ? t * t : kind == 3 ? std::cos(6.3 * t) : 40.0 * t);
    y.push_back(kind == 3   ? std::sin(6.3 * t)
                : kind == 2 ? (noise(random) > 0.9999 ? 90.0 : 0.1 * t)
                            : std::sin(50.0 * t) + 0.2 * noise(random));
  }
  return {x, y};
}

TEST(Charts, EqualTheDrawingOfAllPointsToAPixel) {
  std::mt19937 random(7);
  for (int kind = 0; kind < 4; ++kind)
    for (const std::size_t n : {2U, 50U, 900U, 5'000U, 120'000U}) {
      const auto [x, y] = curve(kind, n, random);
      const auto svg = chart(x, y);
      const auto shown = drawn(svg).at(0);
      EXPECT_LE(shown.size(), 8U * kColumns) << kind << ", " << n;  // each column twice in a loop
      const auto all = placed(x, y);
      EXPECT_LE(beyond(all, shown), 1.0) << kind << ", " << n;
      EXPECT_LE(beyond(shown, all), 1.0) << kind << ", " << n;
    }
}

TEST(Charts, KeepEveryPointOfACurveWithFewerPointsThanPixels) {
  std::vector<double> x, y;
  for (int i = 0; i < 400; ++i) {
    x.push_back(i);
    y.push_back(std::sin(0.1 * i));
  }
  const auto all = placed(x, y), shown = drawn(chart(x, y)).at(0);
  ASSERT_EQ(shown.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_NEAR(shown[i].x, all[i].x, kPrinted) << i;
    EXPECT_NEAR(shown[i].y, all[i].y, kPrinted) << i;
  }
}

TEST(Charts, OfManySamplesAreNoLongerThanTheirPixels) {
  auto body = example("feed-curves/cut-off-194-mm-whole-cycle.json");
  body = with(std::move(body), "cycle/period_s", api::Json{2e-5});
  const auto path = "/v1/feed-curves";
  const auto csv = post(path, api::dump(body), "format=csv&view=samples");
  ASSERT_FALSE(csv.outcome.error) << csv.outcome.body;
  EXPECT_GT(csv.outcome.body.size(), 4U << 20);
  const auto svg = post(path, api::dump(body), "format=svg");
  ASSERT_FALSE(svg.outcome.error) << svg.outcome.body;
  EXPECT_LT(svg.outcome.body.size(), 256U << 10);
}

}  // namespace
}  // namespace tubecut::testing
