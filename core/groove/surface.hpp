#pragma once

#include <Eigen/Core>

#include "core/groove/joint_geometry.hpp"
#include "core/groove/section.hpp"

namespace tubecut::groove {

/// The four characteristic curves at one section, in the branch frame (z along the branch, away
/// from the chord), mm.
struct CurvePoints {
  Eigen::Vector3d c1;  // inner edge of the root face's bottom
  Eigen::Vector3d c2;  // outer edge of the root face's bottom
  Eigen::Vector3d c3;  // groove root, on the chord
  Eigen::Vector3d c4;  // groove edge, on the branch's outside
};

/// The deviation of the ruling at one section from a developable surface.
struct Ruling {
  double determinant = 0.0;  // det(C3', d, d'), mm^3; 0 everywhere <=> developable
  Angle twist;               // between the normals at C3 and C4, sign of the determinant
};

/// Source  docs/theory/grooves-and-milling.md, (1)-(4).
[[nodiscard]] CurvePoints curve_points(const JointGeometry& joint, const Section& section);

/// Computes a point of the groove surface (12): v = 0 on curve 3, v = 1 on curve 4.
[[nodiscard]] Eigen::Vector3d surface_point(const JointGeometry& joint, const Section& section,
                                            double v);

/// Source  docs/theory/grooves-and-milling.md, 5.
[[nodiscard]] Ruling ruling(const JointGeometry& joint, const Section& section);

/// Computes the filler between this section and its neighbour per radian of omega: the first moment
/// of the filler area about the branch axis (Guldin), mm^3/rad, for a groove edge `height` above
/// P1.
[[nodiscard]] double volume_rate(const JointGeometry& joint, const Section& section, double height);

/// Computes the angle of the groove line to the branch axis.
[[nodiscard]] Angle groove_angle(const JointGeometry& joint, const Section& section);

}  // namespace tubecut::groove
