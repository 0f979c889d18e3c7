#include "core/groove/swept.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/base/elementary.hpp"
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
    const JointGeometry joint = joint_case(name);
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
  const JointGeometry joint = joint_case(name);
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
                  points);
  }
};
INSTANTIATE_TEST_SUITE_P(Cases, GoldenSwept, ::testing::ValuesIn(kCases));

/// The golden summary was sampled with rulings every 2 deg; the root face with only the 180 optima
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
  // The root face of all 1440 positions: the result of 180 of them, or deeper.
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

/// Every point checked in full: all blocks within a quarter turn, then golden sections in both
/// segments next to the best. Nothing is skipped.
class FullCheck {
 public:
  FullCheck(const JointGeometry& joint, const Cone& cone, const groove::Setup& setup,
            std::span<const Block> motion, Between between)
      : joint_(joint), cone_(cone), setup_(setup), motion_(motion), between_(between) {}

  [[nodiscard]] Swept run(const SweptPoints& points) const {
    Swept out{{.value = kFar}, {.value = -kFar}, {.value = -kFar}, {.value = kFar}};
    for (int j = 0; j < points.rulings; ++j) {
      const Angle omega = Angle::rad(kTwoPi * j / points.rulings);
      const Section here = *section(joint_, omega);
      for (int i = 0; i < points.per_ruling; ++i) {
        const double v = double(i) / (points.per_ruling - 1);
        const double s = joint_.root_radius + v * joint_.groove_width;
        const double z = here.toe.y1 + v * here.height;
        const Extreme flank = least(here, s, z, v, false), solid = least(here, s, z, v, true);
        if (flank.value < out.flank_min.value) out.flank_min = flank;
        if (flank.value > out.flank_max.value) out.flank_max = flank;
        if (solid.value > out.stock_left_max.value) out.stock_left_max = solid;
      }
      for (int i = 0; i < points.root_levels; ++i) {
        const double level = double(i) / (points.root_levels - 1);
        const double z = here.toe.y1 - level * joint_.root_height;
        const Extreme root = least(here, joint_.root_radius, z, level, true);
        if (root.value < out.root_face_min.value) out.root_face_min = root;
      }
    }
    return out;
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  [[nodiscard]] double distance(const Section& at, double s, double z, double station,
                                bool solid) const {
    const Block block = block_at(motion_, station);
    const ToolPose pose = pose_of(block, setup_);
    const auto [sin, cos] = elementary::sincos(block.omega);
    const Eigen::Vector3d p(s * (at.dir.cos * cos + at.dir.sin * sin),
                            s * (at.dir.sin * cos - at.dir.cos * sin), z);
    return solid ? cone_.solid(pose, p) : cone_.flank(pose, p);
  }

  [[nodiscard]] Extreme least(const Section& at, double s, double z, double level,
                              bool solid) const {
    Extreme best{.value = kFar, .omega = at.omega, .level = level};
    const auto measure = [&](double station) {
      return Extreme{distance(at, s, z, station, solid), at.omega, level, station};
    };
    for (std::size_t i = 0; i < motion_.size(); ++i) {
      const double apart = motion_[i].omega - at.omega.rad();
      if (std::abs(apart - kTwoPi * std::round(apart / kTwoPi)) > 0.25 * kTwoPi) continue;
      if (const Extreme here = measure(double(i)); here.value < best.value) best = here;
    }
    if (between_ == Between::nothing) return best;
    const double block = best.station;
    for (const double low : {block - 1.0, block}) {
      const Extreme found = golden(low, solid ? 37 : 21, measure);
      if (found.value < best.value) best = found;
    }
    return best;
  }

  template <class Measure>
  static Extreme golden(double low, int steps, const Measure& measure) {
    constexpr double kGolden = 0.6180339887498949;
    double high = low + 1.0;
    Extreme left = measure(high - kGolden * (high - low)),
            right = measure(low + kGolden * (high - low));
    for (int i = 0; i < steps; ++i) {
      if (left.value < right.value) {
        high = right.station;
        right = left;
        left = measure(high - kGolden * (high - low));
      } else {
        low = left.station;
        left = right;
        right = measure(low + kGolden * (high - low));
      }
    }
    return left.value < right.value ? left : right;
  }

  const JointGeometry& joint_;
  const Cone& cone_;
  const groove::Setup& setup_;
  std::span<const Block> motion_;
  Between between_;
};

/// Golden sections of nearly equal value may stop at points 1e-7 mm from each other, so points of
/// nearly equal value count as equal.
void expect_same(const Extreme& got, const Extreme& want, const std::string& what) {
  EXPECT_NEAR(got.value, want.value, 1e-7) << what;
}

// Skipped points cannot matter: smooth motions, motions with noise in every axis, coarse and fine,
// for cones of every kind.
TEST(Swept, SkipsNothingThatMatters) {
  std::mt19937_64 random(18);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  int compared = 0;
  for (const char* const name : kCases) {
    const JointGeometry joint = joint_case(name);
    const groove::Setup setup = setup_case(name);
    for (const int count : {24, 90, 181}) {
      for (const double noise : {0.0, 0.003, 0.3}) {
        std::vector<Increment> noisy;
        for (int i = 0; i < count; ++i)
          noisy.push_back({noise * any(random), 0.02 * noise * any(random)});
        const auto motion = blocks(name, count, hold_case(name), [&](double turn) {
          return noisy[std::size_t(std::lround(turn * count)) % noisy.size()];
        });
        const Cone cone{mill_case(name)};
        const SweptPoints points{.rulings = 60, .per_ruling = 5, .root_levels = 3};
        for (const Between between : {Between::linear, Between::nothing}) {
          const Swept got = *swept(joint, cone, setup, motion, between, points);
          const Swept want = FullCheck{joint, cone, setup, motion, between}.run(points);
          const std::string what =
              std::string(name) + " " + std::to_string(count) + " " + std::to_string(noise);
          expect_same(got.flank_min, want.flank_min, what + " flank_min");
          expect_same(got.flank_max, want.flank_max, what + " flank_max");
          expect_same(got.stock_left_max, want.stock_left_max, what + " stock_left_max");
          expect_same(got.root_face_min, want.root_face_min, what + " root_face_min");
          ++compared;
        }
      }
    }
  }
  EXPECT_EQ(compared, int(std::size(kCases)) * 18);
}

}  // namespace
}  // namespace tubecut::groove
