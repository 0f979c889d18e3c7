#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "core/bevel/hole/hole.hpp"
#include "core/cutout/laying.hpp"
#include "core/cutout/rows.hpp"

/// Countersinks: cones about the axes of circles, cut after them.
namespace tubecut::cutout {

/// A cone of revolution about the anchor's normal. It removes what lies within it and beyond its
/// circle, which is cut straight before it.
struct Cone {
  double hole = 0.0;      // mm, the diameter of its circle
  double diameter = 0.0;  // mm, in the plane that touches the outside at the anchor
  double half = 0.0;      // rad, between its axis and its side

  [[nodiscard]] bool operator==(const Cone&) const = default;
  /// How much its radius falls a mm of depth.
  [[nodiscard]] double slope() const;
  /// Where it meets its circle below the touching plane, mm; below the bore if it has no land.
  [[nodiscard]] double depth() const { return 0.5 * (diameter - hole) / slope(); }
};

/// Distance from the axis at which the side meets a surface of the wall, `w` from +z towards
/// growing phi. Negative beyond the axis; not a number if the side misses the surface.
[[nodiscard]] double cone_radius(const Laying& laying, const Cone& cone, double w, bool outer);

/// The cone on which the torch's axis runs, so that its beam touches the side.
[[nodiscard]] Cone torch_cone(const Cone& cone, double kerf);

/// Computes the finished edges, which are its circle's where that reaches further, and the torch's
/// axis. See `rows` of a chain.
[[nodiscard]] bevel::Hole cone_rows(const Laying& laying, const Cone& cone, const Cutting& cutting);

/// What the cone takes beyond its circle.
/// Accuracy  1e-11 of itself.
/// Source    docs/theory/cutouts.md, section 8.
[[nodiscard]] Taken cone_taken(const Laying& laying, const Cone& cone);

/// The same of the tube's section at z = `at` from the anchor, mm^2.
[[nodiscard]] double cone_removed(const Laying& laying, const Cone& cone, double at);

/// Returns true if the beam, beyond the axis, meets the wall on the far side of the hole.
[[nodiscard]] bool is_spent_on_wall(const Laying& laying, const Cone& cone, double kerf);

/// Returns true if at the tube's sides the outside falls away below the cone.
[[nodiscard]] bool is_open(const Laying& laying, const Cone& cone);

/// How the finished wall is made up from the outside to the bore.
enum class ConeWall {
  whole,   // the cone alone
  landed,  // the cone, then its circle
  mixed    // neither all round
};
[[nodiscard]] ConeWall cone_wall(const Laying& laying, const Cone& cone);

/// Whether the cone can be cut, by the fields of `countersink`.
///
/// Errors  out_of_range (diameter: not wider than the circle or than its beam), torch_range (angle),
///         open_profile (angle: a line of the torch misses the bore).
[[nodiscard]] std::vector<Issue> check_cone(const Laying& laying, const Cone& cone, double kerf,
                                            double most_lean);

}  // namespace tubecut::cutout
