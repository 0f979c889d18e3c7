#include "api/endpoints/frames/renaming.hpp"

#include <gtest/gtest.h>

#include "core/base/warning_codes.hpp"

namespace tubecut::api {
namespace {

const Renamings kPart{{"start/kerf", "kerf"},
                      {"start/cutters/1", "members/4", false},
                      {"start/cutters/10", "members/7", false},
                      {"start/cutters", "members/0", false},
                      {"start/", ""},
                      {"target", "members/0", false}};

TEST(Renaming, MatchesOnlyWholeSteps) {
  EXPECT_EQ(renamed("start/cutters/1", kPart), "members/4");
  EXPECT_EQ(renamed("start/cutters/10", kPart), "members/7");
  EXPECT_EQ(renamed("start/cutters/1/outer_radius", kPart), "members/4");
  EXPECT_EQ(renamed("start/cutters/11/outer_radius", kPart), "members/0");
  EXPECT_EQ(renamed("target/wall", kPart), "members/0");
  EXPECT_EQ(renamed("targets", kPart), "targets");
  EXPECT_EQ(renamed("start", kPart), "start");
}

TEST(Renaming, KeepsNestedFields) {
  EXPECT_EQ(renamed("start/kerf", kPart), "kerf");
  EXPECT_EQ(renamed("start/kerf/width", kPart), "kerf/width");
  EXPECT_EQ(renamed("start/kerf_pairs", kPart), "kerf_pairs");
  EXPECT_EQ(renamed("start/groove/zones/2", kPart), "groove/zones/2");
  EXPECT_EQ(renamed("", kPart), "");
  EXPECT_EQ(renamed("holes/3", {}), "holes/3");
}

TEST(Renaming, IsOfEveryIssueAndWarning) {
  Issue wall{.code = ErrorCode::out_of_range, .member = "target/wall"};
  Issue groove{.code = ErrorCode::out_of_range, .member = "start/groove"};
  const auto error = renamed(Error{{wall, groove}}, kPart);
  ASSERT_EQ(error.issues.size(), 2U);
  EXPECT_EQ(error.issues[0].member, "members/0");
  EXPECT_EQ(error.issues[1].member, "groove");
  const auto told = renamed(
      std::vector<Warning>{{.code = WarningCode::near_parallel, .member = "start/cutters/10"}},
      kPart);
  EXPECT_EQ(told.front().member, "members/7");
}

}  // namespace
}  // namespace tubecut::api
