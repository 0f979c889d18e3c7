#include "core/part/hole_volume.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/math/polygon.hpp"
#include "core/math/quadrature.hpp"

namespace tubecut::part {
namespace {

using math::Polygon;

constexpr int kSmooth = 6;     // Gauss points across the wall, 1e-12 of a hole
constexpr int kCrowded = 12;   // the border of what two holes share has corners that move
constexpr double kTouch = 1e-9;  // of a hole's area, that rounding leaves two that only touch

/// Rectangle around both edges of a cut on the developed plane.
struct Box {
  double phi_from, phi_to, z_from, z_to;
};

Box box_of(const bevel::Hole& hole) {
  const auto [pi, qi] = std::ranges::minmax(hole.phi_inner);
  const auto [po, qo] = std::ranges::minmax(hole.phi);
  const auto [zi, yi] = std::ranges::minmax(hole.z_inner);
  const auto [zo, yo] = std::ranges::minmax(hole.z);
  return {std::min(pi, po), std::max(qi, qo), std::min(zi, zo), std::max(yi, yo)};
}

double mixed(double inner, double outer, double u) { return inner + u * (outer - inner); }

/// A hole's line on the cylinder between, developed to (phi, z), the share u of the way from the
/// bore out: where the straight lines from edge to edge pass it.
Polygon slice(const joint::Target& target, const bevel::Hole& hole, double u, double turn = 0.0) {
  const double inner = target.inner_radius(), outer = target.outer_radius;
  const double rho = mixed(inner, outer, u);
  Polygon out;
  for (std::size_t i = 0; i < hole.phi.size(); ++i) {
    // Seen along the tube: from (inner, 0) by d, until rho away from the axis.
    const auto swing = elementary::sincos(hole.phi[i] - hole.phi_inner[i]);
    const Eigen::Vector2d d{outer * swing.cos - inner, outer * swing.sin};
    const double half = inner * d.x(), square = d.squaredNorm();
    const double s =
        (std::sqrt(half * half + square * (rho * rho - inner * inner)) - half) / square;
    out.x.push_back(turn + hole.phi_inner[i] + elementary::atan2(s * d.y(), inner + s * d.x()));
    out.y.push_back(mixed(hole.z_inner[i], hole.z[i], s));
  }
  return out;
}

/// The same seen from the turns before and after too.
std::vector<Polygon> turns(const joint::Target& target, const bevel::Hole& hole, double u) {
  return {slice(target, hole, u, -kTwoPi), slice(target, hole, u), slice(target, hole, u, kTwoPi)};
}

/// All that an end's cut has taken, out to `beyond`: the turn at hand and one to each side of it.
Polygon cut_off(const bevel::Table& end, const joint::Target& target, double face, double u,
                double beyond) {
  const double edge = face / target.wall;  // where the root face ends
  Polygon out;
  for (const double turn : {-kTwoPi, 0.0, kTwoPi})
    for (std::size_t i = 0; i < end.phi.size(); ++i) {
      out.x.push_back(turn + end.phi[i]);
      if (end.z_face.empty())
        out.y.push_back(mixed(end.z_inner[i], end.z_outer[i], u));
      else
        out.y.push_back(u < edge ? mixed(end.z_inner[i], end.z_face[i], u / edge)
                                 : mixed(end.z_face[i], end.z_outer[i], (u - edge) / (1.0 - edge)));
    }
  const double first = out.x.front(), last = out.x.back();
  out.x.insert(out.x.end(), {last, first});
  out.y.insert(out.y.end(), {beyond, beyond});
  return out;
}

/// Area (rad mm) of the union within one turn.
double within_turn(std::vector<Polygon> polygons, Strips strips) {
  if (strips == Strips::along)
    return math::union_area(polygons, {.x_from = 0.0, .x_to = kTwoPi});
  for (auto& polygon : polygons) std::swap(polygon.x, polygon.y);
  return math::union_area(polygons, {.y_from = 0.0, .y_to = kTwoPi});
}

/// Area of the holes between the two cuts at the share u of the wall.
double taken(const joint::Target& target, const Part& part,
             const std::vector<const bevel::Hole*>& holes, double u, Strips strips) {
  const auto& s = part.start;
  const auto& f = part.finish;
  double below = std::min(std::ranges::min(s.table.z_inner), std::ranges::min(s.table.z_outer));
  double above = std::max(std::ranges::max(f.table.z_inner), std::ranges::max(f.table.z_outer));
  for (const auto* hole : holes) {
    const auto box = box_of(*hole);
    below = std::min(below, box.z_from);
    above = std::max(above, box.z_to);
  }
  std::vector<Polygon> all{cut_off(s.table, target, s.spec.root_face, u, below - 1.0),
                           cut_off(f.table, target, f.spec.root_face, u, above + 1.0)};
  const double ends = within_turn(all, strips);
  for (const auto* hole : holes)
    for (auto& polygon : turns(target, *hole, u)) all.push_back(std::move(polygon));
  return within_turn(std::move(all), strips) - ends;
}

/// Integral over the wall of an area at the share u times its radius.
template <class Area>
double across(const joint::Target& target, int points, Area&& area) {
  const auto rule = math::gauss_legendre(points);
  double sum = 0.0;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    const double u = 0.5 * (1.0 + rule.nodes[k]);
    sum += 0.5 * rule.weights[k] * target.wall * (target.inner_radius() + u * target.wall) * area(u);
  }
  return sum;
}

bool near(const Box& a, const Box& b) {
  if (a.z_from > b.z_to || b.z_from > a.z_to) return false;
  for (int turn = -2; turn <= 2; ++turn)
    if (a.phi_from + turn * kTwoPi <= b.phi_to && b.phi_from <= a.phi_to + turn * kTwoPi)
      return true;
  return false;
}

bool near(const Box& box, const bevel::Table& end) {
  const auto [zi, yi] = std::ranges::minmax(end.z_inner);
  const auto [zo, yo] = std::ranges::minmax(end.z_outer);
  return box.z_from <= std::max(yi, yo) && std::min(zi, zo) <= box.z_to;
}

}  // namespace

