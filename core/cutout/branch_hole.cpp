#include "core/cutout/branch_hole.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"
#include "core/cutout/branch_distance.hpp"
#include "core/cutout/flats.hpp"
#include "core/cutout/hull.hpp"
#include "core/cutout/shadow/shadow.hpp"

namespace tubecut::cutout {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRounded = 1e-9;  // mm, and of a direction's rounding
constexpr double kLeans = 0.01;    // mm, of a branch over the width of a round tube: rounding
constexpr int kPlaces = 512;       // of an arc: of its greatest distance, 1e-5 mm is lost
constexpr int kShares = 64;        // of a piece of a shadow's contour, for the same

/// The outline that the hole follows, in the branch's own plane: x along its height.
section::Curve outline(const Branch& branch, double gap) {
  const bool bore = branch.kind == joint::JointKind::set_on;
  if (!branch.section) {
    const double radius = bore ? branch.radius - branch.wall : branch.radius + gap;
    return {2.0 * radius, 2.0 * radius, radius};
  }
  const auto& s = *branch.section;
  if (bore) return s.bore();
  return {s.height + 2.0 * gap, s.width + 2.0 * gap, s.corner + gap};
}

/// The branch's axes: x along its height, y along its width, d along its axis; x turns towards y as
/// a turns towards b in the local plane.
struct Axes {
  Vector3d x, y, d;
};
Axes axes_of(const Branch& branch) {
  const Vector3d d = branch.axis.direction.normalized();
  const Vector3d up =
      branch.section ? branch.up
                     : Vector3d(std::abs(d.z()) < 0.5 ? Vector3d::UnitZ() : d.unitOrthogonal());
  const Vector3d x = (up - up.dot(d) * d).normalized();
  return {x, x.cross(d), d};
}

/// Where a branch leaves the tube: the local plane there, its axes a and b and its normal.
struct Exit {
  Anchor at;
  Vector3d place;  // of the axis on that plane
  Vector3d normal, round;
  Vector2d shift = Vector2d::Zero();  // of the axis from the anchor
  double depth = 0.0;                 // of the wall on a flat
  double stretch = 1.0;               // of a round tube: of its outer radius to that of the bore
};

tl::unexpected<Error> along_tube() {
  return fail({.code = ErrorCode::parallel_axes,
               .member = "axis",
               .hint = "the branch runs along the tube that it is to pass"});
}
tl::unexpected<Error> misses_tube() {
  return fail({.code = ErrorCode::open_profile,
               .member = "axis",
               .hint = "the branch's axis misses the tube"});
}

/// The face by which the axis leaves a tube that is not round.
Result<Exit> exit_of(const section::Wall& wall, const joint::AxisLine& axis) {
  const auto& outer = wall.outer();
  const Vector3d d = axis.direction.normalized();
  double leaves = std::numeric_limits<double>::infinity(), enters = -leaves;
  int out = 0;
  for (int face = 1; face <= 4; ++face) {
    const auto n = section::Curve::face_normal(face);
    const double towards = n.dot(d.head<2>());
    const double off = outer.face_distance(face) - n.dot(axis.point.head<2>());
    if (std::abs(towards) <= kRounded) {
      if (off < 0.0) return misses_tube();
      continue;
    }
    if (towards < 0.0) {
      enters = std::max(enters, off / towards);
    } else if (off / towards < leaves) {
      leaves = off / towards;
      out = face;
    }
  }
  if (out == 0) return along_tube();
  if (!(enters < leaves)) return misses_tube();
  const auto n = section::Curve::face_normal(out);
  Exit exit{.at = {},
            .place = axis.point + leaves * d,
            .normal = {n.x(), n.y(), 0.0},
            .round = {-n.y(), n.x(), 0.0},
            .depth = wall.section().wall};
  const double offset = exit.place.dot(exit.round);
  exit.at = {
      .z = exit.place.z(), .face = out, .offset = std::abs(offset) > kRounded ? offset : 0.0};
  return exit;
}

/// Returns true if a branch does not meet a round tube at a right angle.
bool leans_on_round(const joint::Target& tube, const Vector3d& axis) {
  const double flat = elementary::hypot(axis.x(), axis.y());
  return flat > kRounded && std::abs(axis.z()) / flat * 2.0 * tube.outer_radius > kLeans;
}

/// The side on which the axis leaves a round tube that it meets at a right angle.
Result<Exit> exit_of(const joint::Target& tube, const joint::AxisLine& axis, Angle zero) {
  const Vector3d d = axis.direction.normalized();
  const double flat = elementary::hypot(d.x(), d.y());
  if (!(flat > kRounded)) return along_tube();
  Exit exit{.at = {}, .place = {}, .normal = {d.x() / flat, d.y() / flat, 0.0}, .round = {}};
  exit.round = Vector3d(-exit.normal.y(), exit.normal.x(), 0.0);
  // On the level of the tube's own axis plane, where the branch crosses it.
  exit.place = axis.point - axis.point.head<2>().dot(d.head<2>()) / (flat * flat) * d;
  exit.shift.y() = exit.place.dot(exit.round);
  exit.stretch = tube.outer_radius / tube.inner_radius();
  exit.at = {.z = exit.place.z(),
             .phi = elementary::atan2(exit.normal.y(), exit.normal.x()) - zero.rad()};
  if (!(std::abs(exit.shift.y()) < tube.outer_radius)) return misses_tube();
  return exit;
}

double way_to(const section::Curve& curve, const Vector2d& p) {
  const double r = curve.corner();
  const Vector2d q =
      p.cwiseAbs() - Vector2d(curve.face_distance(1) - r, curve.face_distance(2) - r);
  const double outside = q.cwiseMax(0.0).norm();
  return outside + std::min(std::max(q.x(), q.y()), 0.0) - r;
}

/// How the branch's own plane lies on the local plane at an exit, and where the square wall that
/// begins there meets the other surface.
class Laid {
 public:
  Laid(const Branch& branch, const Exit& exit) : shift_(exit.shift), stretch_(exit.stretch) {
    const auto axes = axes_of(branch);
    const double up = exit.normal.dot(axes.d);
    const auto onto = [&](const Vector3d& v) {
      const Vector3d on_plane = v - v.dot(exit.normal) / up * axes.d;
      return Vector2d(on_plane.z(), on_plane.dot(exit.round));
    };
    onto_ << onto(axes.x), onto(axes.y);
    back_ = onto_.inverse();
    way_ = back_ * (-exit.depth / up * Vector2d(axes.d.z(), axes.d.dot(exit.round)));
  }

