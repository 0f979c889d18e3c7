#include "core/cutout/cone.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/base/rounding.hpp"
#include "core/math/quadrature.hpp"

namespace tubecut::cutout {
namespace {

constexpr int kConePlaces = 40;     // of a smooth part of a quarter turn
constexpr int kLeastConeRows = 24;  // of a turn; a multiple of four, as all numbers of them

double square(double x) { return x * x; }
double side_of(const Laying& laying, bool outer) { return outer ? laying.outer() : laying.inner(); }

/// Distance of the apex from the tube's axis, times the slope, the other way.
double offset_of(const Laying& laying, const Cone& cone) {
  return laying.outer() * cone.slope() - 0.5 * cone.diameter;
}

/// Below 0 counts as not there; the side that misses a surface does not reach it.
double reach(const Laying& laying, const Cone& cone, double w, bool outer) {
  const double least = 0.5 * cone.hole, met = cone_radius(laying, cone, w, outer);
  return met > least ? met : least;
}

/// Phase from +z at which the edge of the circle's plane with the cone lies on a surface, of a
/// quarter turn.
void add_kink(const Laying& laying, const Cone& cone, bool outer, std::vector<double>& out) {
  const double x = laying.outer() - cone.depth(), rho = side_of(laying, outer);
  if (std::abs(x) >= rho) return;
  const double sin = std::sqrt(rho * rho - x * x) / (0.5 * cone.hole);
  if (sin < 1.0) out.push_back(elementary::asin(sin));
}

double over_turn(const Laying& laying, const Cone& cone, const std::function<double(double)>& of) {
  static const auto kRule = math::gauss_legendre(kConePlaces);
  std::vector<double> ends{0.0, 0.5 * kPi};
  for (const bool outer : {true, false}) add_kink(laying, cone, outer, ends);
  std::ranges::sort(ends);
  double sum = 0.0;
  for (std::size_t i = 1; i < ends.size(); ++i)
    for (std::size_t k = 0; k < kRule.nodes.size(); ++k) {
      const double way = 0.5 * (ends[i] - ends[i - 1]);
      sum += way * kRule.weights[k] * of(ends[i - 1] + way * (1.0 + kRule.nodes[k]));
    }
  return 4.0 * sum;
}

/// Of a ring between two radii from the anchor's normal at one phase: its area on the radius rho,
/// and the volume below it down to the tube's middle plane, a rad.
struct Ring {
  double rho, sin, from, to;
  [[nodiscard]] double height(double p) const { return std::sqrt(rho * rho - square(p * sin)); }
  [[nodiscard]] double squares() const { return to * to - from * from; }
  [[nodiscard]] double area() const { return rho * squares() / (height(from) + height(to)); }
  [[nodiscard]] double below() const {
    const double a = height(from), b = height(to);
    return squares() * (a * a + a * b + b * b) / (3.0 * (a + b));
  }
};

Taken flat_taken(const Laying& laying, const Cone& cone) {
  const double hole = 0.5 * cone.hole, outer = 0.5 * cone.diameter;
  const double depth = std::min(laying.wall(), cone.depth());
  const double inner = reach(laying, cone, 0.0, false);
  const double low = std::max(inner, hole);
  return {.outer_area = kPi * (outer * outer - hole * hole),
          .inner_area = kPi * (inner * inner - hole * hole),
          .volume = kPi * depth * ((outer * outer + outer * low + low * low) / 3.0 - hole * hole)};
}

}  // namespace

double Cone::slope() const { return elementary::tan(half); }

double cone_radius(const Laying& laying, const Cone& cone, double w, bool outer) {
  const double slope = cone.slope();
  if (laying.lay() == Lay::flat) return 0.5 * cone.diameter - (outer ? 0.0 : laying.wall() * slope);
  const double m = offset_of(laying, cone), rho = side_of(laying, outer);
  const double sin = elementary::sin(w), g = 1.0 + square(slope * sin);
  return (slope * std::sqrt(rho * rho * g - square(m * sin)) - m) / g;
}

Cone torch_cone(const Cone& cone, double kerf) {
  auto out = cone;
  out.diameter -= kerf / elementary::cos(cone.half);
  return out;
}

bevel::Hole cone_rows(const Laying& laying, const Cone& cone, const Cutting& cutting) {
  const auto torch = torch_cone(cone, cutting.kerf);
  const double radius = 0.5 * cone.diameter;
  const double step =
      2.0 * elementary::acos(1.0 - std::min(0.5, std::min(cutting.tolerance, radius) / radius));
  const int quarter =
      std::max(kLeastConeRows / 4, static_cast<int>(std::ceil(0.5 * kPi / step - 1e-9)));
  const auto [sin_half, cos_half] = elementary::sincos(cone.half);
  bevel::Hole out{.far = laying.far()};
  for (int i = 0; i < 4 * quarter; ++i) {
    const double w = 0.5 * kPi * i / quarter;
    const auto [sin, cos] = elementary::sincos(w);
    const auto place = [&, s = sin, c = cos](double p, bool outer, std::vector<double>& phi,
                                             std::vector<double>& z) {
      phi.push_back(laying.phase(laying.turn(p * s, side_of(laying, outer))));
      z.push_back(p * c);
    };
    place(reach(laying, cone, w, true), true, out.phi, out.z);
    place(reach(laying, cone, w, false), false, out.phi_inner, out.z_inner);
    place(cone_radius(laying, torch, w, true), true, out.torch_phi, out.torch_z);
    place(cone_radius(laying, torch, w, false), false, out.torch_phi_inner, out.torch_z_inner);
    const double off = laying.lay() == Lay::flat ? 0.0 : out.torch_phi.back();
    const auto turn = elementary::sincos(off);
    const double normal = cos_half * turn.cos + sin_half * sin * turn.sin;
    out.b.push_back(elementary::atan2(sin_half * cos, normal));
    out.a.push_back(elementary::atan2(sin_half * sin * turn.cos - cos_half * turn.sin, normal));
  }
  measure_edge(laying.outer(), out);
  return out;
}

Taken cone_taken(const Laying& laying, const Cone& cone) {
  if (laying.lay() == Lay::flat) return flat_taken(laying, cone);
  const double hole = 0.5 * cone.hole, m = offset_of(laying, cone), slope = cone.slope();
  const auto ring = [&](double w, bool outer) {
    return Ring{side_of(laying, outer), elementary::sin(w), hole, reach(laying, cone, w, outer)};
  };
  Taken out;
  out.outer_area = over_turn(laying, cone, [&](double w) { return ring(w, true).area(); });
  out.inner_area = over_turn(laying, cone, [&](double w) { return ring(w, false).area(); });
  out.volume = over_turn(laying, cone, [&](double w) {
    const auto upper = ring(w, true);
    auto lower = ring(w, false);
    lower.to = std::min(lower.to, upper.to);
    const double from = lower.to, to = upper.to;
    const double cone_below =
        (0.5 * m * (to * to - from * from) + (to * to * to - from * from * from) / 3.0) / slope;
    return upper.below() - lower.below() - cone_below;
  });
  return out;
}

double cone_removed(const Laying& laying, const Cone& cone, double at) {
  static const auto kRule = math::gauss_legendre(kConePlaces);
  const bool flat = laying.lay() == Lay::flat;
  const double slope = cone.slope(), m = flat ? -0.5 * cone.diameter : offset_of(laying, cone);
  // Heights along the normal: of a flat from its outside on.
  const auto surface = [&](double y, bool outer) {
    if (flat) return outer ? 0.0 : -laying.wall();
    return std::sqrt(std::max(0.0, square(side_of(laying, outer)) - y * y));
  };
  // How far across the cone reaches on a surface.
  const auto meets = [&](bool outer) {
    double p = 0.0;
    if (flat) {
      p = slope * surface(0.0, outer) - m;
    } else {
      const double g = 1.0 + slope * slope;
      const double root =
          square(slope) * (square(side_of(laying, outer)) + at * at) * g - square(slope * m);
      if (root < 0.0) return 0.0;
      p = (std::sqrt(root) - m) / g;
    }
    return p > std::abs(at) ? std::sqrt(p * p - at * at) : 0.0;
  };
  const double first = std::sqrt(std::max(0.0, square(0.5 * cone.hole) - at * at));
  const double last = std::max(first, meets(true));
  const double middle = std::clamp(meets(false), first, last);
  double sum = 0.0;
  const auto add = [&](double from, double to, bool whole) {
    const double way = 0.5 * (to - from);
    for (std::size_t k = 0; way > 0.0 && k < kRule.nodes.size(); ++k) {
      const double y = from + way * (1.0 + kRule.nodes[k]);
      const double low = whole ? surface(y, false) : (m + elementary::hypot(y, at)) / slope;
      sum += way * kRule.weights[k] * (surface(y, true) - low);
    }
  };
  add(first, middle, true);
  add(middle, last, false);
  return 2.0 * sum;
}

bool is_spent_on_wall(const Laying& laying, const Cone& cone, double kerf) {
  const double hole = 0.5 * cone.hole;
  const double deepest = laying.lay() == Lay::flat
                             ? laying.wall()
                             : laying.outer() - std::sqrt(square(laying.inner()) - square(hole));
  // The side of the beam that is turned from the cone gets there first.
  const double least = 0.5 * cone.diameter - kerf / elementary::cos(cone.half) + hole;
  return least < deepest * cone.slope();
}

bool is_open(const Laying& laying, const Cone& cone) {
  return cone_radius(laying, cone, 0.5 * kPi, true) <= 0.5 * cone.hole;
}

ConeWall cone_wall(const Laying& laying, const Cone& cone) {
  if (is_open(laying, cone)) return ConeWall::mixed;
  const double hole = 0.5 * cone.hole;
  if (cone_radius(laying, cone, 0.5 * kPi, false) >= hole) return ConeWall::whole;
  return cone_radius(laying, cone, 0.0, false) <= hole ? ConeWall::landed : ConeWall::mixed;
}

std::vector<Issue> check_cone(const Laying& laying, const Cone& cone, double kerf,
                              double most_lean) {
  const double beam = kerf / elementary::cos(cone.half);
  constexpr double kWider = 1e-3;  // mm
  if (laying.lay() != Lay::flat && cone.diameter > 2.0 * laying.outer())
    return {{.code = ErrorCode::out_of_range,
             .member = "countersink/diameter",
             .got = cone.diameter,
             .limit = rounded_down(2.0 * laying.outer()),
             .unit = "mm",
             .hint = "a countersink is at most as wide as the tube"}};
  if (!(cone.diameter > cone.hole))
    return {{.code = ErrorCode::out_of_range,
             .member = "countersink/diameter",
             .got = cone.diameter,
             .limit = rounded_up(cone.hole + kWider),
             .unit = "mm",
             .hint = "a countersink is wider than its circle"}};
  if (!(cone.diameter > beam))
    return {{.code = ErrorCode::out_of_range,
             .member = "countersink/diameter",
             .got = cone.diameter,
             .limit = rounded_up(beam + kWider),
             .unit = "mm",
             .hint = "the leaning beam alone is as wide"}};
  if (cone.half > most_lean)
    return {{.code = ErrorCode::torch_range,
             .member = "countersink/angle",
             .got = 2.0 * cone.half * kDegPerRad,
             .limit = 2.0 * most_lean * kDegPerRad,
             .unit = "deg",
             .hint = "the torch would lean by half of it"}};
  if (std::isfinite(cone_radius(laying, torch_cone(cone, kerf), 0.5 * kPi, false))) return {};
  return {
      {.code = ErrorCode::open_profile,
       .member = "countersink/angle",
       .got = 2.0 * cone.half * kDegPerRad,
       .unit = "deg",
       .hint = "at the tube's sides the torch's line would miss the bore; use a narrower angle"}};
}

}  // namespace tubecut::cutout