bool holes_meet(const joint::Target& target, const bevel::Hole& a, const bevel::Hole& b) {
  if (!near(box_of(a), box_of(b))) return false;
  for (const double u : {0.0, 0.5, 1.0}) {
    const auto own = within_turn(turns(target, a, u), Strips::along);
    const auto other = within_turn(turns(target, b, u), Strips::along);
    auto both = turns(target, a, u);
    for (auto& polygon : turns(target, b, u)) both.push_back(std::move(polygon));
    if (own + other - within_turn(std::move(both), Strips::along) > kTouch * own) return true;
  }
  return false;
}

std::vector<const bevel::Hole*> crowded_holes(const Part& part) {
  std::vector<const bevel::Hole*> out;
  for (const auto& [hole, asked] : part.holes) {
    const auto box = box_of(hole);
    const auto beside = [&](const PlacedHole& other) {
      return &other.hole != &hole && near(box, box_of(other.hole));
    };
    if (near(box, part.start.table) || near(box, part.finish.table) ||
        std::ranges::any_of(part.holes, beside))
      out.push_back(&hole);
  }
  return out;
}

double crowded_volume(const joint::Target& target, const Part& part,
                      const std::vector<const bevel::Hole*>& holes, Strips strips) {
  if (holes.empty()) return 0.0;
  return across(target, kCrowded, [&](double u) { return taken(target, part, holes, u, strips); });
}

double holes_volume(const joint::Target& target, const Part& part) {
  const auto crowded = crowded_holes(part);
  double sum = crowded_volume(target, part, crowded, Strips::along);
  for (const auto& [hole, asked] : part.holes)
    if (std::ranges::find(crowded, &hole) == crowded.end())
      sum += across(target, kSmooth, [&](double u) { return math::area(slice(target, hole, u)); });
  return sum;
}

}  // namespace tubecut::part
