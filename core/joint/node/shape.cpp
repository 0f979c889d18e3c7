#include "core/joint/node/shape.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/joint/contour.hpp"

namespace tubecut::joint::detail {
namespace {

using Eigen::Vector3d;

constexpr int kPlaces = 128;         // of an edge
constexpr double kLeastFlat = 1e-3;  // mm: half a flat; less is by rounding of the sizes

Vector3d axis_of(const Member& m) { return (m.finish - m.start).normalized(); }

/// The distance of a point from a member's surface, and the surface's outward normal there.
struct Off {
  double distance;
  Vector3d normal;
};
Off off(const Member& m, const Vector3d& p) {
  if (m.section) {
    const auto solid = box_of(m).solid();
    return {solid.distance(p), solid.normal(p)};
  }
  const Vector3d axis = axis_of(m), from = p - m.start;
  const Vector3d beside = from - from.dot(axis) * axis;
  return {beside.norm() - m.outer_radius, beside.normalized()};
}

/// Returns the places of the outline in space, in the plane across the axis through the start.
std::vector<Vector3d> outline(const Member& m) {
  const Vector3d axis = axis_of(m);
  const Vector3d x = m.section ? height_of(m) : axis.unitOrthogonal();
  const Vector3d y = axis.cross(x);
  std::vector<Vector3d> out;
  if (!m.section) {
    for (int k = 0; k < kPlaces; ++k) {
      const auto at = elementary::sincos(kTwoPi * k / kPlaces);
      out.emplace_back(m.start + m.outer_radius * (at.cos * x + at.sin * y));
    }
    return out;
  }
  const auto curve = m.section->outer();
  const auto add = [&](double s) {
    const auto at = curve.at(s).point;
    out.emplace_back(m.start + at.x() * x + at.y() * y);
  };
  for (int k = 0; k < kPlaces; ++k) add(curve.girth() * k / kPlaces);
  for (const double s : curve.seams()) add(s);
  return out;
}

/// Returns the places of the edge along which a plane through `point` cuts the surface.
std::vector<Vector3d> edge(const Member& of, const Vector3d& point, const Vector3d& normal) {
  const Vector3d axis = axis_of(of);
  const double rise = axis.dot(normal);
  auto out = outline(of);
  for (auto& p : out) p += (point - p).dot(normal) / rise * axis;
  return out;
}

double edge_off(const Member& of, const Member& from, const Vector3d& point,
                const Vector3d& normal) {
  double worst = 0.0;
  for (const auto& p : edge(of, point, normal)) {
    const auto away = off(from, p);
    const double across = away.normal.cross(normal).norm();
    worst = std::max(worst, std::abs(away.distance) / across);
  }
  return worst;
}

}  // namespace

Vector3d height_of(const Member& member) {
  const Vector3d axis = axis_of(member), up = member.up->normalized();
  return (up - up.dot(axis) * axis).normalized();
}

std::optional<Cutter> cutter_of(const Member& member, const MemberFrame& frame) {
  if (member.section) return Cutter(box_of(member, frame));
  const auto placed =
      place(frame.local(AxisLine{member.start, member.finish - member.start}), member.outer_radius);
  if (!placed) return std::nullopt;
  return Cutter(placed->tube);
}

double support(const Member& member, const Vector3d& direction) {
  const Vector3d axis = axis_of(member);
  if (!member.section) return member.outer_radius * direction.cross(axis).norm();
  const auto& s = *member.section;
  const Vector3d x = height_of(member), y = axis.cross(x);
  const double along = std::abs(direction.dot(x)), across = std::abs(direction.dot(y));
  return along * (0.5 * s.height - s.corner) + across * (0.5 * s.width - s.corner) +
         s.corner * elementary::hypot(along, across);
}

double distance_from(const Member& member, const Vector3d& point) {
  if (member.section) return box_of(member).solid().distance(point);
  return (point - member.start).cross(axis_of(member)).norm() - member.outer_radius;
}

bool same_outline(const Member& a, const Member& b) {
  if (!a.section && !b.section) return a.outer_radius == b.outer_radius;
  if (!a.section || !b.section) return false;
  const auto &p = *a.section, &q = *b.section;
  if (p.corner != q.corner) return false;
  const Vector3d axis = axis_of(a), x = height_of(a), other = height_of(b);
  const Vector3d seen = (other - other.dot(axis) * axis).normalized();
  const bool upright = x.cross(seen).norm() <= kSameTurn;
  const bool crosswise = std::abs(x.dot(seen)) <= kSameTurn;
  return (upright && p.height == q.height && p.width == q.width) ||
         (crosswise && p.height == q.width && p.width == q.height);
}

double size_step(const Member& a, const Member& b) {
  if (!a.section && !b.section) return std::abs(a.outer_radius - b.outer_radius);
  const auto side = [](const Member& m, double section::Section::*of) {
    return m.section ? 0.5 * (*m.section).*of : m.outer_radius;
  };
  using section::Section;
  return std::max(std::abs(side(a, &Section::height) - side(b, &Section::height)),
                  std::abs(side(a, &Section::width) - side(b, &Section::width)));
}

bool is_square_to(const Member& member, const Vector3d& direction) {
  if (!member.section) return true;
  const Vector3d x = height_of(member), d = direction.normalized();
  return x.cross(d).norm() <= kSameTurn || std::abs(x.dot(d)) <= kSameTurn;
}

bool covers(const Member& chord, const Member& branch) {
  const Vector3d across = axis_of(branch).cross(axis_of(chord));
  const double sine = across.norm();
  if (!(sine > 2.0 * kParallel)) return false;
  const Vector3d n = across / sine;
  const double apart = std::abs((branch.start - chord.start).dot(n));
  return apart + support(branch, n) <= support(chord, n) + kSlightOverhang;
}

namespace {

/// Both axes: a unit vector across them, and their distance along it.
struct Across {
  Vector3d normal;
  double apart;
};
std::optional<Across> across_both(const Member& chord, const Member& branch) {
  const Vector3d across = axis_of(branch).cross(axis_of(chord));
  const double sine = across.norm();
  if (!(sine > 2.0 * kParallel)) return std::nullopt;
  const Vector3d n = across / sine;
  return Across{n, std::abs((branch.start - chord.start).dot(n))};
}

/// Returns how far the bore reaches from the axis in a direction.
double bore_support(const Member& member, const Vector3d& direction) {
  auto bore = member;
  bore.outer_radius -= member.wall;
  if (auto& s = bore.section) {
    s->height -= 2.0 * s->wall;
    s->width -= 2.0 * s->wall;
    s->corner = s->inner_corner;
  }
  return support(bore, direction);
}

/// Returns true if the chord's width stops the bore.
bool stops_bore(const Member& chord, const Member& branch, const Across& at) {
  return at.apart + bore_support(branch, at.normal) <= support(chord, at.normal);
}
/// Returns true if a direction square to the section lies along its height, not along its width.
bool is_along_height(const Member& member, const Vector3d& direction) {
  return std::abs(height_of(member).dot(direction)) > 0.5;
}
/// Returns true if the branch's axis meets a face that is square to the plane of both. A half-round
/// edge of a flat oval is no face, because it has no flat.
bool meets_face(const Member& chord, const Across& at) {
  if (!chord.section || !is_square_to(chord, at.normal)) return false;
  const auto& s = *chord.section;
  // By the sizes, because the support of an oval that is turned by rounding exceeds its radius.
  const double flat = 0.5 * (is_along_height(chord, at.normal) ? s.height : s.width) - s.corner;
  return flat > kLeastFlat && at.apart < flat;
}

}  // namespace

double overhang(const Member& chord, const Member& branch) {
  const auto at = across_both(chord, branch);
  if (!at) return 0.0;
  return std::max(0.0, at->apart + support(branch, at->normal) - support(chord, at->normal));
}

Member as_met(const Member& chord, const Member& branch) {
  auto out = chord;
  const auto at = across_both(chord, branch);
  if (!at || stops_bore(chord, branch, *at) || !meets_face(chord, *at)) return out;
  // Of the sizes only, so that equal branches get equal faces.
  const double wide = 2.0 * (chord.reach() + 2.0 * branch.reach());
  (is_along_height(chord, at->normal) ? out.section->height : out.section->width) = wide;
  out.section->corner = kSharpCorner;
  return out;
}

bool carries(const Member& chord, const Member& branch) {
  const auto at = across_both(chord, branch);
  return at && (stops_bore(chord, branch, *at) || meets_face(chord, *at));
}

bool goes_on(const Member& chord, const Member& branch, double inside) {
  constexpr double kFarSide = 0.02;  // of its reach: an end drawn flush with the branch goes on
  const Vector3d u = axis_of(branch), across = u.cross(axis_of(chord));
  const double sine = across.norm();
  if (!(sine > 2.0 * kParallel)) return false;
  const double far = support(branch, u.cross(across / sine)) / sine;
  return inside >= far - kFarSide * branch.reach();
}

namespace {

/// Returns the least signed distance of a segment from the endless surface.
double least_distance(const Member& member, const Vector3d& a, const Vector3d& b) {
  if (member.section) return box_of(member).solid().least_distance(a, b);
  return TubeSolid{member.start, axis_of(member), member.outer_radius}.least_distance(a, b);
}

}  // namespace

double edge_outside(const Member& member, const Vector3d& into, const Vector3d& point,
                    const Vector3d& normal, const Vector3d& towards,
                    const std::vector<const Member*>& others) {
  double worst = -1e300;
  for (const auto& p : edge(member, point, normal)) {
    if (!((p - point).dot(towards) > 0.0)) continue;
    double least = 1e300;
    for (const auto* other : others) least = std::min(least, least_distance(*other, p, p + into));
    worst = std::max(worst, least);
  }
  return worst;
}

double edge_step(const Member& a, const Member& b, const Vector3d& point, const Vector3d& normal) {
  return std::max(edge_off(a, b, point, normal), edge_off(b, a, point, normal));
}

}  // namespace tubecut::joint::detail

namespace tubecut::joint {

RectangularTubeCutter box_of(const Member& member) {
  const auto& s = *member.section;
  return {.width = s.width,
          .height = s.height,
          // By rounding, a flat oval's may be larger.
          .corner = std::min(s.corner, 0.5 * std::min(s.height, s.width)),
          .point = member.start,
          .direction = member.finish - member.start,
          .up = detail::height_of(member)};
}

void straighten_as_drawn(RectangularTubeCutter& box) {
  auto out = box;
  const Eigen::Vector3d along = out.direction.normalized();
  out.point -= along.dot(out.point) * along;  // near the end, about which it is turned
  out.straighten(kDrawnAlong);
  if (out.direction != box.direction || out.up != box.up) box = out;
}

RectangularTubeCutter box_of(const Member& member, const MemberFrame& frame) {
  auto out = box_of(member);
  out.point = frame.local(out.point);
  out.direction = frame.rows * out.direction;
  out.up = frame.rows * out.up;
  return out;
}

}  // namespace tubecut::joint
