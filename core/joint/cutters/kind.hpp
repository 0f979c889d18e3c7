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

/// Requirements on every kind of cutter. If a kind lacks a member, it does not compile:
/// cutters/cutter.hpp asserts the concepts below for every alternative of `Cutter`.
namespace tubecut::joint {

struct Sheets;

enum class Side { before, after };

/// The extent of the target's surface that meets a cutter.
enum class Met { never, partly, always };

/// A rotation about the target's axis, from x towards y.
struct TurnAboutAxis {
  Eigen::Matrix3d by;
  Angle angle;
};

/// phi (rad, in the partner's frame) of the common perpendicular of target and partner, and the
/// side to which the partner leans (its axis rises towards the member, or the plane does). `lean`
/// is empty for a partner at right angles.
struct Bearing {
  double perpendicular = 0.0;
  std::optional<double> lean;
};
/// Computes the bearing of a partner from the direction of its axis.
[[nodiscard]] Bearing bearing_of_axis(Eigen::Vector3d direction);
/// If the sine is below it, a partner is at right angles.
inline constexpr double kSquare = 1e-9;

inline constexpr double kSameHeight = 1e-12;  // relative, of two heights of one point

/// Bounds of a cutter's heights near a generator.
struct Heights {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
};

/// A cutter or a partner, as in the request.
template <class K>
concept DescribedKind = requires(const K& kind, K& changed, double by, const TurnAboutAxis& turn) {
  changed.grow(by);  // moves its surface outwards, normal to it
  changed.turn(turn);
  { kind.bearing() } -> std::same_as<std::optional<Bearing>>;  // empty: it has no side
  { K::kName } -> std::convertible_to<std::string_view>;       // its name in requests
};

/// A cutter in the target's frame, with precomputed sines and cosines of its own angles. The
/// functions of the same names in cutters/cutter.hpp document the contracts of the members.
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

/// A cutter as a solid, for verification: see `Solid` in core/joint/solid.hpp.
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
/// A solid whose distance along a straight line follows a formula.
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

/// Errors that all preparations share; paths are relative to the cutter.
[[nodiscard]] tl::unexpected<Error> beyond_limit(std::string_view field, double got, double limit,
                                                 std::string unit);
[[nodiscard]] tl::unexpected<Error> zero_length(std::string_view field);
[[nodiscard]] tl::unexpected<Error> parallel_axes(std::string_view field, double sine,
                                                  std::string hint = {});

}  // namespace tubecut::joint
