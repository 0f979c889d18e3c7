#include "core/bevel/hole/hole_wall.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"

namespace tubecut::bevel {
namespace {

using Eigen::Vector3d;

// Each round brings the torch's own axial plane nearer by half the kerf over the radius, < 1/5.
constexpr int kKerfRounds = 24;
constexpr double kSettled = 1e-14;  // of the chord's radius

Vector3d radial_at(const Vector3d& p) {
  return Vector3d(p.x(), p.y(), 0.0) / elementary::hypot(p.x(), p.y());
}

/// Returns the first point on the cylinder `radius`, outwards or inwards, of a line that leaves the
/// axis. Returns empty when the line misses it; a line that is tangent within rounding touches it.
/// The distance to the axis is one product, because b^2 - a c would lose every digit at a tangent.
std::optional<Vector3d> on_cylinder(const Vector3d& p, const Vector3d& along, double radius) {
  const double flat = elementary::hypot(along.x(), along.y());
  const double passes = std::abs(p.x() * along.y() - p.y() * along.x()) / flat;
  const double size = elementary::hypot(p.x(), p.y());
  if (!(radius - passes >= -joint::kTouch * (radius + size))) return std::nullopt;
  const double b = p.x() * along.x() + p.y() * along.y();
  const double c = (size - radius) * (size + radius);
  const double root = flat * std::sqrt(std::max(0.0, radius - passes) * (radius + passes));
  return p - along * (c / (b + root));
}

}  // namespace

BranchFrame branch_frame(const joint::TubeCutter& branch) {
  const auto a = elementary::sincos(branch.inclination.rad());
  const auto b = elementary::sincos(branch.clocking.rad());
  BranchFrame f;
  f.side = {b.sin, -b.cos, 0.0};
  f.across = {b.cos, b.sin, 0.0};
  f.foot = -branch.offset * f.across + Vector3d(0.0, 0.0, branch.height);
  f.axis = a.sin * f.side + Vector3d(0.0, 0.0, a.cos);
  f.x = -f.across;
  f.y = a.cos * f.side - Vector3d(0.0, 0.0, a.sin);
  const double phi = branch.clocking.rad() - 0.5 * kPi;
  f.side_phi = phi - kTwoPi * std::floor(phi / kTwoPi);
  return f;
}

joint::TubeCutter reversed(const joint::TubeCutter& branch) {
  auto out = branch;
  out.inclination = Angle::rad(kPi) - branch.inclination;
  out.clocking = branch.clocking + Angle::rad(kPi);
  out.offset = -branch.offset;
  return out;
}

/// The chord's surface and the branch's at the root: outward normals, and the branch's direction
/// across the weld, `rise`, away from the chord's axis.
struct WallLines::Corner {
  Vector3d chord, branch, rise;
  double dihedral;  // weld side
  double sine;      // of the dihedral

