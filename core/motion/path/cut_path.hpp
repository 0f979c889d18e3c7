#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"
#include "core/motion/machine/machine.hpp"
#include "core/motion/path/straight_edges.hpp"
#include "core/section/section.hpp"

namespace tubecut::motion {

enum class Surface : std::uint8_t { outer, inner };
/// The side of the cut that falls away; the kept part is on the other.
enum class Scrap : std::uint8_t { minus_z, plus_z, inside };

/// The line that the torch follows on one wall surface, a request's `contour`. Columns of one
/// length, rad and mm.
///
/// Frame   z along the tube into the kept part, phi from x towards y, unwrapped. `b` is the beam's
///         angle to the radial direction in the axial plane *as the machine counts it* (positive
///         towards sigma * z): see `as_machine_counts`.
struct CutPath {
  std::vector<double> phi = {};
  std::vector<double> z = {};
  std::vector<double> b = {};
  std::vector<double> a = {};     // the beam's tilt across, towards growing phi; empty: 0
  std::vector<bool> corner = {};  // empty, or one per point
  std::vector<double> beam = {};  // metal along the beam, mm; empty: wall / cos b
  double outer_radius = 0.0;
  double wall = 0.0;  // 0: there is only this surface
  Surface surface = Surface::outer;
  bool closed = true;
  Scrap scrap = Scrap::minus_z;
  /// Of a tube that is not round: its section. The points lie on its outside, phi counts its girth
  /// over `outer_radius`, and the other lengths are those of `around`.
  std::optional<section::Section> section = {};
  /// Of a section whose tube is still along the whole path: the direction that points up, rad,
  /// counted as `Upright::angle`. Empty: the normal of the outside points up.
  std::optional<double> still = {};

  [[nodiscard]] double radius() const {
    return surface == Surface::outer ? outer_radius : outer_radius - wall;
  }
  [[nodiscard]] double inner_radius() const { return outer_radius - wall; }
};

/// Converts a path with `b` in the project's sign (B > 0: outer edge further into the part) to the
/// machine's sign.
[[nodiscard]] CutPath as_machine_counts(CutPath cut_path, BPositive b_positive);

struct Start {
  enum class At : std::uint8_t { first_point, phi, automatic };
  At at = At::first_point;
  Angle phi = {};
  std::optional<Angle> seam = {};  // an automatic start avoids it like a corner
};

/// The distance of an automatic start from corners and the seam, mm, if the contour has room; on a
/// section also from the corners of the tube, because a lead on a flat turns no axis.
inline constexpr double kFromJunction = 5.0;

enum class Direction : std::uint8_t { as_given, ccw, cw };

/// A part of a closed cut, to be cut again after a lost arc.
struct Sector {
  Angle from = {};
  Angle to = {};
  double back_up = 5.0;  // mm before `from`
};

/// One point of a cut path; `CutPath` stores the same as columns.
struct CutPoint {
  double phi = 0.0;
  double z = 0.0;
  double b = 0.0;
  bool corner = false;
  double beam = 0.0;
  double a = 0.0;
};

/// A cut path as a list of points; closed ones repeat their first point at the end, one revolution
/// on.
struct Track {
  std::vector<CutPoint> points = {};
  double radius = 0.0;  // of the surface that contains the points
  bool closed = false;
  int turns = 0;        // of a part of a track: the orientation of the whole
  WallRadii wall = {};  // for points on the outer surface: the wall that their beams cross
  std::optional<section::Section> section = {};  // of a tube that is not round
  std::optional<double> still = {};              // as of its path

  /// Returns the distance of two points along the developed surface, mm; B is ignored.
  [[nodiscard]] double tip_step(std::size_t from, std::size_t to) const;
  /// Returns +1 if phi grows along the track (or if a hole runs counter-clockwise in (phi, z)),
  /// else -1.
  [[nodiscard]] int orientation() const;
};

/// Checks the path and closes it.
///
/// Errors  bad_number, wrong_count, angle_out_of_range, duplicate_point, turns_back, not_closed,
///         out_of_range.
/// Source  docs/theory/pulse-schedules.md, section 2.1.
[[nodiscard]] Result<Track> track(const CutPath& cut_path);

/// Returns the path with the tube turned on by so many rad, whole revolutions.
[[nodiscard]] CutPath turned_on(CutPath path, double turns);

/// Returns the path without repeated positions of the torch, as at a jump of the finished edge;
/// their corners move to the previous point.
[[nodiscard]] CutPath without_repeats(CutPath path);

/// Returns the track in the requested direction and from the requested start point.
///
/// Errors  out_of_range (no point at the requested phi), unsupported_combination (the start of an
///         open track is fixed).
[[nodiscard]] Result<Track> directed(Track track, Direction direction, const Start& start);

/// Returns the part of a closed track between two angles in its direction, with `back_up` mm before
/// it.
///
/// Errors  unsupported_combination (holes and open tracks), out_of_range.
[[nodiscard]] Result<Track> sector_of(const Track& whole, const Sector& sector);

/// Returns the distance from each point of a closed track along it to its nearest corner, mm; very
/// large without corners.
[[nodiscard]] std::vector<double> from_corner(const Track& track);

}  // namespace tubecut::motion
