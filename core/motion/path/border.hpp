#pragma once

#include <stop_token>
#include <vector>

#include "core/motion/path/chords.hpp"
#include "core/motion/path/cut_path.hpp"

namespace tubecut::motion {

/// A part's border on one surface of its wall.
struct BorderWall {
  double rho = 0.0;  // mm
  Chords line;
};

/// The finished part's border and the side of it that falls away.
struct PartBorder {
  Track cut = {};  // the whole contour, whatever stretch of it is cut, smooth between its points
  Scrap scrap = Scrap::minus_z;
  double outer_radius = 0.0;
  double inner_radius = 0.0;
  double sigma = -1.0;                 // of the machine that counts the B of `cut`
  double sag = 0.0;                    // mm, largest distance of the contour's chords to `cut`
  double from_phi = 0.0;               // a point is seen from the turn that begins here
  std::vector<BorderWall> walls = {};  // inner, middle, outer
};

/// The border of the part that `cut_path` cuts out: between its points lie points of the smooth
/// curve through them, so that chords leave the curve by no more than a few micrometres. Corners
/// stay: flagged, or turning by more than 20 deg. Its tangents are those of the leads.
///
/// Errors  those of `track`; cancelled.
/// Source  docs/theory/pulse-schedules.md, section 2.3.
[[nodiscard]] Result<PartBorder> part_border(const CutPath& cut_path, double sigma,
                                             const std::stop_token& stop);

/// Where the beam at a point meets the surface of radius `rho`, mm, developed there. One that
/// grazes past it: its nearest place.
[[nodiscard]] Flat on_wall(const PartBorder& part, const CutPoint& point, double rho);

/// How far, in mm, the beam at a point reaches into the finished part, over both wall surfaces and
/// their middle. Negative: how far it stays away. Zero on the cut itself. Half the kerf is in the
/// torch line already.
[[nodiscard]] double intrusion(const PartBorder& part, const CutPoint& point,
                               const std::stop_token& stop = {});

}  // namespace tubecut::motion
