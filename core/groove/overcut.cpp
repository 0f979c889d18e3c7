#include "core/groove/overcut.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"

namespace tubecut::groove {
namespace {

using Neighbour = Neighbourhood::Neighbour;

double radius_at(const JointGeometry& joint, double v) {
  return joint.root_radius + v * joint.groove_width;
}

Eigen::Vector3d point_on(const JointGeometry& joint, const Neighbour& ruling, double v) {
  const double s = radius_at(joint, v);
  return {s * ruling.cos, s * ruling.sin, ruling.z3 + v * ruling.height};
}

Eigen::Vector3d turn_of(const JointGeometry& joint, const Neighbour& ruling, double v) {
  const double s = radius_at(joint, v);
  return {-s * ruling.sin, s * ruling.cos, ruling.z3_d + v * ruling.height_d};
}

tl::expected<Neighbour, ErrorCode> neighbour(const JointGeometry& joint, Angle omega, double delta,
                                             std::optional<double> near) {
  TRY(const auto found, section(joint, omega + Angle::rad(delta), near));
  const auto [s, c] = elementary::sincos(delta);
  return Neighbour{delta,          s,           c,        found.toe.y1, found.height, found.z3_d,
                   found.height_d, found.toe.D, found.D_d};
}

/// The cubic by values and slopes at both ends of [0, width].
struct Cubic {
  double a, slope_a, b, slope_b, width;

  [[nodiscard]] double at(double x) const {
    const double t = x / width, u = 1.0 - t;
    return u * u * ((1.0 + 2.0 * t) * a + x * slope_a) +
           t * t * ((1.0 + 2.0 * u) * b - (width - x) * slope_b);
  }
  /// Returns its minimum, if `slope_a` is negative and `slope_b` positive.
  [[nodiscard]] double least() const {
    const double secant = 3.0 * (b - a) / width;
    const double mean = slope_a + slope_b - secant;  // of the slope's quadratic
    const double root = std::sqrt(std::max(0.0, mean * mean - slope_a * slope_b));
    const double below = slope_b + root - mean;
    return width * (1.0 - below / (slope_b - slope_a + 2.0 * root));
  }
};

/// Distance's derivative along omega at one level, and the values that it comes from.
struct Slope {
  double value = 0.0;
  Contact contact;
};

Slope slope_at(const Neighbourhood& near, const Cone& cone, const ToolPose& pose,
               const Neighbour& ruling, double v) {
  Slope out;
  out.contact.point = point_on(*near.joint, ruling, v);
  out.contact.delta = ruling.delta;
  const FlankFoot foot = cone.foot(pose, out.contact.point);
  out.contact.gap = foot.distance;
  out.contact.gradient = foot.gradient;
  out.contact.along = foot.along;
  out.value = foot.gradient.dot(turn_of(*near.joint, ruling, v));
  return out;
}

/// Returns a guess of D between two rulings with known D.
double toe_near(const Neighbour& low, const Neighbour& high, double delta) {
  const Cubic D{low.D, low.D_d, high.D, high.D_d, high.delta - low.delta};
  return D.at(delta - low.delta);
}

/// Finds the zero of the slope between two rulings whose slopes differ in sign: at the minimum of
/// the cubic through both distances and slopes, three times, then by the Illinois false position.
tl::expected<Contact, ErrorCode> solve_contact(const Neighbourhood& near, const Cone& cone,
                                               const ToolPose& pose, double v, int ruling,
                                               Slope low, Slope high) {
  constexpr double kFlat = 1e-9;  // mm/rad; moves the gap by less than 1e-18 mm
  constexpr int kCubics = 3;
  constexpr int kSteps = 100;  // Illinois at least halves within three steps
  const Neighbour& first = near.rulings[std::size_t(ruling)];
  const Neighbour& last = near.rulings[std::size_t(ruling + 1)];
  int last_side = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double a = low.contact.delta, b = high.contact.delta;
    const Cubic distance{low.contact.gap, low.value, high.contact.gap, high.value, b - a};
    double delta = a + distance.least();
    if (i >= kCubics || !(delta > a && delta < b))
      delta = b - high.value * (b - a) / (high.value - low.value);
    if (!(delta > a && delta < b)) break;  // no double is between them
    TRY(const auto between,
        neighbour(*near.joint, near.omega, delta, toe_near(first, last, delta)));
    Slope here = slope_at(near, cone, pose, between, v);
    if (std::abs(here.value) <= kFlat) return here.contact;
    const int side = here.value < 0.0 ? -1 : 1;
    if (i >= kCubics && side == last_side) (side < 0 ? high : low).value *= 0.5;
    (side < 0 ? low : high) = std::move(here);
    last_side = side;
  }
  return std::abs(low.value) < std::abs(high.value) ? low.contact : high.contact;
}

tl::expected<Contact, ErrorCode> contact_at(const Neighbourhood& near, const Cone& cone,
                                            const ToolPose& pose, int level) {
  const int count = int(near.rulings.size());
  int deepest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int j = 0; j < count; ++j) {
    const double d = cone.flank(pose, near.samples[std::size_t(j * near.points + level)]);
    if (d < least) {
      least = d;
      deepest = j;
    }
  }
  if (deepest == 0 || deepest == count - 1) return tl::unexpected(ErrorCode::window);
  const double v = double(level) / (near.points - 1);
  const auto slope = [&](int j) {
    return slope_at(near, cone, pose, near.rulings[std::size_t(j)], v);
  };
  Slope low = slope(deepest - 1), middle = slope(deepest), high = slope(deepest + 1);
  // A guard that has never fired, at any pitch up to 45 deg in 7320 random positions. The flank is
  // convex and the groove bends less between two rulings than the flank does (d'' of section 7 is
  // some hundred mm), so the distance is convex along omega around its minimum, and the rulings
  // next to the deepest of three have slopes of either sign. Only a groove wavier than the pitch
  // could differ; then no contact line is reliable.
  if (!(low.value < 0.0 && high.value > 0.0)) return tl::unexpected(ErrorCode::contact);
  if (middle.value == 0.0) return middle.contact;
  return middle.value > 0.0 ? solve_contact(near, cone, pose, v, deepest - 1, low, middle)
                            : solve_contact(near, cone, pose, v, deepest, middle, high);
}

}  // namespace

