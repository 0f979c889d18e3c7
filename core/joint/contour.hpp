#pragma once

#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/joint/cutters/cutter.hpp"
#include "core/joint/events.hpp"

namespace tubecut::joint {

/// A wall that passes beside its partners by at most this is no overhang, because the coordinates
/// of models are rounded, and a post is often as wide as its rail.
inline constexpr double kSlightOverhang = 0.1;  // mm: of models with one decimal

/// The closed curve along which a surface of the target leaves its cutters: z(phi) = max_i z_i.
struct Contour {
  double radius = 0.0;  // rho of the surface, mm
  std::vector<PreparedCutter> cutters;
  std::vector<Event> events;               // ascending phi
  std::vector<Segment> segments;           // see Division
  std::vector<std::size_t> missed;         // cutters that no generator hits (warning cutter_missed)
  std::vector<std::size_t> near_parallel;  // within 5 deg of parallel (warning near_parallel)
};

/// Checks the cutters and finds the profile's exact division.
///
/// Errors    wrong_count (no cutter), out_of_range, zero_length, parallel_axes (cutters/i...);
///           no_contact, open_profile (cutters; got = phi intervals in deg; if one crosses 0, it
///           ends above 360); unsupported_combination (an elbow that hides a part of itself; got =
///           phi).
/// Source    docs/theory/intersections-and-bevels.md, sections 1.2 and 3.
[[nodiscard]] Result<Contour> trace(std::span<const Cutter> cutters, double rho);

/// Returns the segment that contains phi (rad, [0, 2 pi)); at an event, the one that begins there.
[[nodiscard]] const Segment& segment_at(const Contour& contour, double phi);

/// Computes height and cutter at phi: the segment's cutter, unless another is higher by more than
/// rounding.
[[nodiscard]] Contact contact_at(const Contour& contour, double phi);

}  // namespace tubecut::joint
