#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/base/error.hpp"

namespace tubecut::joint {

/// A straight segment of a member's axis with `reach` to all sides. Lengths in mm.
struct AxisSegment {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d finish = Eigen::Vector3d::UnitX();
  double reach = 0.0;
};

/// The distance of a point to an axis segment, and of the foot to the segment's nearer end.
struct Nearness {
  double distance = 0.0;
  double inside = 0.0;  // >= 0; 0 if the nearest point is an end
};
[[nodiscard]] Nearness nearness(const Eigen::Vector3d& point, const AxisSegment& segment);
/// Computes the smallest distance of the axes of two segments.
[[nodiscard]] double nearness(const AxisSegment& a, const AxisSegment& b);

/// The end of one segment within the reach of another.
struct Touch {
  std::size_t end = 0;    // 2 i for the start of segment i, 2 i + 1 for its finish
  std::size_t other = 0;  // never i
  Nearness near;
};

/// Finds every end within the reach of another segment, ascending by end, then by the other.
///
/// Errors    wrong_count (members/i/start or end: more than `most` others at one end), cancelled.
/// Cost      memory linear; time linear for members of similar size (ends in a grid of the mean
///           length and reach), at worst one distance for each end and segment.
[[nodiscard]] Result<std::vector<Touch>> touches(std::span<const AxisSegment> segments,
                                                 std::size_t most);

/// Finds for each of these ends the other segment whose reach contains it, nearest relative to that
/// reach; empty for all other ends.
///
/// Errors    cancelled.
/// Cost      as `touches`, without its limit of the number.
[[nodiscard]] Result<std::vector<std::optional<Touch>>> nearest_touches(
    std::span<const AxisSegment> segments, const std::vector<bool>& ends);

}  // namespace tubecut::joint
