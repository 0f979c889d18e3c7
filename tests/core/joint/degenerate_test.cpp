#include <gtest/gtest.h>

#include <cmath>

#include "core/joint/intersection.hpp"
#include "tests/core/joint/degenerate_cases.hpp"

namespace tubecut::joint {
namespace {

using degenerate::cases;
using degenerate::kRadius;
using degenerate::tube;

TEST(Degenerate, EachIsAValidAnswerOrATypedError) {
  ASSERT_FALSE(cases().empty());
  for (const auto& c : cases()) {
    for (const bool uniform : {true, false}) {
      IntersectionSpec spec{.target = {.outer_radius = kRadius, .wall = 4.0},
                            .partners = c.partners,
                            .surfaces = c.surfaces};
      if (uniform)
        spec.sampling.uniform_points = 90;
      else
        spec.sampling.tolerance = Tolerance{};
      const auto answer = intersect(spec);
      if (c.error) {
        ASSERT_FALSE(answer) << c.name;
        EXPECT_EQ(answer.error().code(), *c.error) << c.name;
        EXPECT_TRUE(answer.error().issues.front().member.starts_with("cutters")) << c.name;
        continue;
      }
      ASSERT_TRUE(answer) << c.name << ": " << info(answer.error().code()).code;
      for (const auto& check : verify(spec, *answer))
        EXPECT_TRUE(check.passed()) << c.name << ": " << check.name << " " << check.value;
      for (const auto& profile : answer->profiles)
        for (const double z : profile.z) EXPECT_TRUE(std::isfinite(z)) << c.name;
    }
  }
}

TEST(Degenerate, IdenticalCuttersHaveNoJunction) {
  IntersectionSpec spec{.target = {.outer_radius = kRadius, .wall = 4.0},
                        .partners = {tube(100, 60), tube(100, 60)}};
  spec.sampling.uniform_points = 90;
  const auto answer = intersect(spec);
  ASSERT_TRUE(answer);
  for (const auto& profile : answer->profiles) {
    EXPECT_TRUE(profile.events.empty());
    for (const auto cutter : profile.cutter) EXPECT_EQ(cutter, 0U);
  }
}

}  // namespace
}  // namespace tubecut::joint
