#pragma once

#include <functional>
#include <stop_token>
#include <vector>

#include "core/base/error.hpp"

namespace tubecut::bevel {

/// A point on each of the two walls: phases in rad, heights in mm.
struct AcrossWall {
  double phi_inner, z_inner, phi_outer, z_outer;
  friend bool operator==(const AcrossWall&, const AcrossWall&) = default;
};

/// A cut as its rows state it: finished lines across the wall and the torch's axis, all straight
/// from row to row in phase and height, the last row joined to the first.
struct BeamCut {
  double inner = 0.0, outer = 0.0;  // radii
  double kerf = 0.0;
  double turn = 0.0;              // by how much the phases have grown after the last row: 2 pi or 0
  bool part_to_the_left = false;  // of the finished edge as it runs, seen from outside with phi to
                                  // the right and z up
  double from = 0.0;  // share of the wall, from the bore out, from which the beam makes the surface
  std::vector<AcrossWall> finished, torch;
  std::vector<double> land;  // z of the land at the bore, one a row; empty without one
};

/// What a round beam of the kerf's width takes from the finished part and what it leaves on it, mm:
/// the distance from the finished surface to the nearest axis, short of half a kerf and beyond it.
struct BeamProof {
  double gouge = 0.0, gouge_phi = 0.0;  // where: phase of the finished surface, rad
  double left = 0.0, left_phi = 0.0;
};

/// How densely the finished surface is sampled: every quarter of a kerf along the cut and its rows,
/// or only its rows, or three times as densely each way. Always against the axes at rows and
/// between them.
enum class SampleDensity { everywhere, rows, finely };

/// The proof, and by torch row the most that the beam takes on its way from it or to it, mm: rows
/// that stand off by as much more take nothing.
struct BeamFound {
  BeamProof proof;
  std::vector<double> gouged_from;
};

/// Measured in space, by distances between points and axes. A line counts from outside as far as
/// the tube's middle: what it does to the wall beyond is not seen. A beam of no width along the
/// finished lines takes and leaves nothing.
///
/// Accuracy  everywhere: gouge 1e-3 mm, left 5e-3 mm or 2 %. Rows: what is there, not all of it.
/// Cost      about 1 us a row, at least 0.3 ms; rows alone 0.5 us a row.
/// Source    docs/theory/intersections-and-bevels.md, section 5.6.
[[nodiscard]] BeamFound beam_found(const BeamCut& cut, SampleDensity density,
                                   const std::stop_token& stop = {});
[[nodiscard]] BeamProof beam_proof(const BeamCut& cut, SampleDensity density,
                                   const std::stop_token& stop = {});

inline constexpr double kGougeLimit = 0.01;  // mm

/// Two rows of a closed cut round a tube no further apart than its kerf: each pair is looked at, so
/// that cost grows as the square of the rows. 270 ns a pair: 1.4 s.
inline constexpr double kMostKerfPairs = 5e6;
[[nodiscard]] double kerf_pairs(double rows, double kerf, double radius);
/// Rows with so many pairs at most.
[[nodiscard]] std::size_t most_rows(double kerf, double radius);

/// By row, how much further the torch stands off than half a kerf, mm.
using Further = std::vector<double>;
/// Moves the torch's rows off the part until the beam takes no more than kGougeLimit of it
/// anywhere, or a kerf is not enough; `cut` is the cut with its rows moved, asked last for what it
/// keeps. Where any of a hole was moved its wall bends, and the proof looks three times as finely.
[[nodiscard]] BeamProof clear_torch(std::size_t rows,
                                    const std::function<BeamCut(const Further&)>& cut,
                                    const std::stop_token& stop = {});

struct TableSpec;
struct Table;
/// The cut of an end: with a root face the beam makes the bevel and must spare the land.
[[nodiscard]] BeamCut beam_cut(const TableSpec& spec, const Table& table);

struct HoleSpec;
struct Hole;
/// The cut of a hole: the part is all around it.
[[nodiscard]] BeamCut beam_cut(const HoleSpec& spec, const Hole& hole);

/// Errors  out_of_range (kerf): no row moved off could spare the part, where the wall bends tighter
///         than the kerf.
[[nodiscard]] Result<void> check_spared(const BeamCut& cut, const BeamProof& proof);

/// `gouge` against its limit, and what is stated of the torch line against the cut's own rows.
[[nodiscard]] std::vector<Check> verify_torch_line(const BeamCut& cut, const BeamProof& stated,
                                                   const std::stop_token& stop = {});

}  // namespace tubecut::bevel
