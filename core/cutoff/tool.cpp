#include "core/cutoff/tool.hpp"

#include "core/base/angle.hpp"
#include "core/base/try.hpp"
#include "core/cutoff/preconditions.hpp"

namespace tubecut::cutoff {
namespace {

constexpr double kSecondsPerMinute = 60.0;
constexpr double kMmPerM = 1000.0;
constexpr double kUmPerMm = 1000.0;

Result<void> check_tool(const ToolSpec& tool) {
  Preconditions on("tool/");
  on.positive("disc", tool.disc, "rev_min");
  on.require(tool.blades >= 1, "blades", tool.blades, ">= 1", "");
  on.positive("corner_radius", tool.corner_radius, "mm");
  on.positive("kerf", tool.kerf, "mm");
  return on.met();
}

/// Computes the height in um of the ridge that a corner of `radius` leaves between two passes at
/// distance `feed`.
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

Result<void> check_tube(const TubeSpec& tube) {
  Preconditions on("tube/");
  on.positive("outer_diameter", tube.outer_diameter, "mm");
  on.positive("wall", tube.wall, "mm");
  TRY(on.met());
  if (tube.wall < 0.5 * tube.outer_diameter) return {};
  return fail({.code = ErrorCode::wall_too_thick,
               .member = "tube/wall",
               .got = tube.wall,
               .limit = 0.5 * tube.outer_diameter,
               .unit = "mm"});
}

std::optional<TubeRange> published_range(const Linkage& linkage) {
  const bool table_3 =
      linkage.arm == 430.0 && linkage.pivot_distance == 340.0 && linkage.pivot_offset == 90.0;
  if (!table_3) return std::nullopt;
  return TubeRange{.outer_diameter = {89.0, 195.0}, .wall = {6.0, 25.0}};
}

std::vector<Warning> tube_warnings(const Linkage& linkage, const TubeSpec& tube) {
  const auto range = tube.machine ? tube.machine : published_range(linkage);
  std::vector<Warning> out;
  if (!range) return out;
  const std::string whose =
      tube.machine ? "the machine" : "the machine of source 004, Tables 2 and 3,";
  const auto see = [&](double value, std::pair<double, double> taken, const char* member,
                       const char* what) {
    if (value >= taken.first && value <= taken.second) return;
    out.push_back({WarningCode::tube_outside_range, member,
                   whose + " takes " + what + " of " + shown(taken.first) + " to " +
                       shown(taken.second) + " mm, not of " + shown(value) + " mm"});
  };
  see(tube.outer_diameter, range->outer_diameter, "tube/outer_diameter", "diameters");
  see(tube.wall, range->wall, "tube/wall", "walls");
  return out;
}

Result<ToolOutputs> tool_outputs(const ToolSpec& tool, const std::optional<TubeSpec>& tube,
                                 double feed, double ripple) {
  TRY(check_tool(tool));
  ToolOutputs out;
  out.feed_per_revolution = kSecondsPerMinute * feed / tool.disc;
  out.feed_per_blade = out.feed_per_revolution / tool.blades;
  out.feed_per_blade_low = out.feed_per_blade * (1.0 - ripple);
  out.feed_per_blade_high = out.feed_per_blade * (1.0 + ripple);
  out.roughness = ideal_roughness(out.feed_per_blade, tool.corner_radius);
  out.roughness_one_blade = ideal_roughness(out.feed_per_revolution, tool.corner_radius);
  if (!tube) return out;
  TRY(check_tube(*tube));
  out.wall_cut = wall_cut(tool, *tube, feed);
  return out;
}

}  // namespace tubecut::cutoff
