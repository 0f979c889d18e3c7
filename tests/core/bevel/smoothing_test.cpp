#include "core/bevel/smoothing/smoothing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "core/base/angle.hpp"
#include "tests/support/cancelled.hpp"
#include "tests/support/golden.hpp"

namespace tubecut::bevel {
namespace {

using testing::at;
using testing::golden;
using testing::number;
using testing::numbers;

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (auto& value : values) value *= factor;
  return values;
}

/// A golden row on its grid of phases: s = rho * phi.
AngleProfile on_grid(const std::vector<double>& b_deg, double rho) {
  AngleProfile out{.s = {}, .b = scaled(b_deg, kRadPerDeg), .period = kTwoPi * rho};
  for (std::size_t i = 0; i < b_deg.size(); ++i)
    out.s.push_back(rho * kTwoPi * static_cast<double>(i) / static_cast<double>(b_deg.size()));
  return out;
}

double largest_difference(const std::vector<double>& rad, const std::vector<double>& deg) {
  EXPECT_EQ(rad.size(), deg.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < deg.size(); ++i)
    worst = std::max(worst, std::abs(rad[i] * kDegPerRad - deg[i]));
  return worst;
}

constexpr BevelRateLimits kLimits{5.0 * kRadPerDeg, 1.0 * kRadPerDeg};

const api::Json& corpus() {
  static const api::Json file = golden("intersections-and-bevels.json");
  return file;
}

struct Row {
  std::string block;
  std::string kind;
  std::string b;
  double rho = 0.0;
};

void PrintTo(const Row& row, std::ostream* out) { *out << row.block << " " << row.kind; }

std::vector<Row> rows() {
  std::vector<Row> all;
  for (const auto& block : {std::string("seed000_table1_r35"), std::string("seed000_table1_r30")}) {
    const double rho = number(corpus(), block + "/rho");
    all.push_back({block, "literal", "literal/B", rho});
    all.push_back({block, "corrected", "B", rho});
  }
  return all;
}

class Golden : public ::testing::TestWithParam<Row> {
 protected:
  const api::Json& smoothed() const {
    return at(corpus(), GetParam().block + "/smoothed/" + GetParam().kind);
  }
  AngleProfile profile() const {
    return on_grid(numbers(corpus(), GetParam().block + "/" + GetParam().b), GetParam().rho);
  }
};

TEST_P(Golden, EnvelopeWithoutRefinement) {
  const auto out = envelope(profile(), {.limits = kLimits, .refine = false});
  ASSERT_TRUE(out);
  const double worst = largest_difference(out->b, numbers(smoothed(), "envelope_K5_A1_norefine"));
  EXPECT_LT(worst, 1e-9);
  RecordProperty("worst_deg", std::to_string(worst));
}

TEST_P(Golden, RefinedEnvelopeHoldsAndIsAsSmall) {
  const auto input = profile();
  const auto out = envelope(input, {.limits = kLimits});
  ASSERT_TRUE(out);
  const double area = area_above(input, out->b) * kDegPerRad;
  const double reference = number(smoothed(), "metrics_envelope/area");
  EXPECT_LE(area, reference);
  for (std::size_t i = 0; i < out->b.size(); ++i) EXPECT_GE(out->b[i], input.b[i]) << i;
  const auto steep = steepness({input.s, out->b, input.period});
  EXPECT_LE(steep.slope, kLimits.slope * (1.0 + 1e-9));
  EXPECT_LE(steep.second, kLimits.curvature * (1.0 + 1e-6));
}

TEST_P(Golden, HermiteRowsAndWindows) {
  const auto out = hermite(profile(), {.limit = 10.0 * kRadPerDeg, .transition = 15});
  ASSERT_TRUE(out);
  const double worst = largest_difference(out->b, numbers(smoothed(), "hermite_T15_thr10"));
  EXPECT_LT(worst, 1e-12);
  const auto* windows = at(smoothed(), "hermite_windows").as<api::Json::Array>();
  ASSERT_NE(windows, nullptr);
  ASSERT_EQ(out->windows.size(), windows->size());
  for (std::size_t w = 0; w < windows->size(); ++w) {
    const auto& got = out->windows[w];
    EXPECT_EQ(static_cast<double>(got.index), number((*windows)[w], "0"));
    EXPECT_NEAR(got.step * kDegPerRad, number((*windows)[w], "1"), 1e-9);
    EXPECT_EQ(got.kept, got.step < 0.0 ? HermiteWindow::Kept::before : HermiteWindow::Kept::after);
    EXPECT_EQ((got.to + 360 - got.from) % 360, 15U);
    EXPECT_EQ(got.kept == HermiteWindow::Kept::before ? got.from : got.to,
              got.kept == HermiteWindow::Kept::before ? got.index : (got.index + 1) % 360);
  }
}

TEST_P(Golden, MetricsOfTheGoldenRows) {
  const auto input = profile();
  for (const auto& [row, metrics] :
       {std::pair{"envelope_K5_A1", "metrics_envelope"},
        std::pair{"envelope_K5_A1_norefine", "metrics_envelope_norefine"},
        std::pair{"hermite_T15_thr10", "metrics_hermite"}}) {
    const auto smooth = scaled(numbers(smoothed(), row), kRadPerDeg);
    const auto steep = steepness({input.s, smooth, input.period});
    const auto path = std::string(metrics) + "/";
    EXPECT_NEAR(steep.slope * kDegPerRad, number(smoothed(), path + "max_slope"), 1e-11) << row;
    EXPECT_NEAR(steep.second * kDegPerRad, number(smoothed(), path + "max_second"), 1e-10) << row;
    EXPECT_NEAR(area_above(input, smooth) * kDegPerRad, number(smoothed(), path + "area"), 1e-9)
        << row;
  }
}

INSTANTIATE_TEST_SUITE_P(Table1, Golden, ::testing::ValuesIn(rows()), [](const auto& row) {
  return row.param.block.substr(15) + "_" + row.param.kind;
});

TEST(GoldenWall, FloorWithoutRefinement) {
  const auto& wall = at(corpus(), "seed000_table1_wall");
  const auto input = on_grid(numbers(wall, "floor"), number(wall, "r_in"));
  const auto plain = envelope(input, {.limits = kLimits, .refine = false});
  ASSERT_TRUE(plain);
  EXPECT_LT(largest_difference(plain->b, numbers(wall, "floor_smoothed_K5_A1_norefine")), 1e-9);
  EXPECT_NEAR(area_above(input, plain->b) * kDegPerRad, 483.373, 1e-3);
  const auto refined = envelope(input, {.limits = kLimits});
  ASSERT_TRUE(refined);
  EXPECT_NEAR(area_above(input, refined->b) * kDegPerRad, 401.638260, 1e-6);  // docs/theory, 6.3
  EXPECT_NEAR(*std::ranges::max_element(refined->b) * kDegPerRad, 72.59, 0.005);
}

TEST(GoldenWall, MutationsAndLargestStep) {
  const auto& wall = at(corpus(), "seed000_table1_wall");
  const auto input = on_grid(numbers(wall, "floor"), number(wall, "r_in"));
  const auto steps = mutations(input.b, 10.0 * kRadPerDeg);
  const std::vector<std::pair<std::size_t, double>> expected{
      {8, -44.259}, {222, 18.075}, {258, -12.458}, {327, 29.668}};
  ASSERT_EQ(steps.size(), expected.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    EXPECT_EQ(steps[i].index, expected[i].first);
    EXPECT_NEAR(steps[i].step * kDegPerRad, expected[i].second, 5e-4);
  }
  const auto smooth = envelope(input, {.limits = kLimits});
  ASSERT_TRUE(smooth);
  const auto left = mutations(smooth->b, 2.617 * kRadPerDeg);
  ASSERT_FALSE(left.empty());
  for (const auto& step : left)
    EXPECT_NEAR(std::abs(step.step) * kDegPerRad, 5.0 * 30.0 * kRadPerDeg, 1e-9);
}

AngleProfile uniform(std::vector<double> b, double spacing = 1.0) {
  AngleProfile out{.s = {}, .b = std::move(b), .period = 0.0};
  out.period = spacing * static_cast<double>(out.b.size());
  for (std::size_t i = 0; i < out.b.size(); ++i) out.s.push_back(spacing * static_cast<double>(i));
  return out;
}

std::vector<double> plateau(std::size_t n, std::size_t from, std::size_t to, double height) {
  std::vector<double> b(n, 0.0);
  for (std::size_t i = from; i <= to; ++i) b[i] = height;
  return b;
}

TEST(Mutations, CyclicAscendingAndStrict) {
  const std::vector<double> b{0.5, 0.0, 0.0, 0.25, 0.0};
  const auto found = mutations(b, 0.25);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].index, 0U);
  EXPECT_EQ(found[0].step, -0.5);
  EXPECT_EQ(found[1].index, 4U);
  EXPECT_EQ(found[1].step, 0.5);
  EXPECT_TRUE(mutations(std::vector<double>(8, 1.0), 0.1).empty());
}