  [[nodiscard]] const Matrix2d& onto() const { return onto_; }
  [[nodiscard]] const Vector2d& shift() const { return shift_; }
  /// From the branch's outline on the outside to that on the bore, in its own plane.
  [[nodiscard]] const Vector2d& way() const { return way_; }
  /// The wall's other place, in the branch's own plane: on a flat below it, on a round tube further
  /// from the anchor's line.
  [[nodiscard]] Vector2d other(const Vector2d& p) const { return scaled(p, stretch_) - way_; }
  /// The place from which a wall would just reach p on the other surface of a round tube.
  [[nodiscard]] Vector2d foot(const Vector2d& p) const { return scaled(p, 1.0 / stretch_); }

 private:
  [[nodiscard]] Vector2d scaled(const Vector2d& p, double by) const {
    const Vector2d flat = onto_ * p + shift_;
    return back_ * (Vector2d(flat.x(), by * flat.y()) - shift_);
  }

  Matrix2d onto_, back_;
  Vector2d way_, shift_;
  double stretch_;
};

/// Places along lines and arcs.
std::vector<Vector2d> places(const std::vector<HullPart>& parts) {
  std::vector<Vector2d> out;
  for (const auto& part : parts) {
    const int count = part.radius > 0.0 ? kPlaces : 1;
    for (int k = 0; k < count; ++k) out.push_back(part.at(static_cast<double>(k) / count));
  }
  return out;
}

/// How much the outline must grow so that a wall square to a round tube clears the branch outside
/// too: 0 unless the outline lies askew.
double growth(const Branch& branch, const Laid& laid, double gap) {
  const auto curve = outline(branch, gap);
  double out = 0.0;
  for (const auto& p : places(parts_of(curve, Vector2d::UnitX())))
    out = std::max(out, way_to(curve, laid.foot(p)));
  return out > kRounded ? out : 0.0;
}

double greatest_gap(const Branch& branch, const Laid& laid, const std::vector<HullPart>& hull) {
  const auto curve = outline(branch, 0.0);
  double out = branch.gap;
  for (const auto& p : places(hull))
    out = std::max({out, way_to(curve, p), way_to(curve, laid.other(p))});
  return out;
}

/// How far the wall of a hole that goes straight over corners, square to the outside from the bore
/// on, is from the branch with its gap: the least and the greatest distance.
std::pair<double, double> gaps_over_corner(const Branch& branch, const Laid& laid,
                                           const std::vector<HullPart>& hull, const Exit& exit,
                                           const section::Wall& wall) {
  constexpr int kDepths = 8;
  const auto curve = outline(branch, 0.0);
  const SectionLay over(wall, wall.outer().on_face(exit.at.face, exit.at.offset), Lay::bored,
                        false);
  const Vector2d round = exit.round.head<2>();
  double least = branch.gap, most = branch.gap;
  for (const auto& p : places(hull)) {
    const Vector2d flat = laid.onto() * p;
    const auto outside = over.at(flat.y()).outer.point;
    const double b = outside.dot(round) - exit.at.offset;
    const Vector2d end = laid.onto().inverse() * Vector2d(flat.x(), b);
    most = std::max({most, way_to(curve, p), way_to(curve, end)});
    for (int k = 1; k <= kDepths; ++k)
      least = std::min(least, way_to(curve, p + k / double{kDepths} * (end - p)));
  }
  return {least, most};
}

/// Returns true if the hole leaves the flat of its face.
bool leaves_flat(const Laid& laid, const std::vector<HullPart>& hull, const Exit& exit,
                 const section::Wall& wall) {
  const double half = half_flat(wall, exit.at.face);
  return std::ranges::any_of(places(hull), [&](const Vector2d& p) {
    return std::abs(exit.at.offset + (laid.onto() * p).y()) > half;
  });
}

Anchor anchor_of(const Shadow& shadow, const joint::Target& tube, const section::Wall* wall,
                 Angle zero) {
  if (wall == nullptr) return {.z = shadow.z, .phi = shadow.s / tube.outer_radius - zero.rad()};
  const auto& outer = wall->outer();
  const auto [face, offset] = face_place(outer, {.phi = shadow.s / outer.girth() * kTwoPi});
  return {.z = shadow.z, .face = face, .offset = std::abs(offset) > kRounded ? offset : 0.0};
}

/// The hole as the branch's shadow on a wall square to the outside, wherever it leaves the tube.
Result<BranchHole> shadow_hole(const Branch& branch, const joint::Target& tube,
                               const section::Wall* wall, Angle zero, std::string id) {
  const auto axes = axes_of(branch);
  const bool bore = branch.kind == joint::JointKind::set_on;
  const SquareLines lines = wall != nullptr ? SquareLines(*wall) : SquareLines(tube);
  const Vector2d along(axes.x.z(), axes.y.z());
  TRY(auto shadow, shadow_of({.outline = parts_of(outline(branch, branch.gap + kArcOff), along),
                              .x = axes.x,
                              .y = axes.y,
                              .point = branch.axis.point,
                              .axis = axes.d,
                              .outside_only = bore},
                             lines));
  BranchHole out{.spec = {.id = std::move(id),
                          .shape = std::move(shadow.contour),
                          .as_cut = bore,
                          .at = anchor_of(shadow, tube, wall, zero),
                          .wall = Wall::developed,
                          .tilt = branch.tilt}};
  if (bore) return out;
  TRY(const auto chain, chain_of(out.spec));
  out.greatest_gap = branch.gap;
  const BranchDistance distance(branch);
  for (const auto& s : chain)
    for (int k = 0; k < kShares; ++k) {
      const Flat p = s.at(static_cast<double>(k) / kShares);
      const auto line = lines.at(shadow.s + p.y());
      for (const auto& q : {line.outer, line.bore})
        out.greatest_gap = std::max(out.greatest_gap, distance({q.x(), q.y(), shadow.z + p.x()}));
    }
  return out;
}

/// The hole at one exit.
Result<BranchHole> hole_at(const Branch& branch, const Exit& exit, const section::Wall* wall,
                           std::string id) {
  const Laid laid(branch, exit);
  BranchHole out{.spec = {.id = std::move(id),
                          .shape = Circle{},
                          .at = exit.at,
                          .wall = Wall::normal,
                          .tilt = branch.tilt,
                          .on_one_flat = true}};
  const bool bore = branch.kind == joint::JointKind::set_on;
  out.spec.as_cut = bore;
  const bool straight = is_rigid(laid.onto()) && laid.way().norm() <= kRounded;
  const double gap =
      branch.gap + (straight ? 0.0 : kArcOff) + (bore ? 0.0 : growth(branch, laid, branch.gap));
  const auto curve = outline(branch, gap);
  const auto hull = swept(curve, laid.way());
  if (!bore) out.greatest_gap = greatest_gap(branch, laid, hull);
  if (wall != nullptr && leaves_flat(laid, hull, exit, *wall)) {
    if (bore || !straight || std::abs(exit.at.offset) > wall->outer().half_flat(exit.at.face))
      return shadow_hole(branch, {}, wall, {}, std::move(out.spec.id));
    const auto [least, most] = gaps_over_corner(branch, laid, hull, exit, *wall);
    if (least < branch.gap - kRounded)
      return shadow_hole(branch, {}, wall, {}, std::move(out.spec.id));
    out.spec.on_one_flat = false;
    out.greatest_gap = most;
  }
  if (straight && exit.shift.isZero(kRounded)) {
    const Vector2d x = laid.onto().col(0);
    if (!branch.section) {
      out.spec.shape = Circle{2.0 * curve.corner()};
      return out;
    }
    out.spec.turn = elementary::atan2(x.y(), x.x());
    out.spec.shape =
        Rectangle{2.0 * curve.face_distance(1), 2.0 * curve.face_distance(2), curve.corner()};
    return out;
  }
  out.spec.shape = drawn_contour(hull, laid.onto(), laid.shift());
  return out;
}

}  // namespace

