#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
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

/// Calls `asked` with the kind of a cutter, partner or solid. All dispatch by kind goes through it.
template <class Of, class F>
decltype(auto) by_kind(Of&& cutter, F&& asked) {
  return std::visit(std::forward<F>(asked), std::forward<Of>(cutter));
}

/// Checks one cutter and computes the sines and cosines of its angles.
/// Errors    out_of_range, zero_length, bad_reference_direction; parallel_axes (sine of the angle
///           between the axes, or between plane and axis, < kParallel; got and limit in deg).
[[nodiscard]] Result<PreparedCutter> prepare(const Cutter& cutter);

/// Returns the partner with its surface moved outwards by this distance, normal to it. 0 changes no
/// bit.
template <class Of>
[[nodiscard]] Of grown(Of cutter, double by) {
  if (by != 0.0) by_kind(cutter, [&](auto& kind) { kind.grow(by); });
  return cutter;
}

/// Returns the partner rotated about the target's axis, from x towards y. 0 changes no bit.
[[nodiscard]] TurnAboutAxis turn_about_axis(Angle by);
template <class Of>
[[nodiscard]] Of turned(Of partner, Angle by) {
  if (by.rad() != 0.0)
    by_kind(partner, [turn = turn_about_axis(by)](auto& kind) { kind.turn(turn); });
  return partner;
}

/// Returns empty for a plane square to the target's axis, because it has no side.
[[nodiscard]] std::optional<Bearing> bearing(const Partner& partner);

/// Returns the sine of the angle between the target axis and the cutter's axis, plane or surface
/// lines.
[[nodiscard]] double sin_inclination(const PreparedCutter& cutter);

/// Computes z where the generator leaves the cutter; empty when it misses it. If a generator is
/// beyond the silhouette by at most 2.5e-13 (r + rho), which is rounding, it touches the cutter.
///
/// Accuracy  distance of the point to the cutter's axis = radius within 1e-12 (radius + rho).
/// Cost      one square root, two divisions.
/// Source    docs/theory/intersections-and-bevels.md, section 1, eq. 1'; section 9.
[[nodiscard]] std::optional<double> upper_sheet(const PreparedCutter& cutter,
                                                const Generator& line);
[[nodiscard]] std::optional<Hit> hit(const PreparedCutter& cutter, const Generator& line);

/// Like `upper_sheet`, continued beyond the silhouettes by z of the silhouette's tangent plane (S =
/// 0): continuous all around. Use it for generators that are known to hit except for rounding.
[[nodiscard]] double continued_sheet(const PreparedCutter& cutter, const Generator& line);
[[nodiscard]] Hit continued_hit(const PreparedCutter& cutter, const Generator& line);

/// Computes z where the generator at `line` touches the silhouette (S = 0 exactly), because the
/// sheet keeps only half the digits there. A plane returns its own z. Also computes dz/dphi there
/// if the hit's is not finite.
[[nodiscard]] double silhouette_height(const PreparedCutter& cutter, const Generator& line);
[[nodiscard]] double silhouette_slope(const PreparedCutter& cutter, const Generator& line);

/// Computes the one-sided limit of `hit` at a kink, where phi grows towards it (`before`) or away
/// from it (`after`); the normal is that at a distance of 1e-12 rad.
[[nodiscard]] Hit hit_at_corner(const PreparedCutter& cutter, const Generator& line, Side side);

/// Computes the normal with the tangential part as printed in source 000, eq. (2), whose first sign
/// is wrong. Only for comparison with the paper.
/// Source    docs/theory/intersections-and-bevels.md, section 0, line 3.
[[nodiscard]] Eigen::Vector3d published_normal(const PreparedCutter& cutter, const Generator& line);

/// Returns how much of the surface of this radius meets the cutter. `always` is certain; `partly`
/// may also be returned for a cutter that is met everywhere.
[[nodiscard]] Met met(const PreparedCutter& cutter, double rho);

/// Returns a length to which the rounding of its z is proportional.
[[nodiscard]] double rounding_size(const PreparedCutter& cutter, double rho);

/// Returns how far apart two heights of a cutter at one event may be by rounding, mm, from its
/// parts and its `rounding_size`.
[[nodiscard]] double event_noise(std::span<const Sheets> parts, double size);

/// Returns the parts whose highest sheet is the cutter's own; empty when there is no closed form.
[[nodiscard]] std::vector<Sheets> sheets(const PreparedCutter& cutter, double rho);

/// Returns the phases at which a generator touches it from outside, and possibly others.
[[nodiscard]] std::vector<double> silhouettes(const PreparedCutter& cutter, double rho);
/// Returns the phases at which its own curve has a corner.
[[nodiscard]] std::vector<double> kinks(const PreparedCutter& cutter, double rho);

/// Returns bounds of its heights on all generators within `off` of the line; infinite if there are
/// none.
[[nodiscard]] Heights heights_near(const PreparedCutter& cutter, const Generator& line, double off);

/// Computes the smallest slope of a straight cut, from the root at `z_root` on the inner generator
/// across the wall, that avoids the cutter; and the smallest z of the root from which a cut of this
/// slope does.
/// Source    docs/theory/intersections-and-bevels.md, section 5.3.
[[nodiscard]] double steepest(const PreparedCutter& cutter, const Wall& wall,
                              const Generator& inner, double z_root);
[[nodiscard]] double support(const PreparedCutter& cutter, const Wall& wall, const Generator& inner,
                             double slope);

/// The same for one generator of one cutter that is not prepared.
[[nodiscard]] std::optional<double> upper_sheet(const Cutter& cutter, double rho, Angle phi);
[[nodiscard]] std::optional<Hit> hit(const Cutter& cutter, double rho, Angle phi);

}  // namespace tubecut::joint
