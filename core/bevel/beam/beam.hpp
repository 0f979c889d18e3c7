#pragma once

#include <functional>
#include <vector>

#include "core/base/error.hpp"

namespace tubecut::bevel {

/// A point on each of the two walls: phases in rad, heights in mm.
struct AcrossWall {
  double phi_inner, z_inner, phi_outer, z_outer;
  friend bool operator==(const AcrossWall&, const AcrossWall&) = default;
};

/// A cut as its rows state it: finished lines across the wall and the torch's axis, all straight
/// from row to row in phase and height; the last row is joined to the first.
struct BeamCut {
  double inner = 0.0, outer = 0.0;  // radii
  double kerf = 0.0;
  double turn = 0.0;              // the growth of the phases after the last row: 2 pi or 0
  bool part_to_the_left = false;  // of the finished edge in its direction, seen from outside with
                                  // phi to the right and z up
  double from =
      0.0;  // fraction of the wall, from the bore out, at which the surface made by the beam begins
  std::vector<AcrossWall> finished, torch;
  std::vector<double> land;  // z of the land at the bore, one per row; empty without a land
};

/// The depth that a round beam of the kerf's width removes from the finished part, and the height
/// that it leaves on it, mm: the distance from the finished surface to the nearest axis, below and
/// above half a kerf.
struct BeamProof {
  double gouge = 0.0,
         gouge_phi = 0.0;  // the maximum and its position: phase of the finished surface, rad
  double left = 0.0, left_phi = 0.0;
};

/// The density of samples on the finished surface: every quarter of a kerf along the cut and its
/// rows, or only its rows, or three times as dense in each direction. All are compared with the
/// axes at rows and between them.
enum class SampleDensity { everywhere, rows, finely };

/// The result, and for each torch row the most that the beam removes on its path from it or to it,
/// mm: rows that move away by as much remove nothing.
struct BeamFound {
  BeamProof proof;
  std::vector<double> gouged_from;
};

/// Measures the cut in space, by distances between points and axes. A line counts from outside to
/// the tube's middle: its effect on the opposite wall is ignored. A beam of zero width along the
/// finished lines removes and leaves nothing.
///
/// Accuracy  everywhere: gouge 1e-3 mm, left 5e-3 mm or 2 %. Rows: only the values at the rows.
/// Cost      about 1 us a row, at least 0.3 ms; only rows: 0.5 us a row.
/// Source    docs/theory/intersections-and-bevels.md, section 5.6.
[[nodiscard]] BeamFound beam_found(const BeamCut& cut, SampleDensity density);
[[nodiscard]] BeamProof beam_proof(const BeamCut& cut, SampleDensity density);

inline constexpr double kGougeLimit = 0.01;  // mm

/// Maximum number of pairs of rows within a kerf of each other, for a closed cut around a tube.
/// Each pair is checked, so the cost grows with the square of the rows: 270 ns a pair, 1.4 s.
inline constexpr double kMostKerfPairs = 5e6;
[[nodiscard]] double kerf_pairs(double rows, double kerf, double radius);
/// Returns the maximum number of rows with this many pairs.
[[nodiscard]] std::size_t most_rows(double kerf, double radius);

/// For each row, the distance of the torch beyond half a kerf, mm.
using Further = std::vector<double>;
/// Moves the torch's rows off the part until the beam removes at most kGougeLimit everywhere, or a
/// kerf is not enough. `cut` returns the cut with its rows moved; its last call is for the result.
/// If a row of a hole was moved, its wall bends, and the check samples three times as densely.
[[nodiscard]] BeamProof clear_torch(std::size_t rows,
                                    const std::function<BeamCut(const Further&)>& cut);

struct TableSpec;
struct Table;
/// Returns the cut of an end; with a root face, the beam makes the bevel and must spare the land.
[[nodiscard]] BeamCut beam_cut(const TableSpec& spec, const Table& table);

struct HoleSpec;
struct Hole;
/// Returns the cut of a hole: the part surrounds it.
[[nodiscard]] BeamCut beam_cut(const HoleSpec& spec, const Hole& hole);

/// Errors  out_of_range (kerf): the wall bends tighter than the kerf, so no moved row spares the
///         part.
[[nodiscard]] Result<void> check_spared(const BeamCut& cut, const BeamProof& proof);

/// Checks `gouge` against its limit, and the stated values of the torch line against the cut's own
/// rows.
[[nodiscard]] std::vector<Check> verify_torch_line(const BeamCut& cut, const BeamProof& stated);

}  // namespace tubecut::bevel
