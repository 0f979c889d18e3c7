#include "core/groove/section.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/elementary.hpp"
#include "core/base/try.hpp"

namespace tubecut::groove {
namespace {

/// The chord in one section: y over x and its derivatives.
struct ChordLine {
  const JointGeometry& joint;
  Direction dir;

  [[nodiscard]] double t(double x) const { return x * dir.sin + joint.eccentricity; }
  [[nodiscard]] double q(double t) const {
    return std::sqrt(std::max(0.0, (joint.chord_radius - t) * (joint.chord_radius + t)));
  }
  [[nodiscard]] double y(double x, double q) const {
    return (x * dir.cos * joint.cos_a + q) / joint.sin_a;
  }
  [[nodiscard]] double slope(double t, double q) const {
    return (dir.cos * joint.cos_a - t * dir.sin / q) / joint.sin_a;
  }
  [[nodiscard]] double turn(double x, double t, double q) const {  // Y_w
    return -x * (dir.sin * joint.cos_a + t * dir.cos / q) / joint.sin_a;
  }
  [[nodiscard]] double turn2(double x, double t, double q) const {  // Y_ww
    const double R = joint.chord_radius;
    const double along = x * dir.cos;
    return (-along * joint.cos_a + t * x * dir.sin / q - along * along * R * R / (q * q * q)) /
           joint.sin_a;
  }
  /// Returns how far out the section line extends before the chord's silhouette.
  [[nodiscard]] double reach() const {
    if (dir.sin == 0.0) return std::numeric_limits<double>::infinity();
    const double side = dir.sin > 0.0 ? -joint.eccentricity : joint.eccentricity;
    return (joint.chord_radius + side) / std::abs(dir.sin);
  }
};

/// Places P2 at distance D outward of P1.
void place_p2(const ChordLine& chord, double D, Toe& toe) {
  toe.D = D;
  toe.x2 = toe.x1 + D;
  toe.t2 = chord.t(toe.x2);
  toe.q2 = chord.q(toe.t2);
  const double dq = -D * chord.dir.sin * (toe.t1 + toe.t2) / (toe.q1 + toe.q2);
  toe.dy = (D * chord.dir.cos * chord.joint.cos_a + dq) / chord.joint.sin_a;
  toe.slope2 = chord.slope(toe.t2, toe.q2);
}

/// Solves D^2 + dy^2 = c^2 within (0, reach]: Newton while it stays in the bracket, else bisection,
/// as well as after 50 steps, until the distance is c except for its rounding.
bool solve_p2(const ChordLine& chord, std::optional<double> near, Toe& toe) {
  constexpr int kNewtonSteps = 50, kSteps = 120;  // 70 halvings leave less than 1e-21 c
  constexpr double kRounding = 2e-15;             // of c^2
  const double c = chord.joint.weld_width;
  const auto place = [&](double D) {
    place_p2(chord, D, toe);
    return D * D + toe.dy * toe.dy - c * c;
  };
  double low = 0.0, high = std::min(c, chord.reach() - toe.x1);
  if (!(high > 0.0)) return false;
  if (high < c && !(place(high) >= 0.0)) return false;  // at D = c the distance is c or more
  double D = std::clamp(near.value_or(c / std::sqrt(1.0 + toe.slope1 * toe.slope1)), 0.0, high);
  for (int i = 0; i < kSteps; ++i) {
    const double f = place(D);
    if (std::abs(f) <= kRounding * c * c) break;
    (f < 0.0 ? low : high) = D;
    double next = D - f / (2.0 * (D + toe.dy * toe.slope2));
    if (i >= kNewtonSteps || !(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - D) <= 4e-16 * c) break;
    D = next;
  }
  return true;
}

/// Computes theta - sin theta, without cancellation.
double bulge(double theta) {
  if (theta > 0.7) return theta - elementary::sin(theta);
  const double s = theta * theta;
  double sum = 1.0;
  for (const double k : {1.0 / 272, 1.0 / 210, 1.0 / 156, 1.0 / 110, 1.0 / 72, 1.0 / 42, 1.0 / 20})
    sum = 1.0 - s * k * sum;
  return theta * s / 6.0 * sum;
}

void measure_bow(const JointGeometry& joint, Direction dir, Toe& toe) {
  if (dir.sin == 0.0) return;
  const double R = joint.chord_radius;
  const double dt = toe.D * dir.sin;
  const double dq = -dt * (toe.t1 + toe.t2) / (toe.q1 + toe.q2);
  toe.half_sin = std::min(1.0, std::sqrt(dt * dt + dq * dq) / (2.0 * R));
  toe.theta = 2.0 * elementary::asin(toe.half_sin);
  toe.bow = R * R * bulge(toe.theta) / (2.0 * std::abs(dir.sin) * joint.sin_a);
}

struct AreaAt {
  double value = 0.0;  // S_D of the axial section
  double slope = 0.0;  // its derivative by omega
};

/// Returns the steps of the area's factors from omega = 0.
double station(const PeriodicSpline& factors, Direction dir) {
  return elementary::atan2(dir.sin, dir.cos) / kTwoPi * static_cast<double>(factors.count());
}

AreaAt area_at(const JointGeometry& joint, Direction dir) {
  if (!joint.area_factor) return {joint.area, 0.0};
  const auto& factors = *joint.area_factor;
  const double at = station(factors, dir), per_turn = static_cast<double>(factors.count());
  return {joint.area * factors(at), joint.area * factors.slope(at) * per_turn / kTwoPi};
}

/// Computes d S_C / d omega from D'.
double bow_slope(const JointGeometry& joint, Direction dir, const Toe& toe, double D_d) {
  if (dir.sin == 0.0) return 0.0;
  const double R = joint.chord_radius;
  const double half = toe.half_sin;
  const double theta_d = (D_d * dir.sin + toe.x2 * dir.cos) / toe.q2 - toe.x1 * dir.cos / toe.q1;
  return (R * R * half * half * theta_d / joint.sin_a - toe.bow * dir.cos) / dir.sin;
}

}  // namespace

Direction direction(Angle omega) {
  const auto [s, c] = elementary::sincos(omega.rad());
  const double rounding = 4e-16 * std::max(1.0, std::abs(omega.rad()) / kTwoPi);
  if (std::abs(s) <= rounding) return {0.0, c > 0.0 ? 1.0 : -1.0};
  if (std::abs(c) <= rounding) return {s > 0.0 ? 1.0 : -1.0, 0.0};
  return {s, c};
}

tl::expected<Toe, ErrorCode> toe(const JointGeometry& joint, Direction dir,
                                 std::optional<double> near) {
  const ChordLine chord{joint, dir};
  Toe toe;
  toe.x1 = joint.root_radius;
  toe.t1 = chord.t(toe.x1);
  toe.q1 = chord.q(toe.t1);
  toe.y1 = chord.y(toe.x1, toe.q1);
  toe.slope1 = chord.slope(toe.t1, toe.q1);
  if (!solve_p2(chord, near, toe)) return tl::unexpected(ErrorCode::no_p2);
  toe.y2 = toe.y1 + toe.dy;
  // The chord is concave over x, so the distance from P1 grows along it for certain while it turns
  // by less than a right angle. At a right angle without eccentricity, both slopes have one sign
  // and this always holds; a steep heel and a thick wall turn further.
  if (!(1.0 + toe.slope1 * toe.slope2 > 0.0)) return tl::unexpected(ErrorCode::p2_ambiguous);
  measure_bow(joint, dir, toe);
  return toe;
}

std::optional<double> chord_height(const JointGeometry& joint, Direction dir, double x) {
  const ChordLine chord{joint, dir};
  const double t = chord.t(x);
  if (!(std::abs(t) <= joint.chord_radius)) return std::nullopt;
  return chord.y(x, chord.q(t));
}

double axial_factor(const JointGeometry& joint, Direction dir) {
  return joint.area_factor ? (*joint.area_factor)(station(*joint.area_factor, dir)) : 1.0;
}

double first_order_factor(const JointGeometry& joint, Direction dir, const Toe& toe) {
  const double z3_d = ChordLine{joint, dir}.turn(toe.x1, toe.t1, toe.q1);
  return std::sqrt(1.0 + z3_d * z3_d / (joint.root_radius * joint.root_radius));
}

double filler_area(const JointGeometry& joint, const Toe& toe, double height) {
  return 0.5 * (height * toe.D - joint.groove_width * toe.dy) - toe.bow;
}

tl::expected<Section, ErrorCode> section(const JointGeometry& joint, Angle omega,
                                         std::optional<double> near) {
  Section out{.omega = omega, .dir = direction(omega)};
  TRY(out.toe, toe(joint, out.dir, near));
  const Toe& p = out.toe;
  const ChordLine chord{joint, out.dir};
  const double H = joint.groove_width;
  const auto [area, area_d] = area_at(joint, out.dir);
  out.height = (2.0 * (area + p.bow) + H * p.dy) / p.D;
  out.y3 = p.y1 + out.height;
  out.z3_d = chord.turn(p.x1, p.t1, p.q1);
  const double turn2 = chord.turn(p.x2, p.t2, p.q2);
  out.D_d = -p.dy * (turn2 - out.z3_d) / (p.D + p.dy * p.slope2);
  const double dy_d = turn2 + p.slope2 * out.D_d - out.z3_d;
  const double bow_d = bow_slope(joint, out.dir, p, out.D_d);
  out.height_d = (2.0 * (area_d + bow_d) + H * dy_d - out.height * out.D_d) / p.D;
  return out;
}

Areas areas(const JointGeometry& joint, const Section& section) {
  const Toe& p = section.toe;
  const double H = joint.groove_width, h = section.height;
  Areas out;
  out.a = 0.5 * H * h;
  out.b = -0.5 * p.D * p.dy;
  out.c = p.bow;
  out.d = filler_area(joint, p, h);
  out.e = 0.5 * (H + p.D) * (h - p.dy);
  return out;
}

}  // namespace tubecut::groove
