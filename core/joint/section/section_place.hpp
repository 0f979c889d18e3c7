#pragma once

#include <Eigen/Core>

#include "core/joint/cutters/cutter.hpp"
#include "core/section/curve.hpp"

/// Cutters on a target that is not round: any line parallel to z is a generator of a circle about
/// the axis, so the cutters' own code gives its height and normal.
namespace tubecut::joint {

/// Returns the line parallel to z through a point, as a generator of a circle about the axis.
[[nodiscard]] Generator generator_through(const Eigen::Vector2d& point);

/// Returns `continued_hit` on the line through the station. The normal is (along the section's
/// normal, along its tangent, axial), and `z_dphi` is dz/ds at constant depth.
[[nodiscard]] Hit section_hit(const PreparedCutter& cutter, const section::Station& at);

/// Returns the cutter seen from another axis parallel to the target's, through `axis`. An arc about
/// that axis is then a round target.
/// Source  docs/theory/sections.md, section 2.2.
[[nodiscard]] PreparedCutter seen_from(const PreparedCutter& cutter, const Eigen::Vector2d& axis);
[[nodiscard]] std::vector<PreparedCutter> seen_from(const std::vector<PreparedCutter>& cutters,
                                                    const Eigen::Vector2d& axis);

}  // namespace tubecut::joint