TEST(Steepness, OfAParabolaWithUnequalSteps) {
  // b = s^2 on 0..2, back in one chord: second differences 2 inside, the corners known by hand.
  const AngleProfile profile{
      .s = {0.0, 0.5, 0.75, 2.0}, .b = {0.0, 0.25, 0.5625, 4.0}, .period = 4.0};
  const auto got = steepness(profile);
  EXPECT_DOUBLE_EQ(got.slope, 2.75);
  EXPECT_DOUBLE_EQ(got.second, (2.75 + 2.0) / 1.625);
}

TEST(BevelRateLimits, FollowSpeedAndUse) {
  const auto limits = bevel_rate_limits(2.0, 8.0, 4.0, 0.5);
  ASSERT_TRUE(limits);
  EXPECT_DOUBLE_EQ(limits->slope, 0.25);
  EXPECT_DOUBLE_EQ(limits->curvature, 0.25);
  // Cutting along a curve at both limits uses the axis exactly: speed * slope and speed^2 *
  // curvature.
  EXPECT_DOUBLE_EQ(limits->slope * 4.0, 0.5 * 2.0);
  EXPECT_DOUBLE_EQ(limits->curvature * 16.0, 0.5 * 8.0);
}

TEST(BevelRateLimits, Refusals) {
  EXPECT_EQ(bevel_rate_limits(0.0, 1.0, 1.0, 1.0).error().code(), ErrorCode::zero_limit);
  EXPECT_EQ(bevel_rate_limits(1.0, -1.0, 1.0, 1.0).error().code(), ErrorCode::zero_limit);
  EXPECT_EQ(bevel_rate_limits(1.0, 1.0, 0.0, 1.0).error().code(), ErrorCode::out_of_range);
  EXPECT_EQ(bevel_rate_limits(1.0, 1.0, 1.0, 1.01).error().code(), ErrorCode::out_of_range);
  EXPECT_EQ(bevel_rate_limits(1.0, 1.0, 1.0, std::nan("")).error().code(), ErrorCode::out_of_range);
}

