#pragma once

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
  Track cut = {};  // the whole contour, even if only a part of it is cut, smooth between its points
  Scrap scrap = Scrap::minus_z;
  double outer_radius = 0.0;
  double inner_radius = 0.0;
  double sigma = -1.0;                 // sign of B in `cut`, as the machine counts it
  double sag = 0.0;                    // mm, largest distance of the contour's chords to `cut`
  double from_phi = 0.0;               // a point is reduced to the revolution that begins here
  std::vector<BorderWall> walls = {};  // inner, middle, outer
};

/// Computes the border of the part that `cut_path` cuts out. Between its points it inserts points
/// of the smooth curve through them, so that chords deviate from the curve by at most a few
/// micrometres. Corners stay: flagged, or turning by more than 20 deg. Its tangents are those of
/// the leads.
///
/// Errors  those of `track`; cancelled.
/// Source  docs/theory/pulse-schedules.md, section 2.3.
[[nodiscard]] Result<PartBorder> part_border(const CutPath& cut_path, double sigma);

/// Computes where the beam at a point meets the surface of radius `rho`, mm, developed there. If it
/// misses, returns its nearest point. On a section every depth is developed by the girth outside,
/// because lines normal to the outside do not cross: the side of the border stays right, distances
/// in corners come out longer than they are.
[[nodiscard]] Flat on_wall(const PartBorder& part, const CutPoint& point, double rho);

/// Computes how far, in mm, the beam at a point extends into the finished part, over both wall
/// surfaces and their middle. Negative: its distance. Zero on the cut itself. The torch line
/// already includes half the kerf.
[[nodiscard]] double intrusion(const PartBorder& part, const CutPoint& point);

}  // namespace tubecut::motion