Result<std::vector<BranchHole>> holes_for(const Branch& branch, const std::string& id,
                                          const joint::Target& tube, const section::Wall* wall,
                                          Angle zero) {
  std::vector<BranchHole> out;
  for (const bool far : {false, true}) {
    if (far && branch.kind != joint::JointKind::through) continue;
    auto one = branch;
    if (far) one.axis.direction = -one.axis.direction;
    const auto name = far ? id + ".far" : id;
    if (wall == nullptr && leans_on_round(tube, one.axis.direction)) {
      TRY(auto hole, shadow_hole(one, tube, nullptr, zero, name));
      out.push_back(std::move(hole));
      continue;
    }
    TRY(const auto exit,
        wall != nullptr ? exit_of(*wall, one.axis) : exit_of(tube, one.axis, zero));
    TRY(auto hole, hole_at(one, exit, wall, name));
    out.push_back(std::move(hole));
  }
  return out;
}

BranchDistance::BranchDistance(const Branch& branch)
    : outline_(outline(branch, 0.0)), origin_(branch.axis.point) {
  const auto axes = axes_of(branch);
  x_ = axes.x;
  y_ = axes.y;
}

double BranchDistance::operator()(const Vector3d& place) const {
  const Vector3d p = place - origin_;
  return way_to(outline_, {p.dot(x_), p.dot(y_)});
}

double distance_from(const Branch& branch, const Vector3d& place) {
  return BranchDistance(branch)(place);
}

}  // namespace tubecut::cutout
