#include "core/groove/normal_area.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/groove/section.hpp"

namespace tubecut::groove {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kKnots = 72;       // of the factor, per revolution
constexpr int kPatience = 4;     // rounds without progress
constexpr double kEqual = 2e-4;  // of the area, at the knots
constexpr double kEnough = 0.9;  // of the values requested in a round
constexpr int kPoints = 8;       // on each side of the filler; twice as many for the extrapolation
constexpr int kSteps = 40;       // of the intersection of a plane and a line
constexpr double kFar = 80.0 * kRadPerDeg;
constexpr double kMet = 1e-9;  // rad

/// The three sides of the filler: groove, weld face, chord.
enum class Side : std::uint8_t { groove, face, chord };
constexpr std::array kSides{Side::groove, Side::face, Side::chord};  // in circular order

/// Returns a point of a side, in its axial section: at the fraction `share` along it, in circular
/// order.
Vector2d on_side(const JointGeometry& joint, const Section& at, Side side, double share) {
  const Vector2d p1{at.toe.x1, at.toe.y1}, p2{at.toe.x2, at.toe.y2};
  const Vector2d p3{joint.branch_radius, at.y3};
  if (side == Side::groove) return p1 + share * (p3 - p1);
  if (side == Side::face) return p3 + share * (p2 - p3);
  const double x = p2.x() + share * (p1.x() - p2.x());
  const double t = x * at.dir.sin + joint.eccentricity;
  const double q = std::sqrt((joint.chord_radius - t) * (joint.chord_radius + t));
  return {x, (x * at.dir.cos * joint.cos_a + q) / joint.sin_a};
}

/// The plane normal to curve 3 at one section.
class NormalPlane {
 public:
  NormalPlane(const JointGeometry& joint, const Section& at) : joint_(joint), at_(at) {}

  /// Returns the intersection with the point of a side that all sections have, in coordinates of
  /// the plane.
  [[nodiscard]] std::optional<Vector2d> meets(Side side, double share) const {
    double turn = 0.0, off = 0.0;
    auto point = on_side(joint_, at_, side, share);
    double next = -at_.z3_d * (point.y() - at_.toe.y1) / (joint_.root_radius * point.x());
    off = ahead(0.0, point);
    for (int step = 0; step < kSteps; ++step) {
      if (!(std::abs(next) < kFar)) return std::nullopt;
      const auto there = section(joint_, at_.omega + Angle::rad(next));
      if (!there) return std::nullopt;
      point = on_side(joint_, *there, side, share);
      const double off_there = ahead(next, point);
      const double by = off_there == off ? 0.0 : -off_there * (next - turn) / (off_there - off);
      turn = next;
      off = off_there;
      if (std::abs(by) < kMet) return in_plane(turn, point);
      next += by;
    }
    return std::nullopt;
  }

 private:
  /// Returns the distance along curve 3 from the plane, times the length of its derivative.
  [[nodiscard]] double ahead(double turn, const Vector2d& p) const {
    return joint_.root_radius * p.x() * elementary::sin(turn) + at_.z3_d * (p.y() - at_.toe.y1);
  }
  [[nodiscard]] Vector2d in_plane(double turn, const Vector2d& p) const {
    const auto [sin, cos] = elementary::sincos(turn);
    const double length = elementary::hypot(joint_.root_radius, at_.z3_d);
    const double along = p.x() * sin, up = p.y() - at_.toe.y1;
    return {p.x() * cos - at_.toe.x1, (joint_.root_radius * up - at_.z3_d * along) / length};
  }

  const JointGeometry& joint_;
  const Section& at_;
};

/// Computes the area of the polygon through this many points of each side.
std::optional<double> polygon(const NormalPlane& plane, int points) {
  std::vector<Vector2d> corners;
  for (const Side side : kSides)
    for (int k = 0; k < points; ++k) {
      const auto met = plane.meets(side, static_cast<double>(k) / points);
      if (!met) return std::nullopt;
      corners.push_back(*met);
    }
  double twice = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * std::abs(twice);
}

Angle station(int k, int of) { return Angle::rad(kTwoPi * k / of); }

struct Furthest {
  double off = 0.0;
  Angle omega;
  double area = 0.0;

