#pragma once

#include <vector>

#include "core/math/polygon.hpp"
#include "core/part/part.hpp"

namespace tubecut::part {

/// Returns both edges of a hole without other results, with extra rows between its own, straight on
/// the developed surface. They are needed because, if the torch leans across, the lines of such a
/// row do not cross a radius within the wall in a straight line between those of its neighbours. If
/// cancelled, returns only some or no rows.
[[nodiscard]] bevel::Hole closer_rows(const bevel::Hole& hole);

/// Returns true if two holes overlap on the bore, in the middle of the wall or outside.
[[nodiscard]] bool holes_meet(const joint::Target& target, const bevel::Hole& a,
                              const bevel::Hole& b);

/// A radius in the wall: the fraction u from the bore to the outside, its radius, and its weight.
struct Ring {
  double u, rho, weight;
};
/// Returns the radii for integrals over the wall: 16 Gauss points in v, u = v^2, because a hole's
/// lines may graze the bore, where integrands vary as the root of u.
[[nodiscard]] std::vector<Ring> wall_rings(const joint::Target& target);

/// Computes the area (rad mm) of the union of polygons (phi, z) between the cuts of both ends, at
/// one ring.
[[nodiscard]] double area_between_cuts(const joint::Target& target, const Part& part,
                                       std::vector<math::Polygon> polygons, const Ring& ring);

/// Computes the volume of wall between the two cuts that the holes remove, mm^3. The walls of a
/// hole are straight in space from edge to edge. An overlap of two holes counts once, and the
/// region beyond a cut is excluded.
///
/// Accuracy  for edges straight between their nodes 1e-9 of a hole; if the torch leans across and
///           the rows are far from each other (0.05 mm of sag), 1e-6. If holes meet, within 1e-3 of
///           the overlap, because its border has corners that move across the wall.
/// Source    docs/theory/parts.md, section 3.
[[nodiscard]] double holes_volume(const joint::Target& target, const Part& part);

}  // namespace tubecut::part
