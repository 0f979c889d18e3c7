#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <string>

#include "core/joint/joint.hpp"
#include "core/section/section.hpp"

namespace tubecut::joint {

/// A tube by its centre-line in the world. Lengths in mm. Of a tube that is not round, `section`
/// takes the place of radius and wall; its height lies along `up`, which it must have.
struct Member {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d finish = Eigen::Vector3d::UnitX();
  double outer_radius = 0.0;
  double wall = 0.0;
  int priority = 0;                        // a lower number cuts a higher one
  std::optional<Eigen::Vector3d> up = {};  // phi = 0 on this side at both ends; empty: the chord's
  std::string name = {};                   // only for messages
  std::optional<section::Section> section = {};

  [[nodiscard]] const Eigen::Vector3d& at(End end) const {
    return end == End::start ? start : finish;
  }
  /// Returns the direction from an end towards the other.
  [[nodiscard]] Eigen::Vector3d into(End end) const {
    return at(end == End::start ? End::finish : End::start) - at(end);
  }
  /// Returns the largest distance of the surface from the axis.
  [[nodiscard]] double reach() const { return section ? section->reach() : outer_radius; }
  /// Returns half the diameter, or half the larger side.
  [[nodiscard]] double half_size() const {
    return section ? 0.5 * std::max(section->height, section->width) : outer_radius;
  }
  [[nodiscard]] double thickness() const { return section ? section->wall : wall; }
};

}  // namespace tubecut::joint
