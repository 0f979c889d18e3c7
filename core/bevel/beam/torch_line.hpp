#pragma once

#include <span>
#include <vector>

#include "core/bevel/beam/beam.hpp"
#include "core/bevel/table/table.hpp"

namespace tubecut::bevel {

/// The narrowest kerf that the torch's line permits, mm, because the beam is sampled at points as
/// near to each other as it is wide, and a gouge of this size counts as 0.
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

/// The torch's line before its verification.
struct TorchLine {
  /// The drop of its axis below the finished cut at each row, mm along z: the smallest with which a
  /// round beam of the kerf's width, straight from row to row, stays out of the finished part.
  std::vector<double> drops;
  /// Phases of rows that it still lacks to follow its smallest drop within the sampling's
  /// tolerance, because at corners and jumps the drop changes within half a kerf. Empty without a
  /// kerf and if there are only uniform rows.
  std::vector<double> rows;
};

/// Computes the torch's line. The axis is parallel to the finished line of its row; with a root
/// face the line is the bevel's, and the beam stays out of the land too.
///
/// In the half plane of phi0 the beam leaves the point q = (rho, phi0 + D, z_q) untouched if and
/// only if its drop is at least
///     line(rho cos D) - z_q + sqrt(k^2/4 - rho^2 sin^2 D) / cos B,     rho |sin D| < k/2,
/// line(a) the finished line extended to the distance a from the tube's axis. The drop is its
/// maximum over the finished surface. On a plane that is (k/2) sqrt(1 + tan^2 B + (dz/ds)^2) with
/// dz/ds the finished edge's own slope, the steeper if the edges differ; a corner, a jump or a bend
/// tighter than the kerf gets exactly the drop that it requires.
///
/// Reads phi, z_inner, z_face and z_outer of the table. Between rows the drop is straight, so rows
/// are lowered if that would fall short.
/// Accuracy  gouges below 2e-3 mm between the samples across the wall and along it.
/// Cost      about 0.2 us a sample, two or more of them a row, eight in parallel; each row within
///           half a kerf of a sample 10 ns a circle.
/// Source    docs/theory/intersections-and-bevels.md, section 5.6.
[[nodiscard]] TorchLine torch_line(const TableSpec& spec, const Table& table);
/// Computes only the paths from wanted rows to the next: their bends, and drops that have no
/// meaning.
[[nodiscard]] TorchLine torch_line(const TableSpec& spec, const Table& table,
                                   const std::vector<bool>& wanted);
/// Returns the paths from which the beam reaches rows at these phases, rad.
[[nodiscard]] std::vector<bool> ways_near(const TableSpec& spec, const Table& table,
                                          std::span<const double> phases);

}  // namespace tubecut::bevel
