#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/cutoff/linkage.hpp"

namespace tubecut::cutoff {

/// The blades on the disc; they share one groove.
struct ToolSpec {
  double disc = 0.0;           // rev/min, > 0
  int blades = 1;              // >= 1
  double corner_radius = 0.0;  // mm, > 0
  double kerf = 0.0;           // mm, > 0
};

/// The tubes that a machine accepts, mm, smallest and largest.
struct TubeRange {
  std::pair<double, double> outer_diameter = {};
  std::pair<double, double> wall = {};
};

/// The tube that is cut.
struct TubeSpec {
  double outer_diameter = 0.0;  // mm, > 0
  double wall = 0.0;            // mm, > 0, below the radius
  std::optional<TubeRange> machine = {};
};

/// Figures that require the tube's size.
struct WallCut {
  double cutting_speed_outside = 0.0;  // m/min at the outer diameter
  double cutting_speed_bore = 0.0;     // m/min
  double revolutions = 0.0;            // through the wall
  double duration = 0.0;               // s through the wall
  double chip_rate = 0.0;              // mm^3/s at the outer diameter
  double chip_volume = 0.0;            // mm^3, the whole ring
};

/// Kinematic figures without chatter and force.
struct ToolOutputs {
  double feed_per_revolution = 0.0;  // mm
  double feed_per_blade = 0.0;       // mm
  double feed_per_blade_low = 0.0;   // mm, at the command's lowest tool speed
  double feed_per_blade_high = 0.0;  // mm
  double roughness = 0.0;            // ideal R_t, um
  double roughness_one_blade = 0.0;  // um, if one blade is proud
  std::optional<WallCut> wall_cut = {};
};

/// Computes cutting figures at the constant tool feed `feed` (mm/s); `ripple` is the command's
/// largest relative error of it.
///
/// Errors    out_of_range, not_finite, wall_too_thick.
/// Source    docs/theory/feed-curves.md, section 6.
[[nodiscard]] Result<ToolOutputs> tool_outputs(const ToolSpec& tool,
                                               const std::optional<TubeSpec>& tube, double feed,
                                               double ripple);

/// Errors    out_of_range, not_finite, wall_too_thick.
[[nodiscard]] Result<void> check_tube(const TubeSpec& tube);

/// Returns the tubes that the machine with this linkage accepts, if a source states them: only the
/// machine of Tables 2 and 3 of source 004, diameters 89..195 mm and walls 6..25 mm. For that of
/// its Table 1 the source gives no range.
[[nodiscard]] std::optional<TubeRange> published_range(const Linkage& linkage);

/// Returns notes for a tube outside the range of its machine (`tube.machine`, else the published
/// range); empty without a range.
[[nodiscard]] std::vector<Warning> tube_warnings(const Linkage& linkage, const TubeSpec& tube);

}  // namespace tubecut::cutoff
