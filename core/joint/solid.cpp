#include "core/joint/solid.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/math/search.hpp"

namespace tubecut::joint {

Solid::Solid(const Cutter& cutter) {
  if (const auto* tube = std::get_if<TubeCutter>(&cutter)) {
    const auto a = elementary::sincos(tube->inclination.rad());
    const auto b = elementary::sincos(tube->clocking.rad());
    point_ = {-tube->offset * b.cos, -tube->offset * b.sin, tube->height};
    direction_ = {a.sin * b.sin, -a.sin * b.cos, a.cos};
    radius_ = tube->radius;
  } else if (const auto* box = std::get_if<BoxCutter>(&cutter)) {
    kind_ = Kind::box;
    point_ = box->point;
    direction_ = box->direction.normalized();
    across_ = box->up.cross(direction_).normalized();
    up_ = direction_.cross(across_);
    half_width_ = 0.5 * box->width;
    half_height_ = 0.5 * box->height;
    corner_ = box->corner;
    radius_ = half_width_ + half_height_;
  } else if (const auto* cone = std::get_if<ConeCutter>(&cutter)) {
    kind_ = Kind::cone;
    point_ = cone->point;
    direction_ = cone->direction.normalized();
    const auto half = elementary::sincos(cone->half_angle.rad());
    sine_ = half.sin;
    cosine_ = half.cos;
    radius_ = cone->radius;
  } else if (const auto* elbow = std::get_if<ElbowCutter>(&cutter)) {
    kind_ = Kind::elbow;
    direction_ = elbow->direction.normalized();
    across_ = -(elbow->inwards - elbow->inwards.dot(direction_) * direction_).normalized();
    point_ = elbow->point - elbow->bend_radius * across_;
    radius_ = elbow->radius;
    bend_radius_ = elbow->bend_radius;
    bend_ = elbow->bend.rad();
  } else {
    const auto& plane = std::get<PlaneCutter>(cutter);
    kind_ = Kind::plane;
    point_ = plane.point;
    direction_ = plane.normal.normalized();
    if (direction_.z() < 0.0) direction_ = -direction_;
  }
}

Eigen::Vector3d Solid::own(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d from = point - point_;
  return {from.dot(across_), from.dot(up_), from.dot(direction_)};
}

double Solid::box_distance(const Eigen::Vector3d& point) const {
  const auto p = own(point);
  const double x = std::abs(p.x()) - half_width_ + corner_;
  const double y = std::abs(p.y()) - half_height_ + corner_;
  if (x > 0.0 && y > 0.0) return elementary::hypot(x, y) - corner_;
  return std::max(x, y) - corner_;
}

Eigen::Vector3d Solid::box_normal(const Eigen::Vector3d& point) const {
  const auto p = own(point);
  const double x = std::abs(p.x()) - half_width_ + corner_;
  const double y = std::abs(p.y()) - half_height_ + corner_;
  const Eigen::Vector3d across = p.x() < 0.0 ? Eigen::Vector3d(-across_) : across_;
  const Eigen::Vector3d up = p.y() < 0.0 ? Eigen::Vector3d(-up_) : up_;
  if (x > 0.0 && y > 0.0) return (x * across + y * up).normalized();
  return x > y ? across : up;
}

// By the angle around the bend's axis, clamped to the arc, and by the feet on the two legs.
Eigen::Vector3d Solid::on_centre_line(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d from = point - point_;
  double turn = elementary::atan2(from.dot(direction_), from.dot(across_)) - 0.5 * bend_;
  turn -= kTwoPi * std::floor(turn / kTwoPi + 0.5);
  const auto at = elementary::sincos(std::clamp(turn, -0.5 * bend_, 0.5 * bend_) + 0.5 * bend_);
  const auto end = elementary::sincos(bend_);
  const Eigen::Vector3d start_point = point_ + bend_radius_ * across_;
  const Eigen::Vector3d end_point =
      point_ + bend_radius_ * (end.cos * across_ + end.sin * direction_);
  const Eigen::Vector3d leaving = end.cos * direction_ - end.sin * across_;
  Eigen::Vector3d best = point_ + bend_radius_ * (at.cos * across_ + at.sin * direction_);
  for (const Eigen::Vector3d& foot :
       {Eigen::Vector3d(start_point -
                        std::max(0.0, (start_point - point).dot(direction_)) * direction_),
        Eigen::Vector3d(end_point + std::max(0.0, (point - end_point).dot(leaving)) * leaving)})
    if ((point - foot).norm() < (point - best).norm()) best = foot;
  return best;
}

Eigen::Vector2d Solid::elbow_range(double x, double y) const {
  const auto end = elementary::sincos(bend_);
  const Eigen::Vector3d leaving = end.cos * direction_ - end.sin * across_;
  const double steep = std::max(std::abs(direction_.z()), std::abs(leaving.z()));
  const double flat = std::sqrt(std::max(1e-12, (1.0 - steep) * (1.0 + steep)));
  const double reach = elementary::hypot(x - point_.x(), y - point_.y()) + bend_radius_ + radius_;
  return {point_.z() - 2.0 * reach / flat, point_.z() + 2.0 * reach / flat};
}

std::optional<double> Solid::elbow_top(double x, double y) const {
  constexpr int kSteps = 20'000;
  const auto range = elbow_range(x, y);
  const double near = 1e-12 * (radius_ + bend_radius_ + std::abs(point_.z()));
  double z = range[1];
  for (int step = 0; step < kSteps && z > range[0]; ++step) {
    const double away = distance({x, y, z});
    if (away <= near) return z;
    z -= away;
  }
  return std::nullopt;
}

double Solid::deepest(double x, double y) const {
  const auto deep = [&](double z) { return -distance({x, y, z}); };
  // Near the axis, then out to both sides until it is shallower there.
  const Eigen::Vector3d from = Eigen::Vector3d(x, y, 0.0) - point_;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ() - direction_.z() * direction_;
  const double middle = -from.dot(up) / up.squaredNorm();
  double reach = radius_;
  for (int i = 0;
       i < 80 && std::max(deep(middle - reach), deep(middle + reach)) > deep(middle) - reach * 1e-3;
       ++i)
    reach *= 2.0;
  return math::golden_maximum(deep, middle - reach, middle + reach).at;
}

double Solid::distance(const Eigen::Vector3d& point) const {
  if (kind_ == Kind::box) return box_distance(point);
  if (kind_ == Kind::elbow) return (point - on_centre_line(point)).norm() - radius_;
  const Eigen::Vector3d from = point - point_;
  if (kind_ == Kind::plane) return from.dot(direction_);
  const double out = from.cross(direction_).norm() - radius_;
  return kind_ == Kind::tube ? out : cosine_ * out - sine_ * from.dot(direction_);
}

Eigen::Vector3d Solid::normal(const Eigen::Vector3d& point) const {
  if (kind_ == Kind::plane) return direction_;
  if (kind_ == Kind::box) return box_normal(point);
  if (kind_ == Kind::elbow) return (point - on_centre_line(point)).normalized();
  const Eigen::Vector3d from = point - point_;
  const Eigen::Vector3d radial = (from - from.dot(direction_) * direction_).normalized();
  return kind_ == Kind::tube ? radial : Eigen::Vector3d(cosine_ * radial - sine_ * direction_);
}

double Solid::nearest_share(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  const Eigen::Vector3d way = b - a;
  if (kind_ == Kind::plane) return way.dot(direction_) < 0.0 ? 1.0 : 0.0;
  const Eigen::Vector3d across = way - way.dot(direction_) * direction_;
  const double square = across.squaredNorm();
  return square > 0.0 ? std::clamp((point_ - a).dot(across) / square, 0.0, 1.0) : 0.0;
}

double Solid::most_bent(double from) const {
  if (kind_ == Kind::plane) return 0.0;
  const double from_axis = radius_ + from;
  return from_axis > 0.0 ? 1.0 / from_axis : std::numeric_limits<double>::infinity();
}

// The centre line, an arc of at most half a turn with its legs, is nowhere nearer to itself than
// its bend radius R: within s < R of it the distance bends inwards by at most 1/(R - s).
double Solid::most_hollow(double to) const {
  if (kind_ != Kind::elbow) return 0.0;
  const double room = bend_radius_ - std::max(0.0, radius_ + to);
  return room > 0.0 ? 1.0 / room : std::numeric_limits<double>::infinity();
}

std::optional<double> Solid::top(double x, double y) const {
  const Eigen::Vector3d from = Eigen::Vector3d(x, y, 0.0) - point_;
  if (kind_ == Kind::plane) return -from.dot(direction_) / direction_.z();
  if (kind_ == Kind::elbow) return elbow_top(x, y);
  if (kind_ != Kind::tube) {
    const double low = deepest(x, y);
    if (distance({x, y, low}) > 1e-12 * (radius_ + from.norm())) return std::nullopt;
    double high = low + radius_;
    for (int i = 0; i < 80 && distance({x, y, high}) <= 0.0; ++i) high += high - low;
    return math::last_true([&](double z) { return distance({x, y, z}) <= 0.0; }, low, high);
  }
  // |(from + z e_z) - ((from + z e_z).d) d|^2 = r^2, a quadratic in z.
  const Eigen::Vector3d across = from - from.dot(direction_) * direction_;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ() - direction_.z() * direction_;
  const double a = up.squaredNorm();
  const double half_b = across.dot(up);
  const double gap = clearance(x, y);
  if (gap > 1e-12 * (radius_ + from.norm())) return std::nullopt;
  // The discriminant is a (r - m)(r + m), m the least distance of line and axis: no cancellation.
  const double inside = std::max(0.0, -gap * (gap + 2.0 * radius_));
  return (-half_b + std::sqrt(a * inside)) / a;
}

double Solid::clearance(double x, double y) const {
  if (kind_ == Kind::plane) return -1.0;
  if (kind_ == Kind::elbow) {
    constexpr int kSamples = 400;
    const auto range = elbow_range(x, y);
    std::vector<double> z, deep;
    const auto depth = [&](double at) { return -distance({x, y, at}); };
    for (int k = 0; k <= kSamples; ++k) {
      z.push_back(range[0] + (range[1] - range[0]) * k / kSamples);
      deep.push_back(depth(z.back()));
    }
    return -math::grid_maximum(depth, z, deep).value;
  }
  if (kind_ != Kind::tube) return distance({x, y, deepest(x, y)});
  const Eigen::Vector3d from = Eigen::Vector3d(x, y, 0.0) - point_;
  const Eigen::Vector3d common = direction_.cross(Eigen::Vector3d::UnitZ()).normalized();
  return std::abs(from.dot(common)) - radius_;
}

}  // namespace tubecut::joint
