#pragma once

#include <string>
#include <vector>

/// Reference for core's tables: the same formulas written plainly, one station after the other, in
/// doubles on the C library. No events, no adaptive rows, no verification, only tubes as partners;
/// this is the minimum that every program of bevel tables computes.
/// Source  docs/theory/intersections-and-bevels.md.
namespace baseline {

/// Angles in rad, lengths in mm, as joint::TubeCutter.
struct Tube {
  double radius, inclination, clocking, offset, height;
};

struct End {
  double outer_radius, wall;
  std::vector<Tube> partners;
};

/// The cut on one surface, at phi = 2 pi i / n. Section 1.
struct Contour {
  std::vector<double> phi, z;
  std::vector<int> tube;
};
Contour contour(const std::vector<Tube>& tubes, double rho, int n);

/// And its angles, with a groove of half the dihedral, at most 45 deg. Section 2.
struct Angles {
  Contour at;
  std::vector<double> dihedral, groove, tau, gamma, flush, b;
};
Angles contour_with_angles(const std::vector<Tube>& tubes, double rho, int n);

/// Limits of the swing axis: rad/mm and rad/mm^2.
struct Limits {
  double slope, curvature;
};

/// The whole table, root on the inner wall, B smoothed by the braking envelope. Sections 3, 5, 6.2.
struct Table {
  Angles angles;
  std::vector<double> developed, length, required, b, z_outer, beam;
};
Table table(const End& end, const Limits& limits, int n);

/// Its columns as JSON, every number as short as it reads back the same, angles in degrees.
std::string json(const Table& table);

}  // namespace baseline
