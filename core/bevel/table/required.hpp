#pragma once

#include <span>
#include <vector>

#include "core/joint/cutters/cutter.hpp"
#include "core/joint/stations.hpp"

namespace tubecut::bevel {

using joint::Wall;

/// Computes the smallest B (rad, in [-pi/2, pi/2]) with which a cut whose root lies on the inner
/// surface at height `z_root` enters no cutter within the wall, for one phi.
///
/// `z_root` is the profile's height on the inner surface there (at a jump one call for each side).
/// `inner_line` is the generator on the inner surface. If the result is -pi/2, there is no limit;
/// if it is +pi/2, no torch angle is sufficient.
/// Accuracy  closed form, 1e-9 rad; if a cutter touches the root tangentially, 1e-6.
/// Cost      three square roots a cutter, one arc tangent.
/// Source    docs/theory/intersections-and-bevels.md, section 5.3.
[[nodiscard]] double required_bevel(std::span<const joint::PreparedCutter> cutters,
                                    const Wall& wall, const joint::Generator& inner_line,
                                    double z_root);

/// Computes the same for many phases, vectorised.
[[nodiscard]] std::vector<double> required_bevels(std::span<const joint::PreparedCutter> cutters,
                                                  const Wall& wall, const joint::Stations& inner,
                                                  std::span<const double> z_root);

/// Computes the support height: the smallest z on the inner surface from which a straight cut
/// rising by `slope` = tan B across the wall enters no cutter. Returns -infinity if no cutter is
/// met in the wall.
/// Source    docs/theory/intersections-and-bevels.md, section 5.3.
[[nodiscard]] double lift(std::span<const joint::PreparedCutter> cutters, const Wall& wall,
                          const joint::Generator& inner_line, double slope);

}  // namespace tubecut::bevel