int ruling_reach(const GapCheck& check) {
  return int(std::floor(check.window.rad() / check.pitch.rad() * (1.0 + 1e-12)));
}

tl::expected<Neighbourhood, ErrorCode> neighbourhood(const JointGeometry& joint, Angle omega,
                                                     const GapCheck& check) {
  Neighbourhood out{&joint, omega, check.points, {}, {}};
  const int reach = ruling_reach(check);
  out.rulings.reserve(std::size_t(2 * reach + 1));
  out.samples.reserve(std::size_t(2 * reach + 1) * std::size_t(check.points));
  std::optional<double> near;  // D of the ruling before, and its extrapolation
  for (int m = -reach; m <= reach; ++m) {
    if (stopped()) return tl::unexpected(ErrorCode::cancelled);
    TRY(const auto found, neighbour(joint, omega, m * check.pitch.rad(), near));
    near = found.D + found.D_d * check.pitch.rad();
    out.rulings.push_back(found);
    for (int i = 0; i < check.points; ++i)
      out.samples.push_back(point_on(joint, found, double(i) / (check.points - 1)));
  }
  return out;
}

GridFigures grid_figures(const Neighbourhood& near, const Cone& cone, const ToolPose& pose) {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  GridFigures out;
  for (std::size_t j = 0; j < near.rulings.size(); ++j) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = j * std::size_t(near.points); i < (j + 1) * std::size_t(near.points);
         ++i) {
      const double d = cone.flank(pose, near.samples[i]);
      low = std::min(low, d);
      high = std::max(high, d);
    }
    if (low >= least) continue;
    least = low;
    most = high;
  }
  out.over = std::max(0.0, -least);
  out.under = std::max(0.0, most);
  return out;
}

tl::expected<Gap, ErrorCode> gap(const Neighbourhood& near, const Cone& cone,
                                 const ToolPose& pose) {
  Gap out;
  for (int i = 0; i < near.points; ++i) {
    TRY(const auto found, contact_at(near, cone, pose, i));
    out.over = std::max(out.over, -found.gap);
    out.under = std::max(out.under, found.gap);
    out.contacts.push_back(found);
  }
  out.largest = std::max(out.over, out.under);
  return out;
}

}  // namespace tubecut::groove