  void add(double share, Angle at, double found) {
    if (!(std::abs(share) <= std::abs(off))) *this = {share, at, found};
  }
};

Furthest nowhere(Angle omega) {
  return {std::numeric_limits<double>::infinity(), omega, std::numeric_limits<double>::quiet_NaN()};
}

Result<void> refuse(const JointGeometry& joint, const Furthest& worst) {
  const bool found = std::isfinite(worst.area);
  return fail(
      {.code = ErrorCode::normal_area,
       .member = "area_in",
       .got = "normal",
       .hint = "at omega " + degrees_text(worst.omega) + " the plane normal to the seam " +
               (found ? "cuts " + brief(worst.area) + " mm2 of filler, not " + brief(joint.area)
                      : "runs along the groove") +
               "; request equal areas in axial sections"});
}

/// Sets the joint's area to that of its normal section at the kept angle, and keeps the axial area
/// there. Returns false when there is no such section.
bool keep(const KeptArea& kept, JointGeometry& joint, std::vector<double>& factors) {
  const double turn = kept.at.rad() / kTwoPi * kKnots;
  const auto scale = [&](double by) {
    for (double& factor : factors) factor *= by;
    joint.area_factor = PeriodicSpline(factors);
  };
  scale(kept.axial / (joint.area * (*joint.area_factor)(turn)));
  const auto here = normal_area(joint, kept.at);
  if (!here || !(*here > 0.0)) return false;
  scale(joint.area / *here);
  joint.area = *here;
  return true;
}

/// Runs one round: computes the areas from the factors. Returns false when a section does not
/// exist.
bool areas_of(const JointGeometry& joint, std::vector<double>& out, Furthest& none) {
  for (int k = 0; k < kKnots && !stopped(); ++k) {
    const auto area = normal_area(joint, station(k, kKnots));
    if (!area || !(*area > 0.0)) {
      none = nowhere(station(k, kKnots));
      return false;
    }
    out[static_cast<std::size_t>(k)] = *area;
  }
  return true;
}

}  // namespace

std::optional<double> normal_area(const JointGeometry& joint, Angle omega) {
  const auto at = section(joint, omega);
  if (!at) return std::nullopt;
  const NormalPlane plane(joint, *at);
  const auto coarse = polygon(plane, kPoints), fine = polygon(plane, 2 * kPoints);
  if (!coarse || !fine) return std::nullopt;
  return (4.0 * *fine - *coarse) / 3.0;
}

double normal_area_off(const JointGeometry& joint, double area, int stations) {
  double worst = 0.0;
  for (int k = 0; k < stations && !stopped(); ++k) {
    const auto found = normal_area(joint, station(k, stations));
    if (!found) return std::numeric_limits<double>::infinity();
    worst = std::max(worst, std::abs(*found / area - 1.0));
  }
  return worst;
}

Result<void> equal_normal_areas(JointGeometry& joint, const std::optional<KeptArea>& kept) {
  std::vector<double> factors, found(kKnots);
  for (int k = 0; k < kKnots; ++k) {
    const auto dir = direction(station(k, kKnots));
    const auto at = toe(joint, dir);
    if (!at) return {};  // the survey reports it
    factors.push_back(first_order_factor(joint, dir, *at));
    if (!(filler_area(joint, *at, 0.0) < joint.area * factors.back())) return {};  // likewise
  }
  Furthest worst;
  double best = std::numeric_limits<double>::infinity();
  for (int since = 0; best > kEqual && since < kPatience; ++since) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    JointGeometry tried = joint;
    tried.area_factor = PeriodicSpline(factors);
    if (kept && !keep(*kept, tried, factors)) return refuse(joint, nowhere(kept->at));
    if (!areas_of(tried, found, worst)) break;
    worst = {};
    for (std::size_t k = 0; k < kKnots; ++k) {
      const double share = found[k] / tried.area;
      worst.add(share - 1.0, station(static_cast<int>(k), kKnots), found[k]);
      factors[k] /= 1.0 + kEnough * (share - 1.0);
    }
    if (std::abs(worst.off) >= best) continue;
    best = std::abs(worst.off);
    joint = std::move(tried);
    since = 0;
  }
  if (!joint.area_factor) return refuse(joint, worst);
  worst = {};
  for (int k = 1; k < 2 * kKnots; k += 2) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    const Angle between = station(k, 2 * kKnots);
    const auto area = normal_area(joint, between);
    if (!area) return refuse(joint, nowhere(between));
    worst.add(*area / joint.area - 1.0, between, *area);
  }
  if (!(std::abs(worst.off) <= kNormalAreaLimit)) return refuse(joint, worst);
  return {};
}

}  // namespace tubecut::groove
