#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/bevel/table/table.hpp"
#include "core/joint/solid_arrays.hpp"

/// The quantities for the verification of a table, for many rows at once (base/lanes.hpp).
namespace tubecut::bevel {

/// Sines and cosines of many angles.
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
/// Computes them from the table's own z and the partners as solids.
[[nodiscard]] RowNormals row_normals(const TableSpec& spec, const Table& t,
                                     const std::vector<joint::Solid>& partners,
                                     const Directions& phi);

/// Computes the angles between the tube's and the partner's surface by half tangents, rad: full
/// accuracy near 0 and 180 degrees.
[[nodiscard]] std::vector<double> dihedrals(const RowNormals& rows, Dihedral dihedral);

/// Computes the sines of the angles by which the torch lines of `b` leave the planes of tangent and
/// bevel line, beyond rounding, because the curve's tangent loses its digits where both surfaces
/// have one tangent plane.
[[nodiscard]] std::vector<double> plane_errors(const RowNormals& rows, Dihedral dihedral,
                                               const Directions& tau, const Directions& b);

/// Returns the number of values that are not finite.
[[nodiscard]] std::size_t not_finite(std::span<const double> values);

/// The finished surface between the rows.
class BetweenRows {
 public:
  BetweenRows(const TableSpec& spec, const Table& t);

  /// Returns the phases at these fractions of the paths from each row to the next, rad.
  [[nodiscard]] std::vector<double> phases(std::span<const double> share) const;
  /// Returns the points there, at these radii, mm.
  [[nodiscard]] joint::PointArrays places(std::span<const double> share, const Directions& phi,
                                          std::span<const double> radius) const;

 private:
  double inner_, edge_, outer_;                           // radii; the land ends at edge_
  std::vector<double> phi_, z_inner_, z_edge_, z_outer_;  // with the first row repeated at the end
};

}  // namespace tubecut::bevel
