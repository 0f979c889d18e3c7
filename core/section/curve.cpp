#include "core/section/curve.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::section {
namespace {

using Eigen::Vector2d;

constexpr double kQuarter = 0.5 * kPi;
constexpr double kNoLength = 1e-9;  // of a half side: a flat so short is none

int next_face(int face) { return face % 4 + 1; }

/// The part of the outline that holds face j or corner j; face 1 has a second one, the last.
std::size_t part_of_face(int face) { return 2 * static_cast<std::size_t>(face - 1); }
std::size_t part_of_corner(int corner) { return 2 * static_cast<std::size_t>(corner) - 1; }
int face_of_part(std::size_t part) { return part == 8 ? 1 : static_cast<int>(part / 2) + 1; }
bool is_corner(std::size_t part) { return part % 2 == 1; }

}  // namespace

Vector2d Curve::face_normal(int face) {
  static constexpr std::array<std::array<double, 2>, 4> kNormals{
      {{1.0, 0.0}, {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}}};
  const auto& n = kNormals.at(static_cast<std::size_t>(face - 1));
  return {n[0], n[1]};
}

Curve::Curve(double height, double width, double corner)
    : corner_(corner), distance_{0.5 * height, 0.5 * width}, half_flat_{} {
  if (0.5 * std::min(height, width) - corner <= kNoLength * corner)
    corner_ = 0.5 * std::min(height, width);
  for (const std::size_t i : {0, 1}) {
    const double rest = distance_[1 - i] - corner_;  // a flat runs along the other axis
    half_flat_[i] = rest > kNoLength * corner_ ? rest : 0.0;
  }
  for (std::size_t part = 0; part < kParts; ++part) {
    const double flat = half_flat_[axis(face_of_part(part))];
    const bool half = part == 0 || part == 8;
    start_[part + 1] = start_[part] + (is_corner(part) ? corner_ * kQuarter
                                       : half          ? flat
                                                       : 2.0 * flat);
  }
  girth_ = start_[kParts];
  join_segments();
}

Vector2d Curve::corner_centre(int corner) const {
  const int next = next_face(corner);
  return (face_distance(corner) - corner_) * face_normal(corner) +
         (face_distance(next) - corner_) * face_normal(next);
}

double Curve::reach() const { return corner_centre(1).norm() + corner_; }

Station Curve::at(double s) const {
  Station out;
  out.s = s - girth_ * std::floor(s / girth_);
  if (!(out.s < girth_)) out.s = 0.0;
  std::size_t part = 0;
  while (part + 1 < kParts && !(out.s < start_[part + 1])) ++part;
  const double offset = out.s - start_[part];
  out.face = face_of_part(part);
  const Vector2d n = face_normal(out.face);
  const double quarters = static_cast<double>(part == 8 ? 4 : part / 2) * kQuarter;
  if (is_corner(part)) {
    const double angle = offset / corner_;
    const auto turn = elementary::sincos(angle);
    out.on_corner = true;
    out.along = angle;
    out.nu = quarters + angle;
    out.curvature = 1.0 / corner_;
    out.normal = turn.cos * n + turn.sin * face_normal(next_face(out.face));
    out.point = corner_centre(out.face) + corner_ * out.normal;
    return out;
  }
  out.along = part == 0 ? offset : offset - half_flat(out.face);
  out.nu = quarters;
  out.normal = n;
  out.point = face_distance(out.face) * n + out.along * out.tangent();
  return out;
}

Station Curve::after(const Station& from, double way) const {
  constexpr double kSmall = 0.2;  // rad: there the series below end at the last digit
  const double s = from.s + way;
  if (!(s < girth_)) return at(s);
  if (!from.on_corner) {
    if (!(from.along + way < half_flat(from.face))) return at(s);
    Station out = from;
    out.s = s;
    out.along += way;
    out.point += way * from.tangent();
    return out;
  }
  const double turn = way / corner_;
  if (!(turn < kSmall) || !(from.along + turn < kQuarter)) return at(s);
  const double q = turn * turn;
  const double sine =
      turn * (1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0))));
  const double cosine =
      1.0 - q / 2.0 * (1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0 * (1.0 - q / 90.0))));
  Station out = from;
  out.s = s;
  out.along += turn;
  out.nu += turn;
  out.normal = cosine * from.normal + sine * from.tangent();
  out.point += corner_ * (out.normal - from.normal);
  return out;
}

double Curve::on_face(int face, double along) const {
  if (face == 1) return along < 0.0 ? girth_ + along : along;
  return start_[part_of_face(face)] + half_flat(face) + along;
}

double Curve::on_corner(int corner, double angle) const {
  return start_[part_of_corner(corner)] + corner_ * angle;
}

void Curve::join_segments() {
  const auto add = [&](const OutlineSegment& segment) {
    if (!(segment.length > 0.0)) return;
    if (!segments_.empty()) {
      auto& last = segments_.back();
      const bool same = last.radius == segment.radius &&
                        (segment.is_arc() ? last.origin == segment.origin : last.nu == segment.nu);
      if (same) {
        last.length += segment.length;
        return;
      }
    }
    segments_.push_back(segment);
  };
  for (std::size_t part = 0; part < kParts; ++part) {
    const double length = start_[part + 1] - start_[part];
    const int face = face_of_part(part);
    const double quarters = static_cast<double>(part == 8 ? 4 : part / 2) * kQuarter;
    const Vector2d n = face_normal(face), t(-n.y(), n.x());
    const double along = part == 0 ? 0.0 : -half_flat(face);
    add({.from = start_[part],
         .length = length,
         .nu = quarters,
         .radius = is_corner(part) ? corner_ : 0.0,
         .origin =
             is_corner(part) ? corner_centre(face) : Vector2d(face_distance(face) * n + along * t),
         .normal = n});
  }
  // Across the datum the last segment goes on as the first.
  auto& first = segments_.front();
  const auto& last = segments_.back();
  const bool joined = segments_.size() > 1 && first.radius == last.radius &&
                      (first.is_arc() ? first.origin == last.origin : first.normal == last.normal);
  if (joined) {
    first.from = last.from - girth_;
    first.length += last.length;
    first.nu = last.nu - kTwoPi;
    first.normal = last.normal;
    first.origin = last.origin;
    segments_.pop_back();
  }
  if (segments_.size() == 1) return;
  for (const auto& segment : segments_)
    seams_.push_back(segment.from < 0.0 ? segment.from + girth_ : segment.from);
  std::ranges::sort(seams_);
}

}  // namespace tubecut::section
