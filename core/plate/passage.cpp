#include "core/plate/passage.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"
#include "core/cutout/hull.hpp"
#include "core/plate/web.hpp"
#include "core/section/curve.hpp"

namespace tubecut::plate {
namespace {

using cutout::Flat;
using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kStraight = 1e-9;  // mm: a tube that is square to the plate, within rounding
constexpr int kPlaces = 64;         // of an arc, for the greatest gap

section::Curve outside(const joint::Member& tube, double gap) {
  if (!tube.section) {
    const double radius = tube.outer_radius + gap;
    return {2.0 * radius, 2.0 * radius, radius};
  }
  const auto& s = *tube.section;
  return {s.height + 2.0 * gap, s.width + 2.0 * gap, s.corner + gap};
}

/// The tube's own axes: x along its height, y along its width.
struct Axes {
  Vector3d x, y, d;
};
Axes axes_of(const joint::Member& tube) {
  const Vector3d d = (tube.finish - tube.start).normalized();
  const Vector3d up = tube.section && tube.up ? *tube.up : d.unitOrthogonal();
  const Vector3d x = (up - up.dot(d) * d).normalized();
  return {x, d.cross(x), d};
}

double off_curve(const section::Curve& curve, const Vector2d& p) {
  const double r = curve.corner();
  const Vector2d q =
      p.cwiseAbs() - Vector2d(curve.face_distance(1) - r, curve.face_distance(2) - r);
  return q.cwiseMax(0.0).norm() + std::min(std::max(q.x(), q.y()), 0.0) - r;
}

/// How the tube's own plane lies on planes parallel to the plate.
class Laid {
 public:
  Laid(const joint::Member& tube, const joint::MemberFrame& plate)
      : start_(plate.local(tube.start)), axis_(plate.rows * axes_of(tube).d) {
    const auto axes = axes_of(tube);
    onto_ << on_plate(plate.rows * axes.x), on_plate(plate.rows * axes.y);
    // Outlines are alike to both sides, and their arcs must turn alike on the plate.
    if (onto_.determinant() < 0.0) onto_.col(1) = -onto_.col(1);
  }

  [[nodiscard]] double sine() const { return std::abs(axis_.z()); }
  [[nodiscard]] const Matrix2d& onto() const { return onto_; }
  /// Returns where the axis passes a height.
  [[nodiscard]] Flat at(double height) const {
    return (start_ + (height - start_.z()) / axis_.z() * axis_).head<2>();
  }

 private:
  [[nodiscard]] Vector2d on_plate(const Vector3d& v) const {
    return (v - v.z() / axis_.z() * axis_).head<2>();
  }

  Vector3d start_, axis_;
  Matrix2d onto_;
};

Result<Laid> laid(const joint::Member& tube, const joint::MemberFrame& plate) {
  const double sine = std::abs((plate.rows * axes_of(tube).d).z());
  if (sine >= kAlong) return Laid(tube, plate);
  return fail({.code = ErrorCode::parallel_axes,
               .got = elementary::asin(std::min(1.0, sine)) * kDegPerRad,
               .limit = elementary::asin(kAlong) * kDegPerRad,
               .unit = "deg",
               .hint = "the tube runs along the plate"});
}

Result<cutout::Chain> chain_of(const cutout::Contour& contour) {
  return cutout::drawn(contour.start, contour.pieces, contour.mirrored);
}

}  // namespace

double off_tube(const joint::Member& tube, const Vector3d& place) {
  const auto axes = axes_of(tube);
  const Vector3d p = place - tube.start;
  if (!tube.section) return p.cross(axes.d).norm() - tube.outer_radius;
  return off_curve(outside(tube, 0.0), {p.dot(axes.x), p.dot(axes.y)});
}

Result<TubeHole> hole_of(const Passage& passage, const joint::MemberFrame& plate) {
  TRY(const auto on, laid(passage.tube, plate));
  const Flat top = on.at(passage.from), way = on.at(passage.to) - top;
  TubeHole out{.chain = {}, .diameter = {}, .centre = top + 0.5 * way};
  const bool straight = cutout::is_rigid(on.onto()) && way.norm() <= kStraight;
  if (straight && !passage.tube.section) {
    out.diameter = 2.0 * (passage.tube.outer_radius + passage.gap);
    out.chain = moved(cutout::circle(*out.diameter), out.centre);
    out.greatest_gap = passage.gap;
    return out;
  }
  const auto curve = outside(passage.tube, passage.gap + (straight ? 0.0 : cutout::kArcOff));
  const Matrix2d back = on.onto().inverse();
  const auto hull = cutout::swept(curve, straight ? Vector2d::Zero() : Vector2d(back * way));
  TRY(out.chain, chain_of(cutout::drawn_contour(hull, on.onto(), top)));
  const auto plain = outside(passage.tube, 0.0);
  for (const auto& s : out.chain)
    for (int k = 0; k < (s.arc() ? kPlaces : 1); ++k) {
      const Vector2d p = back * (s.at(static_cast<double>(k) / kPlaces) - top);
      for (const Vector2d& moved : {Vector2d::Zero().eval(), Vector2d(back * way)})
        out.greatest_gap = std::max(out.greatest_gap, off_curve(plain, p - moved));
    }
  return out;
}

Result<cutout::Chain> outline_at(const joint::Member& tube, double at,
                                 const joint::MemberFrame& plate) {
  TRY(const auto on, laid(tube, plate));
  if (cutout::is_rigid(on.onto()) && !tube.section)
    return moved(cutout::circle(2.0 * tube.outer_radius), on.at(at));
  const auto parts = cutout::parts_of(outside(tube, 0.0), Vector2d::UnitX());
  return chain_of(cutout::drawn_contour(parts, on.onto(), on.at(at)));
}

}  // namespace tubecut::plate
