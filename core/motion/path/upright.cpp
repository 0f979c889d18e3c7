#include "core/motion/path/upright.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"

namespace tubecut::motion {
namespace {

constexpr double kStepAngle = 1.5 * kRadPerDeg;  // between points on an arc
constexpr double kLongestStep = 0.5;             // mm; wide arcs need it for their chords
constexpr double kStepsOfBlend = 4.0;            // at least so many points to a half width

/// Returns these girths in order, those that are strictly between two and not as good as one.
std::vector<double> apart(std::vector<double> all, double from, double to) {
  constexpr double kSame = 1e-3;  // mm; nearer points are one
  std::ranges::sort(all);
  std::vector<double> out;
  for (const double s : all)
    if (s > from + kSame && s < to - kSame && (out.empty() || s > out.back() + kSame))
      out.push_back(s);
  return out;
}

/// The nearest place of the rectangle that the corners' centres span.
Eigen::Vector2d in_middle(const section::Section& section, const Eigen::Vector2d& point) {
  const Eigen::Vector2d half(0.5 * section.height - section.corner,
                             0.5 * section.width - section.corner);
  return point.cwiseMax(-half).cwiseMin(half);
}

}  // namespace

double equal_radius(const section::Section& section) { return section.outer().girth() / kTwoPi; }

double thickest(const section::Section& section) {
  const section::Wall wall(section);
  if (wall.concentric()) return section.wall;
  const auto& outer = wall.outer();
  const double middle = outer.on_corner(1, 0.125 * kTwoPi);
  return std::max(section.wall, wall.thickness(outer.at(middle)));
}

double normal_at(const section::Curve& outside, double s) {
  const auto at = outside.at(s);
  return at.nu + kTwoPi * std::round((s - at.s) / outside.girth());
}

double normal_of_first(const CutPath& path) {
  return normal_at(path.section->outer(), path.outer_radius * path.phi.front());
}

CutPath around(const section::Section& section) {
  CutPath out;
  out.outer_radius = equal_radius(section);
  out.wall = thickest(section);
  out.section = section;
  return out;
}

Upright::Upright(const section::Section& section, Angle lean, std::optional<double> still)
    : curve_(section.outer()),
      half_width_(6.0 * section.corner * lean.rad()),
      step_(std::min({kLongestStep, section.corner * kStepAngle, half_width_ / kStepsOfBlend})),
      still_(still) {
  const auto& segments = curve_.segments();
  const auto curvature = [](const section::OutlineSegment& p) {
    return p.is_arc() ? 1.0 / p.radius : 0.0;
  };
  for (std::size_t i = 0; i < segments.size() && segments.size() > 1; ++i) {
    const auto& before = segments[(i + segments.size() - 1) % segments.size()];
    seams_.push_back({segments[i].from, curvature(segments[i]) - curvature(before)});
  }
}

double Upright::angle(double s) const {
  if (still_) return *still_;
  const double girth = curve_.girth();
  const auto at = curve_.at(s);
  double out = normal_at(curve_, s);
  for (const Seam& seam : seams_) {
    const double apart = std::abs(std::remainder(at.s - seam.s, girth));
    if (apart >= half_width_) continue;
    const double left = half_width_ - apart;
    out += seam.jump * left * left * left / (6.0 * half_width_ * half_width_);
  }
  return out;
}

std::vector<double> Upright::breaks(double from, double to) const {
  const double girth = curve_.girth();
  std::vector<double> out;
  for (const Seam& seam : seams_)
    for (const double at : {seam.s - half_width_, seam.s, seam.s + half_width_})
      for (double s = at + girth * std::ceil((from - at) / girth); s < to; s += girth)
        out.push_back(s);
  return apart(std::move(out), from, to);
}

std::vector<double> Upright::places(double from, double to) const {
  const double girth = curve_.girth();
  std::vector<double> out;
  const auto add = [&](double low, double high) {
    const double steps = std::ceil((high - low) / step_);
    for (int k = 0; k <= static_cast<int>(steps); ++k)
      out.push_back(low + (high - low) * k / steps);
  };
  for (const auto& segment : curve_.segments()) {
    // Of a flat only its ends are blended; a round outline is one arc.
    const double reach = seams_.empty() ? 0.0 : half_width_;
    const double last = std::floor((to - segment.from + reach) / girth);
    for (double turn = std::floor((from - segment.to() - reach) / girth); turn <= last; ++turn) {
      if (!segment.is_arc()) continue;
      const double start = segment.from - reach + turn * girth;
      const double end = segment.to() + reach + turn * girth;
      if (end > from && start < to) add(start, end);
    }
  }
  return apart(std::move(out), from, to);
}

double beyond_outside(const section::Section& section, const Eigen::Vector2d& point) {
  const Eigen::Vector2d off = point - in_middle(section, point);
  return elementary::hypot(off.x(), off.y()) - section.corner;
}

double girth_at(const section::Section& section, const Eigen::Vector2d& point) {
  const Eigen::Vector2d off = point - in_middle(section, point);
  const auto outside = section.outer();
  if (off.x() == 0.0 || off.y() == 0.0) {
    const int face = off.x() != 0.0 ? (off.x() > 0.0 ? 1 : 3) : (off.y() < 0.0 ? 4 : 2);
    const auto n = section::Curve::face_normal(face);
    return outside.on_face(face, point.dot(Eigen::Vector2d(-n.y(), n.x())));
  }
  const double nu = elementary::atan2(off.y(), off.x());
  const double turned = nu < 0.0 ? nu + kTwoPi : nu;
  const int before = std::min(3, static_cast<int>(turned / (0.5 * kPi)));  // quarter turns
  return outside.on_corner(before + 1, turned - 0.5 * kPi * before);
}

double normal_towards(const section::Section& section, const Eigen::Vector2d& point) {
  const Eigen::Vector2d off = point - in_middle(section, point);
  return elementary::atan2(off.y(), off.x());
}

}  // namespace tubecut::motion
