#pragma once

#include <optional>
#include <vector>

#include "core/base/angle.hpp"
#include "core/joint/node/node.hpp"

namespace tubecut::joint {

/// Two ends that meet belong to one line if the members are in line within this angle: neither is
/// set on the other, and they end at the plane between them.
inline constexpr double kInLineMost = 15.0 * kRadPerDeg;
/// Up to this angle both faces count as square: a butt joint.
inline constexpr double kButtMost = 0.5 * kRadPerDeg;
/// Maximum distance of the two axes where the ends meet, beyond the difference of the radii; mm.
inline constexpr double kBesideMost = 2.0;

/// The relative position of two ends.
struct Facing {
  double angle = 0.0;   // out of line; rad, [0, pi]
  double beside = 0.0;  // from the one end to the other across their line, mm
  double apart = 0.0;   // along it; < 0: they overlap
};
[[nodiscard]] Facing facing(const Member& a, End of_a, const Member& b, End of_b);

/// Returns true if two ends that face each other in this way may belong to one line. `step`: the
/// difference of their radii, or of their sections (detail::size_step); `apart`: their maximum
/// distance; mm.
[[nodiscard]] bool in_line(const Facing& facing, double step, double apart);

/// Returns a member's end as one number: 2 i for the start of member i, 2 i + 1 for its finish.
[[nodiscard]] constexpr std::size_t end_index(std::size_t member, End end) {
  return 2 * member + (end == End::finish ? 1U : 0U);
}
[[nodiscard]] constexpr End end_of(std::size_t index) {
  return index % 2 == 0 ? End::start : End::finish;
}

/// Finds for each end the end that continues it with nothing between the two; the relation is
/// symmetric.
///
/// Of the stated joints only `through` counts: a member that passes through does not end there.
///
/// Errors  those of `solve` for members and links.
[[nodiscard]] Result<std::vector<std::optional<std::size_t>>> continued(const NodeSpec& spec);

}  // namespace tubecut::joint
