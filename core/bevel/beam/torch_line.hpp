#pragma once

#include <span>
#include <stop_token>
#include <vector>

#include "core/bevel/beam/beam.hpp"
#include "core/bevel/table/table.hpp"

namespace tubecut::bevel {

/// The narrowest kerf that the torch's line allows for, mm: what the beam takes is looked for at
/// places as near to each other as it is wide, and a gouge of this counts as none.
inline constexpr double kLeastKerf = kGougeLimit;

/// Errors  out_of_range (kerf): neither 0 nor kLeastKerf or more.
[[nodiscard]] inline Result<void> check_kerf(double kerf) {
  if (kerf == 0.0 || kerf >= kLeastKerf) return {};
  return fail({.code = ErrorCode::out_of_range,
               .member = "kerf",
               .got = kerf,
               .limit = kLeastKerf,
               .unit = "mm",
               .hint = "no beam is narrower; 0: none is laid off"});
}

/// The torch's line before its proof.
struct TorchLine {
  /// How far below the finished cut its axis runs at each row, mm along z: the least with which a
  /// round beam of the kerf's width, on its way straight from row to row, stays out of the finished
  /// part.
  std::vector<double> drops;
  /// Phases of rows that it still lacks to follow its least drop within the sampling's tolerance:
  /// at corners and jumps the drop changes within half a kerf. Empty without a kerf and with
  /// uniform rows alone.
  std::vector<double> rows;
};

/// The axis is parallel to the finished line of its row; with a root face the line is the bevel's,
/// and the beam stays out of the land too.
///
/// In the half plane of phi0 the beam leaves the point q = (rho, phi0 + D, z_q) untouched if and
/// only if its drop is at least
///     line(rho cos D) - z_q + sqrt(k^2/4 - rho^2 sin^2 D) / cos B,     rho |sin D| < k/2,
/// line(a) the finished line prolonged to the distance a from the tube's axis. The drop is the
/// largest of it over the finished surface. On a plane that is (k/2) sqrt(1 + tan^2 B + (dz/ds)^2)
/// with dz/ds the finished edge's own slope, the steeper where the edges differ; a corner, a jump
/// or a bend tighter than the kerf takes what it needs and no more.
///
/// Reads phi, z_inner, z_face and z_outer of the table. Between rows the drop is straight, so rows
/// are lowered where that would fall short.
/// Accuracy  gouges below 2e-3 mm between the places looked at across the wall and along it.
/// Cost      about 0.2 us a place, two or more of them a row, eight side by side; each row within
///           half a kerf of a place 10 ns a circle.
/// Source    docs/theory/intersections-and-bevels.md, section 5.6.
[[nodiscard]] TorchLine torch_line(const TableSpec& spec, const Table& table,
                                   const std::stop_token& stop = {});
/// Of the ways from rows to the next that are wanted alone: their bends, and drops that are of no
/// use.
[[nodiscard]] TorchLine torch_line(const TableSpec& spec, const Table& table,
                                   const std::vector<bool>& wanted, const std::stop_token& stop);
/// The ways from which the beam reaches rows at these phases, rad.
[[nodiscard]] std::vector<bool> ways_near(const TableSpec& spec, const Table& table,
                                          std::span<const double> phases);

}  // namespace tubecut::bevel
