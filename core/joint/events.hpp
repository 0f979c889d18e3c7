#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/joint/cutters/cutter.hpp"

namespace tubecut::joint {

/// The cutter that holds the profile, and its height.
struct Contact {
  double z = 0.0;
  std::size_t cutter = 0;
};

/// Returns the highest contact of a generator, the lowest index on ties; empty when all cutters
/// miss.
[[nodiscard]] std::optional<Contact> highest(std::span<const PreparedCutter> cutters,
                                             const Generator& line);

enum class EventKind {
  junction,  // another cutter takes over, z continuous
  jump,      // the cutter is lost, or found, at its silhouette; z jumps
  kink       // corner of one cutter's own curve: from = to
};

/// A point where the profile is not smooth. `from`, z_from just before it, `to`, z_to just after.
struct Event {
  EventKind kind = EventKind::junction;
  double phi = 0.0;  // rad, [0, 2 pi)
  double z_from = 0.0;
  double z_to = 0.0;
  std::size_t from = 0;
  std::size_t to = 0;
};

/// A part of the profile between neighbouring events: smooth and of one cutter.
struct Segment {
  double from = 0.0;  // rad, [0, 2 pi)
  double to = 0.0;    // > from, at most from + 2 pi
  std::size_t cutter = 0;
};

/// The division of the whole circle. Segments and events ascend in phi; segment k begins at event
/// k. If there are no events, there is one segment [0, 2 pi].
struct Division {
  std::vector<Event> events;
  std::vector<Segment> segments;
  Intervals open;  // deg; no cutter is hit. If one crosses phi = 0, it ends above 360
  struct Hidden {
    std::size_t cutter;
    double phi;
  };
  std::optional<Hidden> hidden;  // an elbow's own bend hides a lower part of it: z would jump there
};

/// Computes the exact events of the profile max_i z_i on a surface of radius rho, in closed form:
/// silhouettes, corners, and the roots of z_i = z_j for every pair by a polynomial of degree 8
/// (tubes), 4 (tube and plane), 2 (planes) in e^{i phi}, polished on z_i - z_j. Parts in `open`
/// have no events at their borders and no segments.
///
/// If the curves of several cutters are equal to rounding, only the first counts.
///
/// An elbow's junctions are bracketed on a scan of 1440 phases and closed like the others.
///
/// If cancelled, returns an empty Division.
///
/// Accuracy  junction phi within 1e-12 rad; jump phi too, but its lost z only within 1e-5 mm (the
///           curve is vertical there).
/// Cost      quadratic in the number of cutters, about 20 us a pair.
/// Source    docs/theory/intersections-and-bevels.md, section 3.
[[nodiscard]] Division divide(std::span<const PreparedCutter> cutters, double rho);

}  // namespace tubecut::joint
