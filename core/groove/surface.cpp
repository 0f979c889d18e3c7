#include "core/groove/surface.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/elementary.hpp"

namespace tubecut::groove {
namespace {

Eigen::Vector3d at(const Section& section, double s, double z) {
  return {-section.dir.sin * s, section.dir.cos * s, z};
}

/// Computes the first moment of the bow about the branch axis, mm^3. The bow is the affine image of
/// a circle segment, whose first moment is chord^3 / 12 along its bisector.
double bow_moment(const JointGeometry& joint, const Section& section) {
  const Direction dir = section.dir;
  const Toe& p = section.toe;
  if (dir.sin == 0.0 || p.theta == 0.0) return 0.0;
  const double chord = 2.0 * joint.chord_radius * p.half_sin;
  const double bisector_t = (p.t1 + p.t2) / elementary::hypot(p.t1 + p.t2, p.q1 + p.q2);
  const double scale = std::abs(dir.sin) * joint.sin_a;
  return (chord * chord * chord / 12.0 * bisector_t / scale - joint.eccentricity * p.bow) / dir.sin;
}

/// Computes the normal S_w x d in (radial, tangential, axial) components, not of unit length.
Eigen::Vector3d normal_at(const JointGeometry& joint, const Section& section, double v) {
  const double H = joint.groove_width;
  const double s = joint.root_radius + v * H;
  const double rise = section.z3_d + v * section.height_d;
  return {s * section.height, rise * H, -s * H};
}

}  // namespace

CurvePoints curve_points(const JointGeometry& joint, const Section& section) {
  const double z3 = section.toe.y1, bottom = z3 - joint.root_height;
  return {.c1 = at(section, joint.inner_radius, bottom),
          .c2 = at(section, joint.root_radius, bottom),
          .c3 = at(section, joint.root_radius, z3),
          .c4 = at(section, joint.branch_radius, section.y3)};
}

Eigen::Vector3d surface_point(const JointGeometry& joint, const Section& section, double v) {
  return at(section, joint.root_radius + v * joint.groove_width,
            section.toe.y1 + v * section.height);
}

Ruling ruling(const JointGeometry& joint, const Section& section) {
  const double H = joint.groove_width;
  Ruling out;
  out.determinant = H * (H * section.z3_d - joint.root_radius * section.height_d);
  const Eigen::Vector3d low = normal_at(joint, section, 0.0), high = normal_at(joint, section, 1.0);
  const double twist = elementary::atan2(low.cross(high).norm(), low.dot(high));
  out.twist = Angle::rad(std::copysign(twist, out.determinant));
  return out;
}

double volume_rate(const JointGeometry& joint, const Section& section, double height) {
  const Toe& p = section.toe;
  const double triangle = 0.5 * (height * p.D - joint.groove_width * p.dy);
  const double centre = (p.x1 + p.x2 + joint.branch_radius) / 3.0;
  return triangle * centre - bow_moment(joint, section);
}

Angle groove_angle(const JointGeometry& joint, const Section& section) {
  return Angle::rad(elementary::atan2(joint.groove_width, section.height));
}

}  // namespace tubecut::groove
