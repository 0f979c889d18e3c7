#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

#include "core/motion/path/border.hpp"
#include "core/motion/path/cut_path.hpp"

namespace tubecut::motion {

struct Lead {
  /// An arc that runs into the cut, or straight across onto it: beside a tab an arc would reach
  /// over what holds. Behind a cut that is come onto so there is nothing.
  enum class Shape : std::uint8_t { arc, square };
  Shape shape = Shape::arc;
  double radius = 5.0;  // of the arcs; square: how far off it begins
  Angle sweep = Angle::deg(60);
  double overcut = 5.0;                // mm of the contour cut again; closed contours only
  std::optional<Angle> pierce_b = {};  // largest |B| at the pierce; empty: the cut's own B
  double fan = 10.0;                   // mm over which B goes from the pierce's to the cut's
};

/// A lead may reach this far behind the border, mm: rounding of the tangent at the join. Where the
/// contour's chords leave its curve, join and tangent are no better than that: see `lead_touch`.
inline constexpr double kLeadTouch = 0.02;

/// A cut with its run-in and run-out, all on the contour's surface. Point `cut_first` is the first
/// of the cut, `cut_last` the last (overcut included).
struct CutWithLead {
  std::vector<CutPoint> points = {};
  std::size_t cut_first = 0;
  std::size_t cut_last = 0;
  bool stretch = false;  // of a closed contour: it ends elsewhere than it begins
};

/// B on a lead: that of the join, or what the closed cut itself has as far before its start or past
/// its end. A held beam enters the part by R (t dB/ds)^2 / 2 where B swings on a wall of t; the
/// cut's own B runs beside its own surface.
enum class LeadBevel { held, followed };

/// Lead-in arc (after a straight run where the fan of B needs it), the cut, its overcut, lead-out
/// arc. The arcs are tangent to the cut and lie on the scrap side of the developed surface; the fan
/// ends before the cut begins. Square: straight in from that side, and nothing behind.
///
/// Source  docs/theory/pulse-schedules.md, section 2.6.
[[nodiscard]] CutWithLead with_lead(const Track& cut, const Lead& lead, Scrap scrap,
                                    LeadBevel bevel = LeadBevel::held);

/// How far a lead may reach behind the border, mm: kLeadTouch and the contour's sag, this no more
/// than the tolerance of the motion.
[[nodiscard]] double lead_touch(const PartBorder& border, double eps_tip);

/// Every point of both leads stays clear of the finished part, of a closed border.
///
/// Errors  lead_blocked (with phi), cancelled.
[[nodiscard]] Result<void> check_clear(const CutWithLead& cut, const PartBorder& part,
                                       double eps_tip, const std::stop_token& stop);

/// The cut with its leads, clear of the part: with the bevel of the join where that is, else with
/// what the cut has beside it.
///
/// Errors  lead_blocked (with phi), cancelled.
[[nodiscard]] Result<CutWithLead> clear_lead(const PartBorder& border, const Track& cut,
                                             const Lead& lead, double eps_tip,
                                             const std::stop_token& stop);

}  // namespace tubecut::motion