TEST(Hermite, SmoothstepOfOneStep) {
  const auto profile = uniform(plateau(80, 0, 39, 1.0), 0.5);
  const auto out = hermite(profile, {.limit = 0.2, .transition = 10});
  ASSERT_TRUE(out);
  ASSERT_EQ(out->windows.size(), 2U);
  for (int l = 0; l <= 10; ++l) {
    const double x = l / 10.0;
    const double fall = 1.0 - x * x * (3.0 - 2.0 * x);  // flat at both ends
    EXPECT_NEAR(out->b[static_cast<std::size_t>(39 + l)], fall, 1e-15);
    EXPECT_NEAR(out->b[static_cast<std::size_t>((80 - l) % 80)], fall, 1e-15);
  }
  EXPECT_EQ(out->windows[0].index, 39U);  // equal steps: the first
  EXPECT_EQ(out->windows[1].from, 70U);
  EXPECT_EQ(out->windows[1].to, 0U);
}

TEST(Hermite, EndSlopesAreThePublishedOneSidedOnes) {
  auto b = plateau(80, 20, 39, 1.0);
  b[20] = 0.9;  // the step at 39 is then the largest
  b[38] = 0.97;
  b[50] = 0.02;
  const auto out = hermite(uniform(b, 0.5), {.limit = 0.5, .transition = 10});
  ASSERT_TRUE(out);
  const auto& window = out->windows.front();
  EXPECT_EQ(window.index, 39U);
  EXPECT_NEAR(window.slope_start, (1.0 - 0.97) / 0.5, 1e-12);
  EXPECT_NEAR(window.slope_end, 0.02 / 0.5, 1e-12);
}

TEST(Hermite, AutoIsTheSmallestThatFits) {
  const auto profile = uniform(plateau(120, 0, 59, 1.0));
  const auto out = hermite(profile, {.limit = 0.13, .transition = {}});  // 1.5 / 0.13 = 11.54
  ASSERT_TRUE(out);
  for (const auto& window : out->windows) EXPECT_EQ((window.to + 120 - window.from) % 120, 12U);
  EXPECT_TRUE(mutations(out->b, 0.13).empty());
  EXPECT_LE(1.5 / 12.0, 0.13);
}

