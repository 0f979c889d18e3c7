#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <tl/expected.hpp>
#include <vector>

#include "core/groove/mill.hpp"

namespace tubecut::groove {

/// One emitted position: linear axes against omega, B without jumps of a turn. Ascending omega
/// within one turn; the last block runs on into the first.
struct Block {
  double omega = 0.0;       // rad
  double x = 0.0, z = 0.0;  // mm
  double b = 0.0;           // rad
};

/// What the tool does between two blocks.
enum class Between : std::uint8_t {
  nothing,  // it cuts at the blocks alone, as the source's figures assume
  linear,   // every axis runs linearly
};

/// An extreme figure and where it is met.
struct Extreme {
  double value = 0.0;    // mm
  Angle omega = {};      // of the point's ruling
  double level = 0.0;    // v on the groove, or the part of the root face below curve 3
  double station = 0.0;  // block index, with its fraction, of the tool that cuts deepest there
};

/// What a whole revolution leaves on the workpiece: distances to the deepest of all tool positions.
struct Swept {
  Extreme flank_min, flank_max;  // unbounded flank; min < 0 overcut, max > 0 uncut
  Extreme stock_left_max;        // finite cutter, on the groove surface
  Extreme root_face_min;         // finite cutter, on the root face; < 0: cut into
};

/// The points `swept` looks at.
struct SweptPoints {
  int rulings = 360;
  int per_ruling = 11;  // v = i / (n - 1)
  int root_levels = 9;  // of the root face, from curve 3 to its bottom
};

/// Tool at a station: block index with its fraction.
[[nodiscard]] Block block_at(std::span<const Block> blocks, double station);
[[nodiscard]] ToolPose pose_of(const Block& block, const Setup& setup);

/// Swept error of the flank, stock left and root-face clearance.
///
/// Errors    of `section`; cancelled.
/// Accuracy  at each point looked at, the least distance over the motion within 1e-7 mm; between
///           the points nothing is said (a ruling per degree misses less than 4 % of a case's
///           figure).
/// Cost      about 4 ns for each point and block within a quarter turn of it, one or two distances
///           between the blocks of each, and a search there for the few that bounds leave: 5-15 ms.
/// Source    docs/theory/grooves-and-milling.md, 7 and 8.4.
[[nodiscard]] tl::expected<Swept, ErrorCode> swept(const Joint& joint, const Cone& cone,
                                                   const Setup& setup,
                                                   std::span<const Block> blocks, Between between,
                                                   const SweptPoints& points, std::stop_token stop);

}  // namespace tubecut::groove
