#pragma once

#include <cstddef>
#include <optional>
#include <stop_token>
#include <vector>

#include "core/motion/cut_path.hpp"

namespace tubecut::motion {

struct Lead {
  double radius = 5.0;
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
};

/// B on a lead: that of the join, or what the closed cut itself has as far before its start or past
/// its end. A held beam enters the part by R (t dB/ds)^2 / 2 where B swings on a wall of t; the
/// cut's own B runs beside its own surface.
enum class LeadBevel { held, followed };

/// Lead-in arc (after a straight run where the fan of B needs it), the cut, its overcut, lead-out
/// arc. The arcs are tangent to the cut and lie on the scrap side of the developed surface; the fan
/// ends before the cut begins.
///
/// Source  docs/theory/pulse-schedules.md, section 2.6.
[[nodiscard]] CutWithLead with_lead(const Track& cut, const Lead& lead, Scrap scrap,
                                    LeadBevel bevel = LeadBevel::held);

/// The finished part's border and the side of it that falls away.
struct PartBorder {
  Track cut = {};  // the whole contour, whatever stretch of it is cut, smooth between its points
  Scrap scrap = Scrap::minus_z;
  double outer_radius = 0.0;
  double inner_radius = 0.0;
  double sigma = -1.0;             // of the machine that counts the B of `cut`
  double sag = 0.0;                // mm, largest distance of the contour's chords to `cut`
  std::vector<double> tan_b = {};  // of each point of `cut`
  double from_phi = 0.0;           // a point is seen from the turn that begins here
};

/// The border of the part that `cut_path` cuts out: between its points lie points of the smooth
/// curve through them, so that chords leave the curve by no more than a few micrometres. Corners
/// stay: flagged, or turning by more than 20 deg. Its tangents are those of the leads.
///
/// Errors  those of `track`.
/// Source  docs/theory/pulse-schedules.md, section 2.3.
[[nodiscard]] Result<PartBorder> part_border(const CutPath& cut_path, double sigma);

/// How far, in mm, the beam at a point reaches into the finished part, over both wall surfaces and
/// their middle. Negative: how far it stays away. Zero on the cut itself. Half the kerf is in the
/// torch line already.
[[nodiscard]] double intrusion(const PartBorder& part, const CutPoint& point,
                               const std::stop_token& stop = {});

/// How far a lead may reach behind the border, mm: kLeadTouch and the contour's sag, this no more
/// than the tolerance of the motion.
[[nodiscard]] double lead_touch(const PartBorder& border, double eps_tip);

/// Every point of both leads stays clear of the finished part, of a closed border.
///
/// Errors  lead_blocked (with phi), cancelled.
[[nodiscard]] Result<void> check_clear(const CutWithLead& cut, const PartBorder& part,
                                       double eps_tip, const std::stop_token& stop);

}  // namespace tubecut::motion
