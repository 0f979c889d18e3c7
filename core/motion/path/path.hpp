#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/motion/machine/kinematics.hpp"
#include "core/motion/path/program.hpp"

namespace tubecut::motion {

/// The smoothed path: a uniform cubic B-spline, C2, with ends that permit a rest. Parameter u in
/// mm, 0..d*intervals.
struct Path {
  double d = 0.1;  // knot spacing, mm of generalised length
  std::vector<Coordinate> coordinates = {};
  std::vector<std::vector<double>> control = {};  // [coordinate][knot]
  double deviation_tip = 0.0;         // largest distance of a knot to the unsmoothed path, mm
  double deviation_b = 0.0;           // rad
  double sag_tip = 0.0;               // largest distance of the unsmoothed path to the polyline, mm
  double sag_b = 0.0;                 // rad
  std::vector<double> at_point = {};  // u of every point of the program, mm of generalised length

  [[nodiscard]] std::size_t intervals() const { return control.front().size() - 1; }
  /// Returns true if its first coordinate is the angle of a section's normal.
  [[nodiscard]] bool turns() const { return coordinates.front().group == Coordinate::Group::turn; }
  [[nodiscard]] double length() const { return d * static_cast<double>(intervals()); }
  /// Computes the coordinates at `offset` mm, 0..d, after knot `i`. Exact at both ends of the path.
  [[nodiscard]] Coordinates at(std::size_t i, double offset) const;
  /// Returns coordinate `c` on interval `i` by rising powers of the offset.
  [[nodiscard]] std::array<double, 4> cubic(std::size_t c, std::size_t i) const;
  /// Computes the same with three derivatives along u. If `bends` is set, also sin B and cos B.
  [[nodiscard]] Jet jet(std::size_t interval, double offset, bool bends) const;
};

/// Returns the uniform cubic B-spline of these control points at knot `j`; at both ends it is the
/// control point.
[[nodiscard]] double at_knot(const std::vector<double>& control, std::size_t j);

/// Returns the same spline between knot `i` and the next by rising powers of the offset, for knots
/// `d` mm apart.
[[nodiscard]] std::array<double, 4> cubic(const std::vector<double>& control, std::size_t i,
                                          double d);

/// Evaluates a path at a sequence of places; caches the cubic of the current interval.
class PathCursor {
 public:
  /// If `bends` is set, computes sin B and cos B.
  PathCursor(const Path& path, bool bends) : path_(path), bends_(bends) {}
  /// Bit-equal to `Path::at`.
  [[nodiscard]] Pose at(std::size_t interval, double offset);

 private:
  const Path& path_;
  bool bends_;
  std::size_t interval_ = static_cast<std::size_t>(-1);
  std::array<std::array<double, 4>, kMostCoordinates> cubic_ = {};
};

/// Applies two centred means of width 2m+1 with odd reflection at the ends; the ends are kept
/// exactly. If the input is reversed, the result is reversed bit by bit.
///
/// Source  docs/theory/pulse-schedules.md, section 2.4.
[[nodiscard]] std::vector<double> box2(const std::vector<double>& x, std::size_t m);

/// Computes the path: the limited Hermite curve through the program's points with its corners,
/// sampled about every 0.1 mm, then smoothed as far as the tolerances (mm, rad) permit.
///
/// Errors    out_of_range (tolerances below 1e-3 mm, 0.01 deg), too_many_nodes, cancelled.
/// Accuracy  knots within eps_tip and eps_b of the unsmoothed path, measured at every knot; the tip
///           between them within eps_tip and `sag_tip` of the polyline.
/// Source    docs/theory/pulse-schedules.md, sections 2.3 to 2.5.
[[nodiscard]] Result<Path> smooth_path(const Program& program, double eps_tip, Angle eps_b);

}  // namespace tubecut::motion