TEST(Hermite, AutoStaysWithinHalfTheGap) {
  const auto profile = uniform(plateau(120, 0, 99, 1.0));  // 20 samples lie low, half the gap is 10
  EXPECT_TRUE(hermite(profile, {.limit = 0.15, .transition = {}}));
  const auto refused = hermite(profile, {.limit = 0.149, .transition = {}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code(), ErrorCode::transition_too_long);
  EXPECT_EQ(std::get<double>(refused.error().issues[0].got), 11.0);
  EXPECT_EQ(std::get<double>(refused.error().issues[0].limit), 10.0);
  // A junction with a step below the limit counts as well, when it is named.
  const auto named =
      hermite(profile, {.limit = 0.15, .transition = {}, .junctions = {99, 112, 119}});
  ASSERT_FALSE(named);
  EXPECT_EQ(named.error().code(), ErrorCode::transition_too_long);
}

TEST(Hermite, SpecCaseThatDoesNotConverge) {
  const auto input = on_grid(numbers(corpus(), "seed000_table1_r35/B"), 35.0);
  const auto out = hermite(input, {.limit = 3.0 * kRadPerDeg, .transition = 15});
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().code(), ErrorCode::smoothing_not_converged);
  EXPECT_GT(std::get<double>(out.error().issues[0].got), 3.0);
}

TEST(Hermite, SpecCaseBelowItsInput) {
  const auto worst_below = [](const std::string& path, double rho) {
    const auto input = on_grid(numbers(corpus(), path), rho);
    const auto out = hermite(input, {.limit = 3.0 * kRadPerDeg, .transition = 25});
    EXPECT_TRUE(out);
    double worst = 0.0;
    for (std::size_t i = 0; i < input.b.size(); ++i)
      worst = std::max(worst, input.b[i] - out->b[i]);
    return worst * kDegPerRad;
  };
  EXPECT_NEAR(worst_below("seed000_table1_r35/B", 35.0), 3.27, 0.005);
  EXPECT_NEAR(worst_below("seed000_table1_wall/floor", 30.0), 7.94, 0.005);
}

TEST(Hermite, Refusals) {
  const auto profile = uniform(plateau(80, 0, 39, 1.0));
  const auto code = [](const AngleProfile& p, const HermiteSpec& spec) {
    return hermite(p, spec).error().code();
  };
  EXPECT_EQ(code(profile, {.limit = 0.1, .transition = 1}), ErrorCode::out_of_range);
  EXPECT_EQ(code(profile, {.limit = 0.1, .transition = 21}), ErrorCode::out_of_range);
  EXPECT_EQ(code(profile, {.limit = 0.1, .transition = -5}), ErrorCode::out_of_range);
  EXPECT_EQ(code(profile, {.limit = 0.0, .transition = 10}), ErrorCode::out_of_range);
  EXPECT_EQ(code(profile, {.limit = 0.1, .transition = {}, .junctions = {80}}),
            ErrorCode::out_of_range);
  EXPECT_EQ(code(profile, {.limit = 0.1, .transition = {}, .junctions = {9, 9}}),
            ErrorCode::out_of_range);
  auto uneven = profile;
  uneven.s[7] += 0.01;
  EXPECT_EQ(code(uneven, {.limit = 0.1, .transition = 10}), ErrorCode::sampling_not_uniform);
  EXPECT_TRUE(hermite(profile, {.limit = 0.3, .transition = 20}));
  const CancelledScope cancelled;
  EXPECT_EQ(hermite(profile, {.limit = 0.1, .transition = 10}).error().code(),
            ErrorCode::cancelled);
}

TEST(Envelope, Refusals) {
  const auto profile = uniform(plateau(80, 0, 39, 1.0));
  const BevelRateLimits limits{0.1, 0.1};
  const auto code = [](const AngleProfile& p, const EnvelopeSpec& spec) {
    return envelope(p, spec).error().code();
  };
  auto bad = profile;
  bad.b.pop_back();
  EXPECT_EQ(code(bad, {.limits = limits}), ErrorCode::wrong_count);
  EXPECT_EQ(code(uniform({1.0, 2.0}), {.limits = limits}), ErrorCode::wrong_count);
  bad = profile;
  bad.b[3] = std::nan("");
  EXPECT_EQ(code(bad, {.limits = limits}), ErrorCode::not_finite);
  bad = profile;
  bad.s[3] = bad.s[2];
  EXPECT_EQ(code(bad, {.limits = limits}), ErrorCode::out_of_range);
  bad = profile;
  bad.period = bad.s.back();
  EXPECT_EQ(code(bad, {.limits = limits}), ErrorCode::out_of_range);
  EXPECT_EQ(code(profile, {.limits = {0.0, 0.1}}), ErrorCode::out_of_range);
  EXPECT_EQ(code(profile, {.limits = {0.1, std::nan("")}}), ErrorCode::out_of_range);
  EXPECT_EQ(code(profile, {.limits = limits, .highest = 0.99}), ErrorCode::out_of_range);
  const CancelledScope cancelled;
  EXPECT_EQ(envelope(profile, {.limits = limits}).error().code(), ErrorCode::cancelled);
}

}  // namespace
}  // namespace tubecut::bevel
