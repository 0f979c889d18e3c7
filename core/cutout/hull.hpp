#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/cutout/cutout.hpp"
#include "core/section/curve.hpp"

/// The outline of a hole for a branch: in the branch's own plane, then laid on a local plane.
namespace tubecut::cutout {

/// A line or an arc of the hull, in the branch's own plane.
struct HullPart {
  Eigen::Vector2d from, to;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0.0, angle = 0.0, sweep = 0.0;  // of an arc

  [[nodiscard]] Eigen::Vector2d at(double share) const;
};

/// Returns an outline as lines and arcs; arcs are split where they run along `way`.
[[nodiscard]] std::vector<HullPart> parts_of(const section::Curve& curve,
                                             const Eigen::Vector2d& way);
/// Returns the hull of an outline and the same moved by `way`: what of it faces that way is moved,
/// and lines join the rest.
[[nodiscard]] std::vector<HullPart> swept(const section::Curve& curve, const Eigen::Vector2d& way);

/// Returns true if lengths and angles stay, so that arcs remain arcs.
[[nodiscard]] bool is_rigid(const Eigen::Matrix2d& onto);
/// Returns the hull laid on a local plane by `onto` and `shift`; arcs that become arcs of ellipses
/// are pairs of circular ones.
/// Accuracy  1e-4 mm of ellipses, else exact.
[[nodiscard]] Contour drawn_contour(const std::vector<HullPart>& hull, const Eigen::Matrix2d& onto,
                                    const Eigen::Vector2d& shift);

/// How far pairs of arcs may be from their ellipse, mm.
inline constexpr double kArcOff = 1e-4;

}  // namespace tubecut::cutout
