#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/joint/node/node_parts.hpp"

namespace tubecut::joint::detail {

/// The members that cut an end of `member`, except `own`: where they pass, its metal ends before
/// its work point.
class CutAway {
 public:
  CutAway(const Joints& joints, std::size_t own, std::size_t member);

  [[nodiscard]] bool empty() const { return cuts_.empty(); }
  /// Returns the length along the member, mm, from a point of its extended surface to its metal; 0
  /// if it is not cut away there. Where a member cuts it, its metal begins behind that one, so the
  /// point may lie in that one or in front of it.
  /// Accuracy  1e-6 mm; a point up to 0.02 mm off a cutting member counts as touching it.
  [[nodiscard]] double length(const Eigen::Vector3d& point) const;

 private:
  struct Cut {
    const Member& by;
    Eigen::Vector3d into;  // the member, from the end; unit
  };
  std::vector<Cut> cuts_ = {};
};

}  // namespace tubecut::joint::detail
