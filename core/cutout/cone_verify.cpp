#include "core/cutout/cone_verify.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/math/quadrature.hpp"
#include "core/math/search.hpp"

namespace tubecut::cutout {
namespace {

constexpr int kStrips = 32;  // of a part of a ring, and of a part of the wall
constexpr int kConeDepths = 5;

/// Height of the touching plane in the frame of the anchor.
double touching(const Laying& laying) { return laying.lay() == Lay::flat ? 0.0 : laying.outer(); }

double cone_at(const Laying& laying, const Cone& cone, double x) {
  return 0.5 * cone.diameter - (touching(laying) - x) * cone.slope();
}

/// The integral of what may begin and end as a root.
template <class F>
double integral(double from, double to, const F& of) {
  static const auto kRule = math::gauss_legendre(kStrips);
  if (!(to > from)) return 0.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < kRule.nodes.size(); ++k) {
    const auto [sin, cos] = elementary::sincos(0.5 * kPi * (1.0 + kRule.nodes[k]));
    sum += 0.25 * kPi * kRule.weights[k] * (to - from) * sin *
           of(from + 0.5 * (to - from) * (1.0 - cos));
  }
  return sum;
}

/// The area beyond the circle on a ring of the wall.
double ring_area(const Laying& laying, const Cone& cone, double rho) {
  const double hole = 0.5 * cone.hole, met = laying.outer() - cone.depth();
  if (rho <= met) return 0.0;
  const double leaves =
      met > -rho ? elementary::acos(met / rho) : kPi;  // the cone is as its circle
  const auto strip = [&](double phi) {
    const auto [sin, cos] = elementary::sincos(phi);
    const double y = rho * sin, p = cone_at(laying, cone, rho * cos);
    return std::sqrt(std::max(0.0, p * p - y * y)) - std::sqrt(std::max(0.0, hole * hole - y * y));
  };
  if (leaves <= 0.5 * kPi && rho * elementary::sin(leaves) <= hole)
    return 4.0 * rho * integral(0.0, leaves, strip);
  const double beside = elementary::asin(hole / rho);
  const double last = math::sign_change(
      [&](double phi) {
        const auto [sin, cos] = elementary::sincos(phi);
        return cone_at(laying, cone, rho * cos) - rho * sin;
      },
      beside, 0.5 * kPi);
  return 4.0 * rho * (integral(0.0, beside, strip) + integral(beside, last, strip));
}

}  // namespace

double off_cone(const Laying& laying, const Cone& cone, const Eigen::Vector3d& place) {
  const double wanted = std::max(0.5 * cone.hole, cone_at(laying, cone, place.x()));
  return std::abs(place.tail<2>().norm() - wanted);
}

std::vector<Eigen::Vector3d> cone_places(const Laying& laying, const Cone& cone, double apart) {
  const int parts = static_cast<int>(std::ceil(kPi * cone.diameter / apart));
  const auto height = [&](double p, double sin, bool outer) {
    if (laying.lay() == Lay::flat) return outer ? 0.0 : -laying.wall();
    const double rho = outer ? laying.outer() : laying.inner(), y = p * sin;
    return std::sqrt(rho * rho - y * y);
  };
  const double hole = 0.5 * cone.hole, met = touching(laying) - cone.depth();
  std::vector<Eigen::Vector3d> out;
  for (int i = 0; i < parts; ++i) {
    const double w = kTwoPi * i / parts;
    const auto [sin, cos] = elementary::sincos(w);
    const auto top = std::max(hole, cone_radius(laying, cone, w, true));
    const double bore = cone_radius(laying, cone, w, false), low = bore > hole ? bore : hole;
    const double from = height(top, sin, true), to = height(low, sin, false);
    const auto add = [&, s = sin, c = cos](double x) {
      const double p = std::max(hole, cone_at(laying, cone, x));
      out.emplace_back(x, p * s, p * c);
    };
    for (int k = 0; k < kConeDepths; ++k) add(from + k * (to - from) / (kConeDepths - 1));
    if (met > to && met < from) add(met);
  }
  return out;
}

double cone_by_rings(const Laying& laying, const Cone& cone) {
  const double hole = 0.5 * cone.hole;
  if (laying.lay() == Lay::flat)
    return integral(-std::min(laying.wall(), cone.depth()), 0.0, [&](double x) {
      const double p = cone_at(laying, cone, x);
      return kPi * (p * p - hole * hole);
    });
  const double met = laying.outer() - cone.depth();
  std::vector<double> radii{laying.inner(), laying.outer()};
  for (const double rho : {met, elementary::hypot(met, hole)})
    if (rho > laying.inner() && rho < laying.outer()) radii.push_back(rho);
  std::ranges::sort(radii);
  double sum = 0.0;
  for (std::size_t i = 1; i < radii.size(); ++i)
    sum +=
        integral(radii[i - 1], radii[i], [&](double rho) { return ring_area(laying, cone, rho); });
  return sum;
}

}  // namespace tubecut::cutout
