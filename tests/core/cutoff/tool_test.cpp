#include "core/cutoff/tool.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/cutoff/machines.hpp"

namespace tubecut::cutoff {
namespace {

using tubecut::testing::at;
using tubecut::testing::golden;
using tubecut::testing::number;

TEST(GoldenSurface, EveryFigure) {
  const auto json = golden("feed-curves.json");
  const auto& request = at(json, "surface_request");
  const auto& rows = *at(json, "surface").as<api::Json::Array>();
  ASSERT_EQ(rows.size(), 3u);
  for (const auto& row : rows) {
    const ToolSpec tool{.disc = number(row, "n"),
                        .blades = static_cast<int>(number(request, "blades")),
                        .corner_radius = number(request, "corner_radius_mm"),
                        .kerf = number(request, "kerf_mm")};
    const TubeSpec tube{number(request, "outer_diameter_mm"), number(request, "wall_mm")};
    const auto got =
        tool_outputs(tool, tube, number(request, "v_mm_s"), number(request, "ripple")).value();
    const auto near = [&row](double value, const char* name) {
      EXPECT_NEAR(value, number(row, name), 1e-13 * number(row, name)) << name;
    };
    near(got.feed_per_revolution, "feed_per_rev");
    near(got.feed_per_blade, "feed_per_tooth");
    near(got.feed_per_blade_low, "feed_per_tooth_min");
    near(got.feed_per_blade_high, "feed_per_tooth_max");
    near(got.roughness, "Rt_ideal_um");
    near(got.roughness_one_blade, "Rt_one_cutter_um");
    near(got.wall_cut->cutting_speed_outside, "cutting_speed_od");
    near(got.wall_cut->cutting_speed_bore, "cutting_speed_bore");
    near(got.wall_cut->revolutions, "revs_through_wall");
    near(got.wall_cut->duration, "time_through_wall");
    near(got.wall_cut->chip_rate, "mrr_od_mm3_s");
    near(got.wall_cut->chip_volume, "chip_volume_mm3");
  }
}

TEST(ToolOutputs, WithoutATubeHaveNoWallCut) {
  const auto got = tool_outputs({300.0, 3, 0.4, 4.0}, std::nullopt, 1.0, 0.0).value();
  EXPECT_FALSE(got.wall_cut);
  EXPECT_EQ(got.feed_per_blade_low, got.feed_per_blade_high);
}

TEST(ToolOutputs, Errors) {
  const auto bad = tool_outputs({0.0, 0, -1.0, NAN}, std::nullopt, 1.0, 0.0);
  ASSERT_FALSE(bad);
  ASSERT_EQ(bad.error().issues.size(), 4u);
  EXPECT_EQ(bad.error().issues[1].member, "tool/blades");
  EXPECT_EQ(tool_outputs({300.0, 3, 0.4, 4.0}, TubeSpec{100.0, 50.0}, 1.0, 0.0).error().code(),
            ErrorCode::wall_too_thick);
}

}  // namespace
}  // namespace tubecut::cutoff
