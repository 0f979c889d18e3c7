#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/joint/contour.hpp"
#include "core/joint/section/section_place.hpp"

namespace tubecut::joint {

enum class SectionEventKind {
  junction,  // another cutter takes over, z continuous
  jump,      // the cutter is lost, or found, at its silhouette; z jumps
  kink,      // corner of one cutter's own curve: from = to
  seam       // the section's curvature jumps, and so does the second derivative of z
};

/// A place where the profile is not smooth. `from`, z_from just before it, `to`, z_to just after.
struct SectionEvent {
  SectionEventKind kind = SectionEventKind::junction;
  double s = 0.0;  // mm, [0, girth)
  double z_from = 0.0;
  double z_to = 0.0;
  std::size_t from = 0;
  std::size_t to = 0;
};

/// A part of the profile between neighbouring events: of one cutter, and on one flat or arc.
struct SectionSegment {
  double from = 0.0;  // s, [0, girth)
  double to = 0.0;    // > from, at most from + girth
  std::size_t cutter = 0;
};

/// The closed curve along which an outline, swept along z, leaves its cutters: z(s) = max_i z_i.
struct SectionContour {
  section::Curve curve;
  std::vector<PreparedCutter> cutters;
  std::vector<SectionEvent> events;         // ascending s
  std::vector<SectionSegment> segments;     // segment k begins at event k; without events: one
  Intervals open;                           // s; no cutter is hit: no segment, no event at its ends
  std::vector<std::size_t> missed;          // cutters no generator hits
  std::vector<std::size_t> near_parallel;   // within 5 deg of parallel
  std::vector<std::array<bool, 4>> grazed;  // by cutter: faces that its silhouette runs along

  /// Return the cutter's height at a place, as `continued_sheet`, and its hit, as `section_hit`.
  /// Along a face on its silhouette the sheet keeps half the digits and the normal has no axial
  /// part: there the height and the slope are those of the silhouette.
  [[nodiscard]] double height(std::size_t cutter, const section::Station& at) const;
  [[nodiscard]] Hit hit(std::size_t cutter, const section::Station& at) const;
  [[nodiscard]] bool grazes(std::size_t cutter, const section::Station& at) const {
    return !at.on_corner && grazed[cutter][static_cast<std::size_t>(at.face - 1)];
  }
};

/// Checks the cutters and finds the profile's exact division. Events on an arc are those of a round
/// target about the arc's centre; on a flat, silhouettes are linear and junctions quartics,
/// polished on z_i - z_j. An elbow is bracketed on a scan as dense as on a round target.
///
/// Errors    as `trace` of a round target; got of open_profile: s intervals in mm, one that crosses
///           the datum ends above the girth.
/// Accuracy  junction and jump s within 1e-9 mm; the lost z of a jump within 1e-5 mm.
/// Source    docs/theory/sections.md, section 2.
[[nodiscard]] Result<SectionContour> trace(std::span<const Cutter> cutters,
                                           const section::Curve& curve);
/// The same of an outline that need not meet a partner everywhere, or any.
[[nodiscard]] Result<SectionContour> trace_met(std::span<const Cutter> cutters,
                                               const section::Curve& curve);

/// Returns the segment that holds s ([0, girth)); at an event the one that begins there.
[[nodiscard]] const SectionSegment& segment_at(const SectionContour& contour, double s);

/// Returns height and cutter at s: the segment's cutter, unless another is higher by more than
/// rounding.
[[nodiscard]] Contact contact_at(const SectionContour& contour, const section::Station& at);

}  // namespace tubecut::joint
