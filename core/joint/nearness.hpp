#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "core/base/error.hpp"

namespace tubecut::joint {

/// Straight stretch of a member's axis that reaches `reach` to all sides. Lengths in mm.
struct Stretch {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d finish = Eigen::Vector3d::UnitX();
  double reach = 0.0;
};

/// How far a point lies from a stretch of axis, and how far the foot lies from its nearer end.
struct Nearness {
  double distance = 0.0;
  double inside = 0.0;  // >= 0; 0 where the nearest point is an end
};
[[nodiscard]] Nearness nearness(const Eigen::Vector3d& point, const Stretch& stretch);
/// Least distance of two stretches' axes.
[[nodiscard]] double nearness(const Stretch& a, const Stretch& b);

/// The end of one stretch within the reach of another.
struct Touch {
  std::size_t end = 0;    // 2 i for the start of stretch i, 2 i + 1 for its finish
  std::size_t other = 0;  // never i
  Nearness near;
};

/// Every end within the reach of another stretch, ascending by end, then by the other.
///
/// Errors    wrong_count (members/i/start or end: more than `most` others at one end), cancelled.
/// Cost      memory linear; time linear for members of like size (ends in a grid of the mean length
///           and reach), at worst one distance for each end and stretch.
[[nodiscard]] Result<std::vector<Touch>> touches(std::span<const Stretch> stretches,
                                                 std::size_t most,
                                                 const std::stop_token& stop = {});

/// For each of these ends the other within whose reach it is, by the share of it the nearest;
/// nothing for any else.
///
/// Errors    cancelled.
/// Cost      as of `touches`, which it has no limit of.
[[nodiscard]] Result<std::vector<std::optional<Touch>>> nearest_touches(
    std::span<const Stretch> stretches, const std::vector<bool>& ends,
    const std::stop_token& stop = {});

}  // namespace tubecut::joint
