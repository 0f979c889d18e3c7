#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/motion/path/border.hpp"
#include "core/motion/path/cut_path.hpp"

namespace tubecut::motion {

struct Lead {
  /// An arc that runs into the cut, or a straight line across onto it. At a tab the lead is
  /// straight, because an arc would cross the tab. A cut with a straight lead-in has no lead-out.
  enum class Shape : std::uint8_t { arc, square };
  Shape shape = Shape::arc;
  double radius = 5.0;  // of the arcs; square: the distance at which it begins
  Angle sweep = Angle::deg(60);
  double overcut = 5.0;                // mm of the contour cut again; only for closed contours
  std::optional<Angle> pierce_b = {};  // largest |B| at the pierce; empty: the cut's own B
  double fan = 10.0;                   // mm over which B changes from the pierce's to the cut's
};

/// The maximum distance of a lead beyond the border, mm: rounding of the tangent at the join. If
/// the contour's chords deviate from its curve, join and tangent have only that accuracy: see
/// `lead_touch`.
inline constexpr double kLeadTouch = 0.02;

/// A cut with its lead-in and lead-out, all on the contour's surface. Point `cut_first` is the
/// first of the cut, `cut_last` the last (overcut included).
struct CutWithLead {
  std::vector<CutPoint> points = {};
  std::size_t cut_first = 0;
  std::size_t cut_last = 0;
  bool stretch = false;  // of a closed contour: its end differs from its start
};

/// B on a lead: that of the join, or that of the closed cut itself at the same distance before its
/// start or after its end. A held beam enters the part by R (t dB/ds)^2 / 2 if B swings on a wall
/// of t; the cut's own B stays next to its own surface.
enum class LeadBevel { held, followed };

/// Returns the lead-in arc (after a straight run if the fan of B needs it), the cut, its overcut,
/// and the lead-out arc. The arcs are tangent to the cut and lie on the scrap side of the developed
/// surface; the fan ends before the cut begins. Square: a straight line in from that side, without
/// lead-out.
///
/// Source  docs/theory/pulse-schedules.md, section 2.6.
[[nodiscard]] CutWithLead with_lead(const Track& cut, const Lead& lead, Scrap scrap,
                                    LeadBevel bevel = LeadBevel::held);

/// Returns how far a lead may extend beyond the border, mm: kLeadTouch plus the contour's sag,
/// which counts at most as the tolerance of the motion.
[[nodiscard]] double lead_touch(const PartBorder& border, double eps_tip);

/// Checks that every point of both leads is clear of the finished part, of a closed border.
///
/// Errors  lead_blocked (with phi), cancelled.
[[nodiscard]] Result<void> check_clear(const CutWithLead& cut, const PartBorder& part,
                                       double eps_tip);

/// Returns the cut with its leads, clear of the part: with the bevel of the join if that is clear,
/// else with that of the adjacent cut.
///
/// Errors  lead_blocked (with phi), cancelled.
[[nodiscard]] Result<CutWithLead> clear_lead(const PartBorder& border, const Track& cut,
                                             const Lead& lead, double eps_tip);

}  // namespace tubecut::motion
