#pragma once

#include <stop_token>
#include <vector>

#include "core/motion/contour.hpp"

namespace tubecut::motion {

/// A cut with its run-in and run-out, all on the contour's surface. Point `cut_first` is the first
/// of the cut, `cut_last` the last (overcut included).
struct Led {
  std::vector<ContourPoint> points = {};
  std::size_t cut_first = 0;
  std::size_t cut_last = 0;
};

/// The finished part's border and the side of it that falls away.
struct PartBorder {
  Track cut = {};  // the whole contour, whatever stretch of it is cut, as smooth_border gives it
  Scrap scrap = Scrap::minus_z;
  double outer_radius = 0.0;
  double inner_radius = 0.0;
  double sigma = -1.0;  // of the machine that counts the B of `cut`
  double sag = 0.0;     // mm, largest distance of the contour's chords to `cut`
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
[[nodiscard]] Led with_lead(const Track& cut, const Lead& lead, Scrap scrap,
                            LeadBevel bevel = LeadBevel::held);

/// A closed track with points of the smooth curve through its own put between them, so that chords
/// leave the curve by no more than a few micrometres, and how far its own chords leave it. Corners
/// stay: flagged, or turning by more than 20 deg. Its tangents are those of the leads.
///
/// Source  docs/theory/pulse-schedules.md, section 2.3.
struct SmoothTrack {
  Track track = {};
  double sag = 0.0;  // mm
};
[[nodiscard]] SmoothTrack smooth_border(const Track& track);

/// How far, in mm, the beam at a point reaches into the finished part, over both wall surfaces and
/// their middle. Negative: how far it stays away. Zero on the cut itself. Half the kerf is in the
/// torch line already.
[[nodiscard]] double intrusion(const PartBorder& part, const ContourPoint& point,
                               const std::stop_token& stop = {});

}  // namespace tubecut::motion
