#include "core/part/hole_volume.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/math/polygon.hpp"
#include "core/math/quadrature.hpp"

namespace tubecut::part {
namespace {

using math::Polygon;

constexpr int kSmooth = 6;       // Gauss points across the wall, 1e-12 of a hole
constexpr int kCrowded = 12;     // the border of what two holes share has corners that move
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

double lowest(const bevel::Table& t) {
  return std::min(std::ranges::min(t.z_inner), std::ranges::min(t.z_outer));
}
double highest(const bevel::Table& t) {
  return std::max(std::ranges::max(t.z_inner), std::ranges::max(t.z_outer));
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

/// The same wherever it shows within one turn.
void add_turns(const joint::Target& target, const bevel::Hole& hole, double u,
               std::vector<Polygon>& to) {
  for (const double turn : {-kTwoPi, 0.0, kTwoPi}) {
    auto polygon = slice(target, hole, u, turn);
    const auto [least, most] = std::ranges::minmax(polygon.x);
    if (most > 0.0 && least < kTwoPi) to.push_back(std::move(polygon));
  }
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
double within_turn(std::vector<Polygon> polygons, Strips strips, const std::stop_token& stop) {
  if (strips == Strips::along)
    return math::union_area(polygons, {.x_from = 0.0, .x_to = kTwoPi}, stop);
  for (auto& polygon : polygons) std::swap(polygon.x, polygon.y);
  return math::union_area(polygons, {.y_from = 0.0, .y_to = kTwoPi}, stop);
}

/// Area of a crowd between the two cuts at the share u of the wall.
double taken(const joint::Target& target, const Part& part, const Crowd& crowd, double u,
             Strips strips, const std::stop_token& stop) {
  std::vector<Polygon> all;
  double low = 0.0, high = 0.0;
  for (const auto* hole : crowd.holes) {
    const auto box = box_of(*hole);
    low = std::min(low, box.z_from);
    high = std::max(high, box.z_to);
  }
  const auto end = [&](const End& e, bool here, double beyond) {
    if (here) all.push_back(cut_off(e.table, target, e.spec.root_face, u, beyond));
  };
  end(part.start, crowd.start, std::min(low, lowest(part.start.table)) - 1.0);
  end(part.finish, crowd.finish, std::max(high, highest(part.finish.table)) + 1.0);
  const double ends = within_turn(all, strips, stop);
  for (const auto* hole : crowd.holes) add_turns(target, *hole, u, all);
  return within_turn(std::move(all), strips, stop) - ends;
}

/// Integral over the wall of an area at the share u times its radius.
template <class Area>
double across(const joint::Target& target, int points, Area&& area) {
  const auto rule = math::gauss_legendre(points);
  double sum = 0.0;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    const double u = 0.5 * (1.0 + rule.nodes[k]);
    sum +=
        0.5 * rule.weights[k] * target.wall * (target.inner_radius() + u * target.wall) * area(u);
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
  return box.z_from <= highest(end) && lowest(end) <= box.z_to;
}

}  // namespace

bool holes_meet(const joint::Target& target, const bevel::Hole& a, const bevel::Hole& b,
                const std::stop_token& stop) {
  if (!near(box_of(a), box_of(b))) return false;
  for (const double u : {0.0, 0.5, 1.0}) {
    std::vector<Polygon> one, other;
    add_turns(target, a, u, one);
    add_turns(target, b, u, other);
    auto both = one;
    both.insert(both.end(), other.begin(), other.end());
    const double own = within_turn(std::move(one), Strips::along, stop);
    const double sum = own + within_turn(std::move(other), Strips::along, stop);
    if (sum - within_turn(std::move(both), Strips::along, stop) > kTouch * own) return true;
  }
  return false;
}

std::vector<Crowd> crowds(const Part& part) {
  const auto n = part.holes.size();
  std::vector<Box> boxes;
  for (const auto& placed : part.holes) boxes.push_back(box_of(placed.hole));
  std::vector<bool> seen(n, false);
  std::vector<Crowd> out;
  for (std::size_t first = 0; first < n; ++first) {
    if (seen[first]) continue;
    Crowd crowd;
    std::vector<std::size_t> front{first};
    seen[first] = true;
    while (!front.empty()) {
      const auto i = front.back();
      front.pop_back();
      crowd.holes.push_back(&part.holes[i].hole);
      crowd.start = crowd.start || near(boxes[i], part.start.table);
      crowd.finish = crowd.finish || near(boxes[i], part.finish.table);
      for (std::size_t j = 0; j < n; ++j)
        if (!seen[j] && near(boxes[i], boxes[j])) {
          seen[j] = true;
          front.push_back(j);
        }
    }
    if (crowd.holes.size() > 1 || crowd.start || crowd.finish) out.push_back(std::move(crowd));
  }
  return out;
}

double crowd_volume(const joint::Target& target, const Part& part, const Crowd& crowd,
                    Strips strips, const std::stop_token& stop) {
  return across(target, kCrowded,
                [&](double u) { return taken(target, part, crowd, u, strips, stop); });
}

double holes_volume(const joint::Target& target, const Part& part, const std::stop_token& stop) {
  double sum = 0.0;
  std::set<const bevel::Hole*> crowded;
  for (const auto& crowd : crowds(part)) {
    sum += crowd_volume(target, part, crowd, Strips::along, stop);
    crowded.insert(crowd.holes.begin(), crowd.holes.end());
  }
  for (const auto& placed : part.holes) {
    const auto& hole = placed.hole;
    if (!crowded.contains(&hole))
      sum += across(target, kSmooth, [&](double u) { return math::area(slice(target, hole, u)); });
  }
  return sum;
}

}  // namespace tubecut::part
