#include "core/groove/swept.hpp"

#include <gtest/gtest.h>

#include "core/groove/optimise.hpp"
#include "core/groove/periodic_spline.hpp"
#include "tests/core/groove/mill_cases.hpp"

namespace tubecut::groove {
namespace {

using namespace testing;

/// Increments at `count` optima, as smooth or broken lines over the turn.
struct Increments {
  std::vector<double> dz, db;
  double mean = 0.0;  // evaluations
  int most = 0;

  static Increments optima(const std::string& name, int count, Hold hold) {
    const Joint joint = joint_case(name);
    const Cone cone{mill_case(name)};
    const groove::Setup setup = setup_case(name);
    Increments out;
    for (int i = 0; i < count; ++i) {
      const Angle omega = Angle::rad(kTwoPi * i / count);
      const auto near = neighbourhood(joint, omega, GapCheck{});
      const Task task{*near, cone, setup,
                      initial_pose(joint, *section(joint, omega), mill_case(name), setup), hold};
      const auto best = chebyshev(task, Bias::centred, *gap(*near, cone, task.start));
      EXPECT_TRUE(best);
      out.dz.push_back(best->by.dz);
      out.db.push_back(best->by.db);
      out.mean += double(best->evaluations) / count;
      out.most = std::max(out.most, best->evaluations);
    }
    return out;
  }

  [[nodiscard]] Increment linear(double turn) const {
    const double at = turn * double(dz.size());
    const auto i = std::size_t(at) % dz.size(), j = (i + 1) % dz.size();
    const double t = at - std::floor(at);
    return {(1 - t) * dz[i] + t * dz[j], (1 - t) * db[i] + t * db[j]};
  }
};

template <class IncrementAt>
std::vector<Block> blocks(const std::string& name, int count, Hold hold, IncrementAt increment) {
  const Joint joint = joint_case(name);
  const groove::Setup setup = setup_case(name);
  std::vector<Block> out;
  for (int i = 0; i < count; ++i) {
    const Angle omega = Angle::rad(kTwoPi * i / count);
    const ToolPose start = initial_pose(joint, *section(joint, omega), mill_case(name), setup);
    const AxisPosition at =
        axis_position(moved(start, setup, hold, increment(double(i) / count)), setup, omega);
    out.push_back({omega.rad(), at.x, at.z, at.b.rad()});
  }
  return out;
}

class GoldenSwept : public ::testing::TestWithParam<const char*> {
 protected:
  const std::string name = GetParam();
  [[nodiscard]] Swept of(std::span<const Block> motion, Between between = Between::nothing,
                         SweptPoints points = {}) const {
    return *swept(joint_case(name), Cone{mill_case(name)}, setup_case(name), motion, between,
                  points, {});
  }
};
INSTANTIATE_TEST_SUITE_P(Cases, GoldenSwept, ::testing::ValuesIn(kCases));

/// The golden summary was sampled with rulings every 2 deg; the root face with the 180 optima alone
/// and 5 levels.
constexpr SweptPoints kGoldenFlank{.rulings = 180, .per_ruling = 11, .root_levels = 5};

void expect_summary(const Extreme& min, const Extreme& max, const api::Json& want) {
  const auto values = numbers(want);
  EXPECT_NEAR(min.value, values.at(0), 1e-8);
  EXPECT_NEAR(max.value, values.at(1), 1e-8);
}

TEST_P(GoldenSwept, SummaryOf1440PositionsFrom180Optima) {
  const api::Json& want = at(golden_case(name), "summary_low_precision");
  const auto initial = blocks(name, 1440, hold_case(name), [](double) { return Increment{}; });
  const auto before = of(initial, Between::nothing, kGoldenFlank);
  expect_summary(before.flank_min, before.flank_max, at(want, "swept_before"));
  EXPECT_NEAR(before.root_face_min.value, number(want, "root_face_clearance_before"), 1e-8);
  const auto optima = Increments::optima(name, 180, hold_case(name));
  const PeriodicSpline dz{optima.dz}, db{optima.db};
  const auto spline = [&](double turn) { return Increment{dz(180 * turn), db(180 * turn)}; };
  const auto after =
      of(blocks(name, 1440, hold_case(name), spline), Between::nothing, kGoldenFlank);
  expect_summary(after.flank_min, after.flank_max, at(want, "swept_after_flank"));
  EXPECT_NEAR(after.stock_left_max.value, numbers(want, "swept_after_solid").at(1), 1e-8);
  const auto coarse =
      of(blocks(name, 180, hold_case(name), spline), Between::nothing, kGoldenFlank);
  EXPECT_NEAR(coarse.root_face_min.value, number(want, "root_face_clearance_after"), 1e-8);
  // The root face of all 1440 positions: what 180 of them saw, or deeper.
  EXPECT_LE(after.root_face_min.value, coarse.root_face_min.value);
  std::printf("%s root face: 180 positions %.6f, 1440 positions %.6f mm\n", name.c_str(),
              coarse.root_face_min.value, after.root_face_min.value);
  // evaluations per position, the first counted
  const auto evaluations = numbers(want, "evals_per_position");
  EXPECT_LE(optima.most, evaluations.at(2));
  EXPECT_NEAR(optima.mean, evaluations.at(1), 0.1);
}

TEST_P(GoldenSwept, InitialPositions) {
  const auto motion = blocks(name, 360, hold_case(name), [](double) { return Increment{}; });
  const auto got = of(motion);
  const auto& lateral = *at(golden_case(name), "swept_initial_360/lateral").as<api::Json::Array>();
  ASSERT_EQ(lateral.size(), 24U);
  double least = 0.0;
  for (const auto& row : lateral)
    for (const double value : numbers(row)) least = std::min(least, value);
  EXPECT_LE(got.flank_min.value, least + 1e-10);
}

}  // namespace
}  // namespace tubecut::groove
