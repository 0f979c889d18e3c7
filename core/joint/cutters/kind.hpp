#pragma once

#include <Eigen/Core>
#include <concepts>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"
#include "core/joint/generator.hpp"
#include "core/joint/target.hpp"

/// What every kind of cutter must offer. A kind that lacks a part of it does not compile: the
/// concepts below are asserted for every alternative of `Cutter` in cutters/cutter.hpp.
namespace tubecut::joint {

struct Sheets;

enum class Side { before, after };

/// How much of the target's surface a cutter is met on.
enum class Met { never, partly, always };

/// A turn about the target's axis, from x towards y.
struct TurnAboutAxis {
  Eigen::Matrix3d by;
  Angle angle;
};

/// phi (rad, in the frame the partner is given in) of the common perpendicular of target and
/// partner, and the side towards which the partner leans (its axis rises towards the member, or the
/// plane does). `lean` is empty for a partner at right angles.
struct Bearing {
  double perpendicular = 0.0;
  std::optional<double> lean;
};
/// Of a partner by the direction of its axis.
[[nodiscard]] Bearing bearing_of_axis(Eigen::Vector3d direction);
/// Sine below which a partner stands at right angles.
inline constexpr double kSquare = 1e-9;

inline constexpr double kSameHeight = 1e-12;  // relative, of two heights of one place

/// Between these a cutter's heights lie near a generator.
struct Heights {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
};

/// A cutter, or a partner, as it is described.
template <class K>
concept DescribedKind = requires(const K& kind, K& changed, double by, const TurnAboutAxis& turn) {
  changed.grow(by);  // its surface moved outwards, normal to it
  changed.turn(turn);
  { kind.bearing() } -> std::same_as<std::optional<Bearing>>;  // empty: it has no side
  { K::kName } -> std::convertible_to<std::string_view>;       // what requests call it
};

/// A cutter with the sines and cosines of its own angles taken once, in the target's frame. What
/// the members promise stands with the functions of the same names in cutters/cutter.hpp.
template <class P>
concept PreparedKind = requires(const P& cutter, const Generator& line, Side side, double number,
                                const Wall& wall) {
  { cutter.sine() } -> std::same_as<double>;
  { cutter.upper_sheet(line) } -> std::same_as<std::optional<double>>;
  { cutter.continued_sheet(line) } -> std::same_as<double>;
  { cutter.continued_hit(line) } -> std::same_as<Hit>;
  { cutter.silhouette_height(line) } -> std::same_as<double>;
  { cutter.silhouette_slope(line) } -> std::same_as<double>;
  { cutter.hit_at_corner(line, side) } -> std::same_as<Hit>;
  { cutter.published_normal(line) } -> std::same_as<Eigen::Vector3d>;
  { cutter.met(number) } -> std::same_as<Met>;
  { cutter.size(number) } -> std::same_as<double>;
  { cutter.sheets(number) } -> std::same_as<std::vector<Sheets>>;
  { cutter.silhouettes(number) } -> std::same_as<std::vector<double>>;
  { cutter.kinks(number) } -> std::same_as<std::vector<double>>;
  { cutter.heights_near(line, number) } -> std::same_as<Heights>;
  { cutter.steepest(wall, line, number) } -> std::same_as<double>;
  { cutter.support(wall, line, number) } -> std::same_as<double>;
};

/// A cutter as a solid, for proofs: see `Solid` in core/joint/solid.hpp.
template <class S>
concept SolidKind = requires(const S& solid, const Eigen::Vector3d& p, double number) {
  { solid.scale() } -> std::same_as<double>;
  { solid.distance(p) } -> std::same_as<double>;
  { solid.normal(p) } -> std::same_as<Eigen::Vector3d>;
  { solid.top(number, number) } -> std::same_as<std::optional<double>>;
  { solid.clearance(number, number) } -> std::same_as<double>;
  { solid.least_distance(p, p) } -> std::same_as<double>;
  { solid.most_hollow(number) } -> std::same_as<double>;
};
/// One whose distance along a straight line follows a formula.
template <class S>
concept PlainSolid = SolidKind<S> && requires(const S& solid, const Eigen::Vector3d& p, double n) {
  { solid.nearest_share(p, p) } -> std::same_as<double>;
  { solid.most_bent(n) } -> std::same_as<double>;
};

template <class K>
concept CutterKind = DescribedKind<K> && PreparedKind<typename K::Prepared> &&
    SolidKind<typename K::Solid> && requires(const K& kind) {
  { kind.prepare() } -> std::same_as<Result<typename K::Prepared>>;
  { kind.solid() } -> std::same_as<typename K::Solid>;
};

/// What preparation refuses alike; paths are relative to the cutter.
[[nodiscard]] tl::unexpected<Error> beyond_limit(std::string_view field, double got, double limit,
                                                 std::string unit);
[[nodiscard]] tl::unexpected<Error> zero_length(std::string_view field);
[[nodiscard]] tl::unexpected<Error> parallel_axes(std::string_view field, double sine,
                                                  std::string hint = {});

}  // namespace tubecut::joint
