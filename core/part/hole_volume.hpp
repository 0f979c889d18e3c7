#pragma once

#include <stop_token>
#include <vector>

#include "core/math/polygon.hpp"
#include "core/part/part.hpp"

namespace tubecut::part {

/// Both edges of a hole alone, with more rows between its own, straight on the developed surface:
/// where the torch leans across, the lines of such a row do not pass a radius within the wall
/// straight between those of its neighbours. Told to stop, it has some of them, or none.
[[nodiscard]] bevel::Hole closer_rows(const bevel::Hole& hole, const std::stop_token& stop);

/// Whether two holes share a piece of the wall: on the bore, in its middle or outside.
[[nodiscard]] bool holes_meet(const joint::Target& target, const bevel::Hole& a,
                              const bevel::Hole& b, const std::stop_token& stop = {});

/// A radius in the wall: the share u of the way from the bore out, its radius, and what it counts.
struct Ring {
  double u, rho, weight;
};
/// Radii for integrals over the wall: 16 Gauss points in v, u = v^2, for a hole's lines may graze
/// the bore, where all that follows from them goes as the root of u.
[[nodiscard]] std::vector<Ring> wall_rings(const joint::Target& target);

/// Area (rad mm) of the union of polygons (phi, z) between the cuts of both ends, at one ring.
[[nodiscard]] double area_between_cuts(const joint::Target& target, const Part& part,
                                       std::vector<math::Polygon> polygons, const Ring& ring,
                                       const std::stop_token& stop = {});

/// Volume that the holes take out of the wall between the two cuts, their own walls straight in
/// space from edge to edge, mm^3. What two holes share counts once, what lies beyond a cut not at
/// all.
///
/// Accuracy  for edges straight between their nodes 1e-9 of a hole, of one that leans across by far
///           apart rows (0.05 mm of sag) 1e-6; where holes meet, within 1e-3 of what they share:
///           its border has corners that move across the wall.
/// Source    docs/theory/parts.md, section 3.
[[nodiscard]] double holes_volume(const joint::Target& target, const Part& part,
                                  const std::stop_token& stop = {});

}  // namespace tubecut::part
