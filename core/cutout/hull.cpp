#include "core/cutout/hull.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/cutout/biarc.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::cutout {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kEqual = 1e-9;  // mm, and of a direction's rounding
constexpr double kShort = 1e-5;  // rad and mm, of arcs and ways that make no piece of their own
constexpr int kHalvings = 10;

HullPart arc_part(const Vector2d& centre, double radius, double angle, double sweep) {
  HullPart out{
      .from = {}, .to = {}, .centre = centre, .radius = radius, .angle = angle, .sweep = sweep};
  out.from = out.at(0.0);
  out.to = out.at(1.0);
  return out;
}

/// The pieces of a drawing in the local plane, from parts of the branch's own.
class Drawing {
 public:
  Drawing(const Matrix2d& onto, const Vector2d& shift)
      : onto_(onto), shift_(shift), rigid_(is_rigid(onto)) {}

  [[nodiscard]] Flat at(const Vector2d& p) const { return onto_ * p + shift_; }

  void add(const HullPart& part) {
    if (part.radius == 0.0) {
      out_.push_back({.to = at(part.to)});
    } else if (rigid_) {
      out_.push_back({.to = at(part.to), .centre = at(part.centre)});
    } else {
      for (int k = 0; k < 4; ++k) {
        const Ellipse quarter{*this,
                              arc_part(part.centre, part.radius, part.angle + 0.25 * k * part.sweep,
                                       0.25 * part.sweep)};
        add_biarcs(quarter, quarter.at(0.0), kArcOff, kHalvings, out_);
      }
    }
  }

  [[nodiscard]] std::vector<DrawnSegment> take() { return std::move(out_); }

 private:
  /// An arc as the local plane sees it.
  struct Ellipse {
    const Drawing& drawing;
    HullPart part;

    [[nodiscard]] Flat at(double share) const { return drawing.at(part.at(share)); }
    [[nodiscard]] Flat along(double share) const {
      const auto [sin, cos] = elementary::sincos(part.angle + share * part.sweep);
      return (drawing.onto_ * Vector2d(-sin, cos)).normalized();
    }
    [[nodiscard]] Ellipse first() const { return half(0.0); }
    [[nodiscard]] Ellipse second() const { return half(0.5 * part.sweep); }
    [[nodiscard]] Ellipse half(double turn) const {
      return {drawing, arc_part(part.centre, part.radius, part.angle + turn, 0.5 * part.sweep)};
    }
  };

  Matrix2d onto_;
  Vector2d shift_;
  bool rigid_;
  std::vector<DrawnSegment> out_;
};

}  // namespace

Vector2d HullPart::at(double share) const {
  if (radius == 0.0) return from + share * (to - from);
  const auto [sin, cos] = elementary::sincos(angle + share * sweep);
  return centre + radius * Vector2d(cos, sin);
}

std::vector<HullPart> parts_of(const section::Curve& curve, const Vector2d& way) {
  std::vector<HullPart> out;
  const double side = elementary::atan2(way.y(), way.x()) + 0.5 * kPi;
  for (const auto& segment : curve.segments()) {
    if (!segment.is_arc()) {
      const Vector2d along(-segment.normal.y(), segment.normal.x());
      out.push_back({.from = segment.origin, .to = segment.origin + segment.length * along});
      continue;
    }
    const double sweep = segment.length / segment.radius;
    std::vector<double> ends{0.0, sweep};
    for (const double split : {side, side + kPi}) {
      const double from = math::whole_turn(split - segment.nu);
      if (from > kShort && from < sweep - kShort) ends.push_back(from);
    }
    std::ranges::sort(ends);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
      out.push_back(
          arc_part(segment.origin, segment.radius, segment.nu + ends[i], ends[i + 1] - ends[i]));
  }
  return out;
}

std::vector<HullPart> swept(const section::Curve& curve, const Vector2d& way) {
  auto parts = parts_of(curve, way);
  if (!(way.norm() > kShort)) return parts;
  std::vector<HullPart> out;
  for (auto& part : parts) {
    const Vector2d along =
        part.radius > 0.0 ? part.at(0.5 + 1e-3) - part.at(0.5 - 1e-3) : part.to - part.from;
    // Its outward normal is the tangent turned back by a right angle.
    const double faces = Vector2d(along.y(), -along.x()).normalized().dot(way);
    if (faces > kEqual * way.norm())
      for (auto* point : {&part.from, &part.to, &part.centre}) *point += way;
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    out.push_back(parts[i]);
    const auto& next = parts[(i + 1) % parts.size()];
    if ((next.from - parts[i].to).norm() > kEqual)
      out.push_back({.from = parts[i].to, .to = next.from});
  }
  return out;
}

bool is_rigid(const Matrix2d& onto) {
  return (onto.transpose() * onto - Matrix2d::Identity()).norm() < kEqual;
}

Contour drawn_contour(const std::vector<HullPart>& hull, const Matrix2d& onto,
                      const Vector2d& shift) {
  Drawing drawing(onto, shift);
  Contour out{.start = drawing.at(hull.front().from), .pieces = {}, .mirrored = true};
  for (const auto& part : hull) drawing.add(part);
  out.pieces = drawing.take();
  out.pieces.back().to = out.start;
  return out;
}

}  // namespace tubecut::cutout
