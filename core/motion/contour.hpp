#pragma once

#include <vector>

#include "core/motion/spec.hpp"

namespace tubecut::motion {

/// One point of a contour; what `Contour` holds as columns.
struct ContourPoint {
  double phi = 0.0;
  double z = 0.0;
  double b = 0.0;
  bool corner = false;
  double beam = 0.0;
};

/// A contour as a row of points, closed ones with their first point repeated at the end, one turn
/// on.
struct Track {
  std::vector<ContourPoint> points = {};
  double radius = 0.0;  // of the surface the points lie on
  bool closed = false;
  int turns = 0;

  /// Distance of two points along the developed surface, mm; B plays no part.
  [[nodiscard]] double tip_step(std::size_t from, std::size_t to) const;
  /// +1 where phi grows along the track (or, of a hole, where it runs counter-clockwise in (phi,
  /// z)), else -1.
  [[nodiscard]] int orientation() const;
};

/// Checks the contour and closes it.
///
/// Errors  bad_number, wrong_count, angle_out_of_range, duplicate_point, not_closed, out_of_range.
/// Source  docs/theory/pulse-schedules.md, section 2.1.
[[nodiscard]] Result<Track> track(const Contour& contour);

/// The closed track in the asked direction and from the asked start point.
///
/// Errors  out_of_range (no point at the asked phi), unsupported_combination (an open track has no
/// start to choose).
[[nodiscard]] Result<Track> directed(Track track, const Motion& motion);

/// The stretch of a closed track between two angles in its direction, with `back_up` mm before it.
///
/// Errors  unsupported_combination (holes and open tracks), out_of_range.
[[nodiscard]] Result<Track> sector_of(const Track& whole, const Sector& sector);

/// The first `length` mm of a track, its start point included.
[[nodiscard]] std::vector<ContourPoint> first_stretch(const Track& track, double length);

}  // namespace tubecut::motion
