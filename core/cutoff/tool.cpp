#include "core/cutoff/tool.hpp"

#include "core/base/angle.hpp"
#include "core/cutoff/preconditions.hpp"

namespace tubecut::cutoff {
namespace {

constexpr double kSecondsPerMinute = 60.0;
constexpr double kMmPerM = 1000.0;
constexpr double kUmPerMm = 1000.0;

std::optional<Error> check_tool(const ToolSpec& tool) {
  Preconditions on("tool/");
  on.positive("disc", tool.disc, "rev_min");
  on.require(tool.blades >= 1, "blades", tool.blades, ">= 1", "");
  on.positive("corner_radius", tool.corner_radius, "mm");
  on.positive("kerf", tool.kerf, "mm");
  return on.error();
}

/// Height of the ridge that a corner of `radius` leaves between two passes `feed` apart, um.
double ideal_roughness(double feed, double radius) {
  return kUmPerMm * feed * feed / (8.0 * radius);
}

WallCut wall_cut(const ToolSpec& tool, const TubeSpec& tube, double feed) {
  const double bore = tube.outer_diameter - 2.0 * tube.wall;
  WallCut out;
  out.cutting_speed_outside = kPi * tube.outer_diameter * tool.disc / kMmPerM;
  out.cutting_speed_bore = kPi * bore * tool.disc / kMmPerM;
  out.duration = tube.wall / feed;
  out.revolutions = out.duration * tool.disc / kSecondsPerMinute;
  out.chip_rate = kPi * tube.outer_diameter * tool.kerf * feed;
  out.chip_volume = kPi * (tube.outer_diameter - tube.wall) * tube.wall * tool.kerf;
  return out;
}

}  // namespace

std::optional<Error> check_tube(const TubeSpec& tube) {
  Preconditions on("tube/");
  on.positive("outer_diameter", tube.outer_diameter, "mm");
  on.positive("wall", tube.wall, "mm");
  if (auto wrong = on.error()) return wrong;
  if (tube.wall < 0.5 * tube.outer_diameter) return std::nullopt;
  return Error{{.code = ErrorCode::wall_too_thick,
                .member = "tube/wall",
                .got = tube.wall,
                .limit = 0.5 * tube.outer_diameter,
                .unit = "mm"}};
}

std::vector<Warning> tube_warnings(const TubeSpec& tube) {
  std::vector<Warning> out;
  if (tube.outer_diameter < 89.0 || tube.outer_diameter > 195.0)
    out.push_back({WarningCode::tube_outside_range, "tube/outer_diameter",
                   "the source's machine cuts 89 to 195 mm"});
  if (tube.wall < 6.0 || tube.wall > 25.0)
    out.push_back({WarningCode::tube_outside_range, "tube/wall",
                   "the source's machine cuts walls of 6 to 25 mm"});
  return out;
}

Result<ToolOutputs> tool_outputs(const ToolSpec& tool, const std::optional<TubeSpec>& tube,
                                 double feed, double ripple) {
  if (auto wrong = check_tool(tool)) return tl::unexpected(*wrong);
  ToolOutputs out;
  out.feed_per_revolution = kSecondsPerMinute * feed / tool.disc;
  out.feed_per_blade = out.feed_per_revolution / tool.blades;
  out.feed_per_blade_low = out.feed_per_blade * (1.0 - ripple);
  out.feed_per_blade_high = out.feed_per_blade * (1.0 + ripple);
  out.roughness = ideal_roughness(out.feed_per_blade, tool.corner_radius);
  out.roughness_one_blade = ideal_roughness(out.feed_per_revolution, tool.corner_radius);
  if (!tube) return out;
  if (auto wrong = check_tube(*tube)) return tl::unexpected(*wrong);
  out.wall_cut = wall_cut(tool, *tube, feed);
  return out;
}

}  // namespace tubecut::cutoff
