#pragma once

#include <cstdint>
#include <span>
#include <tl/expected.hpp>
#include <vector>

#include "core/groove/mill.hpp"

namespace tubecut::groove {

/// One emitted position: linear axes against omega, B continuous. Ascending omega within one
/// revolution; after the last block follows the first.
struct Block {
  double omega = 0.0;       // rad
  double x = 0.0, z = 0.0;  // mm
  double b = 0.0;           // rad
};

/// The tool's motion between two blocks.
enum class Between : std::uint8_t {
  nothing,  // it cuts only at the blocks, as the source's figures assume
  linear,   // every axis runs linearly
};

/// An extreme figure and its position.
struct Extreme {
  double value = 0.0;    // mm
  Angle omega = {};      // of the point's ruling
  double level = 0.0;    // v on the groove, or the part of the root face below curve 3
  double station = 0.0;  // block index, with its fraction, of the tool that cuts deepest there
};

/// The workpiece after a whole revolution: distances to the deepest of all tool positions.
struct Swept {
  Extreme flank_min, flank_max;  // unbounded flank; min < 0 overcut, max > 0 uncut
  Extreme stock_left_max;        // finite cutter, on the groove surface
  Extreme root_face_min;         // finite cutter, on the root face; < 0: cut into
};

/// The points at which `swept` samples.
struct SweptPoints {
  int rulings = 360;
  int per_ruling = 11;  // v = i / (n - 1)
  int root_levels = 9;  // of the root face, from curve 3 to its bottom
};

/// Returns the tool at a station: block index with its fraction.
[[nodiscard]] Block block_at(std::span<const Block> blocks, double station);
[[nodiscard]] ToolPose pose_of(const Block& block, const Setup& setup);

/// Computes the swept error of the flank, the stock left and the root-face clearance.
///
/// Errors    of `section`; cancelled.
/// Accuracy  at each sampled point, the smallest distance over the motion within 1e-7 mm; there is
///           no guarantee between the points (a ruling per degree misses less than 4 % of a case's
///           figure).
/// Cost      about 4 ns for each point and block within a quarter turn of it, one or two distances
///           between the blocks of each, and a search for the few that the bounds do not decide:
///           5-15 ms.
/// Source    docs/theory/grooves-and-milling.md, 7 and 8.4.
[[nodiscard]] tl::expected<Swept, ErrorCode> swept(const JointGeometry& joint, const Cone& cone,
                                                   const Setup& setup,
                                                   std::span<const Block> blocks, Between between,
                                                   const SweptPoints& points);

}  // namespace tubecut::groove