  Corner(const Vector3d& of_chord, const Vector3d& of_branch) : chord(of_chord), branch(of_branch) {
    const double facing = chord.dot(branch);
    sine = chord.cross(branch).norm();
    dihedral = elementary::atan2(sine, -facing);
    rise = (chord - facing * branch) / sine;
  }
};

WallLines::WallLines(const HoleSpec& spec, const joint::TubeCutter& branch, double radius,
                     const joint::PreparedCutter& chord)
    : spec_(spec),
      frame_(branch_frame(branch)),
      radius_(radius),
      chord_(chord),
      root_outside_(spec.kind == JointKind::set_on) {}

double WallLines::phi(const Vector3d& point) const {
  return frame_.side_phi + elementary::atan2(point.dot(frame_.across), point.dot(frame_.side));
}

/// Returns the requested groove of the wall against the branch's surface, in the section across the
/// weld, >= 0. A set-on hole is the branch's bore: flush.
double WallLines::asked_groove(double dihedral) const {
  if (root_outside_) return 0.0;
  if (const auto* half = std::get_if<HalfDihedral>(&spec_.groove))
    return std::min(0.5 * dihedral, half->cap.rad());
  if (const auto* fixed = std::get_if<FixedGroove>(&spec_.groove)) return fixed->angle.rad();
  if (std::holds_alternative<SquareCut>(spec_.groove)) return std::max(0.0, dihedral - 0.5 * kPi);
  return 0.0;
}

// Returns the branch's own direction, so that the hole is its extended bore. If that leans further
// from the surface's normal than the torch can, returns the torch's limit towards it.
WallLines::Direction WallLines::along_branch(const Corner& c) const {
  const double up = frame_.axis.dot(c.chord);
  const Vector3d flat = frame_.axis - up * c.chord;
  const double lean = elementary::atan2(flat.norm(), up);
  const double most = spec_.torch.max.rad();
  if (lean <= most) return {.unit = frame_.axis};
  const auto at = elementary::sincos(most);
  return {.unit = at.cos * c.chord + at.sin * flat.normalized(), .held_back = lean - most};
}

// In the section across the weld, the line is at `dihedral - groove` above the chord's surface.
WallLines::Direction WallLines::free_direction(const Corner& c) const {
  if (root_outside_) return along_branch(c);
  const double asked = asked_groove(c.dihedral);
  const double lowest = c.dihedral - 0.5 * kPi - spec_.torch.max.rad();
  const double highest = c.dihedral - 0.5 * kPi + spec_.torch.max.rad();
  const double groove = std::clamp(asked, lowest, highest);
  const auto at = elementary::sincos(groove);
  return {.unit = at.cos * c.rise + at.sin * c.branch,
          .beyond = groove < 0.0,
          .needs = c.dihedral - 0.5 * kPi};
}

// Where the curve runs along the chord, a swing in the axial plane does not change the bevel: the
// groove fades out towards the sides instead of driving B to 90 deg. Never less than flush.
WallLines::Direction WallLines::axial_direction(const Corner& c, const Vector3d& radial) const {
  const Vector3d tangential(-radial.y(), radial.x(), 0.0);
  const double up = c.branch.z();
  const double round = c.branch.dot(tangential);
  const double flat = elementary::hypot(up, round);
  double b = elementary::atan2(frame_.axis.z(), frame_.axis.dot(radial));
  if (std::holds_alternative<SquareCut>(spec_.groove) && !root_outside_) {
    b = 0.0;
  } else if (flat > 0.0) {
    b += asked_groove(c.dihedral) * up / flat;
  }
  Direction out;
  if (root_outside_)
    out.held_back = std::max({0.0, b - spec_.torch.max.rad(), spec_.torch.min.rad() - b});
  b = std::clamp(b, spec_.torch.min.rad(), spec_.torch.max.rad());
  if (!root_outside_) {
    const double out_of_branch = c.branch.dot(radial);
    if (up > 0.0) b = std::max(b, elementary::atan2(-out_of_branch, up));
    if (up < 0.0) b = std::min(b, -elementary::atan2(-out_of_branch, -up));
    out.needs = up == 0.0 ? 0.5 * kPi : b;
    out.beyond = b > spec_.torch.max.rad() || b < spec_.torch.min.rad() ||
                 (up == 0.0 && out_of_branch < 0.0);
    b = std::clamp(b, spec_.torch.min.rad(), spec_.torch.max.rad());
  }
  const auto at = elementary::sincos(b);
  out.unit = at.cos * radial + Vector3d(0.0, 0.0, at.sin);
  out.b = b;
  return out;
}

/// Returns the distance along the chord from a point to the branch's surface, on its side towards
/// +z or -z; empty when no such point exists.
std::optional<double> WallLines::height_over(const Vector3d& point, double side) const {
  const Vector3d from = point - frame_.foot;
  const Vector3d beside = from - from.dot(frame_.axis) * frame_.axis;
  const Vector3d along = Vector3d::UnitZ() - frame_.axis.z() * frame_.axis;
  const double a = along.squaredNorm(), b = beside.dot(along);
  const double square = b * b - a * (beside.squaredNorm() - radius_ * radius_);
  if (!(square >= 0.0)) return std::nullopt;
  return (side * std::sqrt(square) - b) / a;
}

// A line square to the chord from the root out enters the branch if that leans over it. The
// branch's height over the line is concave: its maximum is at the line's end, or where the surface
// is parallel to the line. The root moves along the chord by that height.
WallLines::Corner WallLines::moved_clear(const Corner& c, const Vector3d& radial,
                                         Vector3d& root) const {
  if (root_outside_ || !(c.branch.dot(radial) < 0.0) || c.branch.z() == 0.0) return c;
  const double side = c.branch.z() > 0.0 ? 1.0 : -1.0;
  Vector3d touch = root;
  double most = 0.0;
  const auto see = [&](const Vector3d& at) {
    const auto height = height_over(at, side);
    if (!height || !(side * *height > side * most)) return;
    most = *height;
    touch = at;
  };
  const auto end = on_cylinder(root, radial, spec_.chord.outer_radius);
  const double length = end ? radial.dot(*end - root) : 0.0;
  if (end) see(*end);
  const Vector3d across = radial.cross(Vector3d::UnitZ());
  const Vector3d parallel = frame_.axis.cross(radial);
  const double turn = side * parallel.z() < 0.0 ? -1.0 : 1.0;
  const Vector3d foot = frame_.foot + turn * radius_ * parallel.normalized();
  const double there =
      radial.dot(foot + across.dot(root - foot) / across.dot(frame_.axis) * frame_.axis - root);
  if (there > 0.0 && there < length) see(root + there * radial);
  if (most == 0.0) return c;
  touch.z() += most;
  root.z() += most;
  const Vector3d from = touch - frame_.foot;
  return {radial_at(touch), (from - from.dot(frame_.axis) * frame_.axis).normalized()};
}

// The finished wall is square to the chord at its own root. The torch is square next to it:
// slightly further off outside than on the bore, and nowhere nearer than requested.
WallLine WallLines::square_line(const Vector3d& root, const Corner& met, double off) const {
  const double inside = spec_.chord.inner_radius(), outside = spec_.chord.outer_radius;
  WallLine out;
  out.root = root;
  const Vector3d radial = met.chord;
  const auto c = moved_clear(met, radial, out.root);
  const auto other = on_cylinder(out.root, radial, root_outside_ ? inside : outside);
  out.outer = root_outside_ ? out.root : other.value_or(out.root);
  out.inner = root_outside_ ? other.value_or(out.root) : out.root;
  out.dihedral = c.dihedral;
  const double up = radial.dot(c.rise), out_of = radial.dot(c.branch);
  out.groove = elementary::atan2(out_of, up);
  const Vector3d normal = (up * c.branch - out_of * c.rise) / elementary::hypot(up, out_of);
  double by = off;
  for (int round = 0; round < kKerfRounds; ++round) {
    const Vector3d base = out.inner - by * normal;
    const auto torch_outer = on_cylinder(base, radial_at(base), outside);
    const auto torch_inner = on_cylinder(base, radial_at(base), inside);
    out.misses_bore = !other || !torch_outer || !torch_inner;
    out.torch_outer = torch_outer.value_or(base);
    out.torch_inner = torch_inner.value_or(base);
    const double lacks = off - std::min((out.outer - out.torch_outer).dot(normal),
                                        (out.inner - out.torch_inner).dot(normal));
    if (std::abs(lacks) <= kSettled * outside) break;
    by += lacks;
  }
  // Away from the chord's middle plane, the outline would have to turn back under the branch.
  const bool beside = std::abs(frame_.foot.dot(frame_.across)) > radius_;
  const bool reached = spec_.torch.min.rad() <= 0.0 && spec_.torch.max.rad() >= 0.0;
  out.beyond_torch =
      !reached || !(up > 0.0) || (!root_outside_ && beside && met.branch.dot(radial) < 0.0);
  out.needs = !reached ? 0.0 : 0.5 * kPi;
  const bool measured = !root_outside_ && !std::holds_alternative<SquareCut>(spec_.groove);
  if (measured) out.lost = std::max(0.0, asked_groove(c.dihedral) - out.groove);
  return out;
}

WallLine WallLines::at(double phase, double off) const {
  const auto line = joint::generator_at(radius_, phase);
  const Vector3d leaving = line.cos_phi * frame_.x + line.sin_phi * frame_.y;
  WallLine out;
  out.root = frame_.foot + radius_ * leaving + joint::continued_sheet(chord_, line) * frame_.axis;
  const Corner c(radial_at(out.root), leaving);
  out.dihedral = c.dihedral;

  // The torch line runs inside the wall, and its own axial plane determines the tilt.
  Vector3d base = out.root;
  Direction d;
  for (int round = 0; round < kKerfRounds; ++round) {
    switch (spec_.tilt) {
      case Tilt::axial:
        d = axial_direction(c, radial_at(base));
        break;
      case Tilt::free:
        d = free_direction(c);
        break;
      case Tilt::none:
        return square_line(out.root, c, off);
    }
    const double up = d.unit.dot(c.rise);
    const double out_of = d.unit.dot(c.branch);
    const Vector3d normal = (up * c.branch - out_of * c.rise) / elementary::hypot(up, out_of);
    out.groove = elementary::atan2(out_of, up);
    const Vector3d next = out.root - off * normal;
    const bool settled = (next - base).norm() <= kSettled * spec_.chord.outer_radius;
    base = next;
    if (settled || spec_.tilt == Tilt::free) break;
  }
  out.beyond_torch = d.beyond || !(d.unit.dot(c.rise) > 0.0);
  out.needs = d.beyond ? d.needs : 0.5 * kPi;
  const bool measured = !root_outside_ && !std::holds_alternative<SquareCut>(spec_.groove);
  out.lost = measured ? std::max(0.0, asked_groove(c.dihedral) - out.groove) : d.held_back;

  const double inside = spec_.chord.inner_radius();
  const double outside = spec_.chord.outer_radius;
  const auto other = on_cylinder(out.root, d.unit, root_outside_ ? inside : outside);
  const auto torch_outer = on_cylinder(base, d.unit, outside);
  const auto torch_inner = on_cylinder(base, d.unit, inside);
  out.misses_bore = !other || !torch_outer || !torch_inner;
  out.outer = root_outside_ ? out.root : other.value_or(out.root);
  out.inner = root_outside_ ? other.value_or(out.root) : out.root;
  out.torch_outer = torch_outer.value_or(base);
  out.torch_inner = torch_inner.value_or(base);
  const Vector3d radial = radial_at(out.torch_outer);
  const double height = d.unit.dot(radial);
  const bool free = spec_.tilt == Tilt::free;
  out.b = free ? elementary::atan2(d.unit.z(), height) : d.b;
  out.a = free ? elementary::atan2(d.unit.y() * radial.x() - d.unit.x() * radial.y(), height) : 0.0;
  return out;
}

}  // namespace tubecut::bevel
