#pragma once

#include <Eigen/Core>

#include "core/cutout/branch_hole.hpp"

namespace tubecut::cutout {

/// Measures as `distance_from`, of many places from one branch: its outline is made once.
class BranchDistance {
 public:
  explicit BranchDistance(const Branch& branch);
  [[nodiscard]] double operator()(const Eigen::Vector3d& place) const;

 private:
  section::Curve outline_;
  Eigen::Vector3d x_, y_, origin_;
};

}  // namespace tubecut::cutout
