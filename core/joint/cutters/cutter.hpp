#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"
#include "core/joint/cutters/cone.hpp"
#include "core/joint/cutters/elbow.hpp"
#include "core/joint/cutters/kind.hpp"
#include "core/joint/cutters/plane.hpp"
#include "core/joint/cutters/rectangular_tube.hpp"
#include "core/joint/cutters/tube.hpp"

namespace tubecut::joint {

template <class... Kinds>
struct KindsOf {
  static_assert((CutterKind<Kinds> && ...), "a kind of cutter lacks an operation");
  using Cutter = std::variant<Kinds...>;
  using Prepared = std::variant<typename Kinds::Prepared...>;
  using Solid = std::variant<typename Kinds::Solid...>;
  using Partner = std::variant<Kinds..., AxisTube>;
};
/// Every kind of cutter, each in a file of its own.
using CutterKinds =
    KindsOf<TubeCutter, PlaneCutter, RectangularTubeCutter, ConeCutter, ElbowCutter>;

using Cutter = CutterKinds::Cutter;
using PreparedCutter = CutterKinds::Prepared;
/// A partner as a request describes it.
using Partner = CutterKinds::Partner;
static_assert(DescribedKind<AxisTube>);

/// The one way from a cutter, partner or solid to what its kind knows: one case for every kind.
template <class Of, class F>
decltype(auto) by_kind(Of&& cutter, F&& asked) {
  return std::visit(std::forward<F>(asked), std::forward<Of>(cutter));
}

/// Checks one cutter and takes its angles' sines and cosines.
/// Errors    out_of_range, zero_length, bad_reference_direction; parallel_axes (sine of the angle
///           between the axes, or between plane and axis, < kParallel; got and limit in deg).
[[nodiscard]] Result<PreparedCutter> prepare(const Cutter& cutter);

/// The partner with its surface moved outwards by this much, normal to it. By 0 no bit changes.
template <class Of>
[[nodiscard]] Of grown(Of cutter, double by) {
  if (by != 0.0) by_kind(cutter, [&](auto& kind) { kind.grow(by); });
  return cutter;
}

/// The partner turned about the target's axis, from x towards y. By 0 no bit changes.
[[nodiscard]] TurnAboutAxis turn_about_axis(Angle by);
template <class Of>
[[nodiscard]] Of turned(Of partner, Angle by) {
  if (by.rad() != 0.0)
    by_kind(partner, [turn = turn_about_axis(by)](auto& kind) { kind.turn(turn); });
  return partner;
}

/// Empty for a plane square to the target's axis: it has no side.
[[nodiscard]] std::optional<Bearing> bearing(const Partner& partner);

/// Sine of the angle between the target axis and the cutter's axis, plane or surface lines.
[[nodiscard]] double sin_inclination(const PreparedCutter& cutter);

/// z where the generator leaves the cutter; empty where it misses it. A generator beyond the
/// silhouette by no more than 2.5e-13 (r + rho), which is rounding, touches it.
///
/// Accuracy  distance of the point to the cutter's axis = radius within 1e-12 (radius + rho).
/// Cost      one square root, two divisions.
/// Source    docs/theory/intersections-and-bevels.md, section 1, eq. 1'; section 9.
[[nodiscard]] std::optional<double> upper_sheet(const PreparedCutter& cutter,
                                                const Generator& line);
[[nodiscard]] std::optional<Hit> hit(const PreparedCutter& cutter, const Generator& line);

/// As `upper_sheet`, continued beyond the silhouettes by z of the silhouette's tangent plane
/// (S = 0): continuous all around. For generators known to hit but for rounding.
[[nodiscard]] double continued_sheet(const PreparedCutter& cutter, const Generator& line);
[[nodiscard]] Hit continued_hit(const PreparedCutter& cutter, const Generator& line);

/// z where the generator at `line` touches the silhouette (S = 0 exactly): there the sheet itself
/// keeps only half the digits. A plane has its own z. And dz/dphi there, where the hit's is not
/// finite.
[[nodiscard]] double silhouette_height(const PreparedCutter& cutter, const Generator& line);
[[nodiscard]] double silhouette_slope(const PreparedCutter& cutter, const Generator& line);

/// The one-sided limit of `hit` at a kink, where phi grows towards (`before`) or away from
/// (`after`) it; the normal is that at a distance of 1e-12 rad.
[[nodiscard]] Hit hit_at_corner(const PreparedCutter& cutter, const Generator& line, Side side);

/// The normal with the tangential part as printed in source 000, eq. (2), whose first sign is
/// wrong. For comparison with the paper only.
/// Source    docs/theory/intersections-and-bevels.md, section 0, line 3.
[[nodiscard]] Eigen::Vector3d published_normal(const PreparedCutter& cutter, const Generator& line);

/// How much of the surface of this radius meets the cutter. `always` is certain; a cutter met
/// everywhere may be told as `partly`.
[[nodiscard]] Met met(const PreparedCutter& cutter, double rho);

/// A length the rounding of its z is proportional to.
[[nodiscard]] double rounding_size(const PreparedCutter& cutter, double rho);

/// The pieces whose highest sheet is the cutter's own; none where it has no closed form.
[[nodiscard]] std::vector<Sheets> sheets(const PreparedCutter& cutter, double rho);

/// Phases at which a generator touches it from outside, and perhaps others.
[[nodiscard]] std::vector<double> silhouettes(const PreparedCutter& cutter, double rho);
/// Phases at which its own curve has a corner.
[[nodiscard]] std::vector<double> kinks(const PreparedCutter& cutter, double rho);

/// Bounds of its heights on all generators no further than `off` from the line; infinite where it
/// has none.
[[nodiscard]] Heights heights_near(const PreparedCutter& cutter, const Generator& line, double off);

/// Least slope of a straight cut, from the root at `z_root` on the inner generator across the wall,
/// that enters the cutter nowhere; and the least z of the root from which a cut of this slope does.
/// Source    docs/theory/intersections-and-bevels.md, section 5.3.
[[nodiscard]] double steepest(const PreparedCutter& cutter, const Wall& wall,
                              const Generator& inner, double z_root);
[[nodiscard]] double support(const PreparedCutter& cutter, const Wall& wall, const Generator& inner,
                             double slope);

/// For one generator of one cutter, straight from its description.
[[nodiscard]] std::optional<double> upper_sheet(const Cutter& cutter, double rho, Angle phi);
[[nodiscard]] std::optional<Hit> hit(const Cutter& cutter, double rho, Angle phi);

}  // namespace tubecut::joint
