#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <variant>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"
#include "core/joint/elbow.hpp"
#include "core/joint/generator.hpp"
#include "core/joint/shape.hpp"

namespace tubecut::joint {

/// A round partner of the target, an infinite cylinder. Lengths in mm.
/// Frame: z along the target axis from the cut end into the kept member, phi from x towards y.
struct TubeCutter {
  double radius = 0.0;                 // > 0
  Angle inclination = Angle::deg(90);  // alpha, between the axes, open interval (0, 180) deg
  Angle clocking = {};                 // beta, of the common perpendicular
  double offset = 0.0;                 // s, signed distance of the axes
  double height = 0.0;                 // h, where the common perpendicular meets the target axis
};

/// A plane as partner: the target is cut along it, material on the side its normal points to is
/// kept.
struct PlaneCutter {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // any length > 0; turned so that its z is > 0
};

using Cutter = std::variant<TubeCutter, PlaneCutter, BoxCutter, ConeCutter, ElbowCutter>;

/// Cutters with the sines and cosines of their own angles taken once. Made by `prepare`.
struct PreparedTube {
  double radius, offset, height;
  double cos_inclination, sin_inclination;
  double cos_clocking, sin_clocking;
};
struct PreparedPlane {
  double height;            // z on the target axis
  double slope_x, slope_y;  // z = height + slope_x x + slope_y y
  Eigen::Vector3d normal;   // unit, z > 0, in the target frame
};
using Prepared =
    std::variant<PreparedTube, PreparedPlane, PreparedBox, PreparedCone, PreparedElbow>;

/// Checks one cutter and takes its angles' sines and cosines; `member` names it in errors.
/// Errors    out_of_range (radius), zero_length (normal), parallel_axes (sine of the angle between
///           the axes, or between plane and axis, < kParallel; got and limit in deg).
[[nodiscard]] Result<Prepared> prepare(const Cutter& cutter, std::string_view member);

/// Sine of the angle between the target axis and the cutter's axis or plane.
[[nodiscard]] double sin_inclination(const Prepared& cutter);

/// z where the generator leaves the cutter; empty where it misses it. A generator beyond the
/// silhouette by no more than 2.5e-13 (r + rho), which is rounding, touches it.
///
/// Accuracy  distance of the point to the cutter's axis = radius within 1e-12 (radius + rho).
/// Cost      one square root, two divisions.
/// Source    docs/theory/intersections-and-bevels.md, section 1, eq. 1'.
[[nodiscard]] std::optional<double> upper_sheet(const Prepared& cutter, const Generator& line);
[[nodiscard]] std::optional<Hit> hit(const Prepared& cutter, const Generator& line);

/// As `upper_sheet`, continued beyond the silhouettes by z of the silhouette's tangent plane
/// (S = 0): continuous all around. For generators known to hit but for rounding.
[[nodiscard]] double continued_sheet(const Prepared& cutter, const Generator& line);
[[nodiscard]] Hit continued_hit(const Prepared& cutter, const Generator& line);

/// z where the generator at `line` touches the tube's silhouette (S = 0 exactly): there the sheet
/// itself keeps only half the digits. A plane has its own z.
[[nodiscard]] double silhouette_height(const Prepared& cutter, const Generator& line);

enum class Side { before, after };

/// The one-sided limit of `hit` at the corner of a tangent tube (`is_tangent`), where phi grows
/// towards (`before`) or away from (`after`) it; the normal is that at a distance of 1e-12 rad.
[[nodiscard]] Hit hit_at_corner(const Prepared& cutter, const Generator& line, Side side);

/// The normal with the tangential part as printed in source 000, eq. (2), whose first sign is
/// wrong. For comparison with the paper only.
/// Source    docs/theory/intersections-and-bevels.md, section 0, line 3.
[[nodiscard]] Eigen::Vector3d published_normal(const Prepared& cutter, const Generator& line);

/// Is the target's surface tangent to the tube from inside, so that its curve has a corner?
/// Within 1e-9 radius.
[[nodiscard]] bool is_tangent(const PreparedTube& tube, double rho);

/// Does no generator of this surface hit the cutter?
[[nodiscard]] bool misses(const Prepared& cutter, double rho);

/// For one generator of one cutter, straight from its description.
[[nodiscard]] std::optional<double> upper_sheet(const Cutter& cutter, double rho, Angle phi);
[[nodiscard]] std::optional<Hit> hit(const Cutter& cutter, double rho, Angle phi);

}  // namespace tubecut::joint
