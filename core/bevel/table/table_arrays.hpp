#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/bevel/table/table.hpp"
#include "core/joint/solid_arrays.hpp"

/// What the proof of a table looks at, many rows side by side (base/lanes.hpp).
namespace tubecut::bevel {

/// Sines and cosines of many angles, side by side.
struct Directions {
  std::vector<double> sine, cosine;

  explicit Directions(std::span<const double> angles) : sine(angles.size()), cosine(angles.size()) {
    elementary::sincos(angles, sine, cosine);
  }
};

/// The rows in space. The tube's outward normal is (phi.cosine, phi.sine, 0).
struct RowNormals {
  const Directions& phi;
  joint::PointArrays partner;  // its outward normals at the root points
  std::vector<double> noise;   // of those, from the rounding of z
};
/// By the table's own z and the partners as solids.
[[nodiscard]] RowNormals row_normals(const TableSpec& spec, const Table& t,
                                     const std::vector<joint::Solid>& partners,
                                     const Directions& phi);

/// Angles between the tube's and the partner's surface by half tangents, rad: full accuracy near 0
/// and 180 degrees.
[[nodiscard]] std::vector<double> dihedrals(const RowNormals& rows, Dihedral dihedral);

/// Sines of the angles by which the torch lines of `b` leave the planes of tangent and bevel line,
/// beyond rounding: where both surfaces have one tangent plane the curve's tangent loses its
/// digits.
[[nodiscard]] std::vector<double> plane_errors(const RowNormals& rows, Dihedral dihedral,
                                               const Directions& tau, const Directions& b);

/// How many are no finite numbers.
[[nodiscard]] std::size_t not_finite(std::span<const double> values);

/// The finished surface between the rows.
class BetweenRows {
 public:
  BetweenRows(const TableSpec& spec, const Table& t);

  /// Phases at such shares of the ways from each row to the next, rad.
  [[nodiscard]] std::vector<double> phases(std::span<const double> share) const;
  /// Places there, at such radii, mm.
  [[nodiscard]] joint::PointArrays places(std::span<const double> share, const Directions& phi,
                                          std::span<const double> radius) const;

 private:
  double inner_, edge_, outer_;                           // radii; the land ends at edge_
  std::vector<double> phi_, z_inner_, z_edge_, z_outer_;  // the first row once more at the end
};

}  // namespace tubecut::bevel
