#include "core/part/hole_volume.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/stop.hpp"
#include "core/bevel/hole/hole_slice.hpp"
#include "core/math/polygon.hpp"
#include "core/math/quadrature.hpp"
#include "core/part/cut_edges.hpp"
#include "core/part/place.hpp"

namespace tubecut::part {
namespace {

using math::Polygon;

constexpr int kRings = 16;
constexpr int kRowsPerRow =
    4;  // the error between rows is proportional to the square of their distance
constexpr double kTouch =
    1e-9;  // fraction of a hole's area: overlap that is only rounding, if two holes touch

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

/// Holes near each other, by the boxes around their edges: each may meet only another of its group
/// or, if `at_end`, the cut of an end.
struct Crowd {
  std::vector<const bevel::Hole*> holes;
  bool at_end = false;
};

/// Adds the same hole at each position within one revolution.
void add_turns(const joint::Target& target, const bevel::Hole& hole, double u,
               std::vector<Polygon>& to) {
  for (const double turn : {-kTwoPi, 0.0, kTwoPi}) {
    auto polygon = bevel::slice(target, hole, u, turn);
    if (stopped()) return;
    const auto [least, most] = std::ranges::minmax(polygon.x);
    if (most > 0.0 && least < kTwoPi) to.push_back(std::move(polygon));
  }
}

/// Returns the region that an end's cut has removed, out to `beyond`, over three revolutions.
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

/// Computes the area (rad mm) of the union within one revolution.
double within_turn(const std::vector<Polygon>& polygons) {
  return math::union_area(polygons, {.x_from = 0.0, .x_to = kTwoPi});
}

bool near(const Box& a, const Box& b) {
  if (a.z_from > b.z_to || b.z_from > a.z_to) return false;
  for (int turn = -2; turn <= 2; ++turn)
    if (a.phi_from + turn * kTwoPi <= b.phi_to && b.phi_from <= a.phi_to + turn * kTwoPi)
      return true;
  return false;
}

std::vector<Crowd> crowds(const Part& part, const std::vector<bevel::Hole>& holes) {
  const auto n = holes.size();
  const double from = highest(part.start.table), to = lowest(part.finish.table);
  std::vector<Box> boxes;
  for (const auto& hole : holes) boxes.push_back(box_of(hole));
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
      crowd.holes.push_back(&holes[i]);
      crowd.at_end = crowd.at_end || boxes[i].z_from <= from || boxes[i].z_to >= to;
      for (std::size_t j = 0; j < n; ++j)
        if (!seen[j] && near(boxes[i], boxes[j])) {
          seen[j] = true;
          front.push_back(j);
        }
    }
    out.push_back(std::move(crowd));
  }
  return out;
}

}  // namespace

bevel::Hole closer_rows(const bevel::Hole& hole) {
  bevel::Hole out;
  const auto n = hole.phi.size();
  const int pieces = hole.phi == hole.phi_inner ? 1 : kRowsPerRow;
  for (auto* column : {&out.phi, &out.z, &out.phi_inner, &out.z_inner})
    column->reserve(n * static_cast<std::size_t>(pieces));
  for (std::size_t i = 0; i < n && !stops(i); ++i)
    for (int piece = 0; piece < pieces; ++piece) {
      const auto next = (i + 1) % n;
      const double share = static_cast<double>(piece) / pieces;
      out.phi.push_back(mixed(hole.phi[i], hole.phi[next], share));
      out.z.push_back(mixed(hole.z[i], hole.z[next], share));
      out.phi_inner.push_back(mixed(hole.phi_inner[i], hole.phi_inner[next], share));
      out.z_inner.push_back(mixed(hole.z_inner[i], hole.z_inner[next], share));
    }
  return out;
}

std::vector<Ring> wall_rings(const joint::Target& target) {
  const auto rule = math::gauss_legendre(kRings);
  std::vector<Ring> out;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    const double v = 0.5 * (1.0 + rule.nodes[k]), u = v * v;
    const double rho = mixed(target.inner_radius(), target.outer_radius, u);
    out.push_back({u, rho, rule.weights[k] * v * target.wall * rho});
  }
  return out;
}

double area_between_cuts(const joint::Target& target, const Part& part,
                         std::vector<Polygon> polygons, const Ring& ring) {
  double low = lowest(part.start.table), high = highest(part.finish.table);
  for (const auto& polygon : polygons) {
    low = std::min(low, std::ranges::min(polygon.y));
    high = std::max(high, std::ranges::max(polygon.y));
  }
  std::vector<Polygon> ends;
  const auto end = [&](const End& e, double beyond) {
    ends.push_back(cut_off(e.table, target, e.spec.root_face, ring.u, beyond));
  };
  end(part.start, low - 1.0);
  end(part.finish, high + 1.0);
  const double cut = within_turn(ends);
  polygons.insert(polygons.end(), ends.begin(), ends.end());
  return within_turn(polygons) - cut;
}

bool holes_meet(const joint::Target& target, const bevel::Hole& a, const bevel::Hole& b) {
  if (!near(box_of(a), box_of(b))) return false;
  for (const double u : {0.0, 0.5, 1.0}) {
    std::vector<Polygon> one, other;
    add_turns(target, a, u, one);
    add_turns(target, b, u, other);
    const double own = within_turn(one), sum = own + within_turn(other);
    one.insert(one.end(), other.begin(), other.end());
    if (sum - within_turn(one) > kTouch * own) return true;
  }
  return false;
}

double holes_volume(const joint::Target& target, const Part& part) {
  double sum = 0.0;
  const auto rings = wall_rings(target);
  std::vector<bevel::Hole> holes;
  for (const auto& placed : part.holes) holes.push_back(closer_rows(placed.hole));
  if (stopped()) return 0.0;
  for (const auto& crowd : crowds(part, holes))
    for (const auto& ring : rings) {
      if (stopped()) return 0.0;
      std::vector<Polygon> polygons;
      if (crowd.holes.size() == 1 && !crowd.at_end) {
        sum += ring.weight * math::area(bevel::slice(target, *crowd.holes.front(), ring.u, 0.0));
        continue;
      }
      for (const auto* hole : crowd.holes) add_turns(target, *hole, ring.u, polygons);
      sum +=
          ring.weight * (crowd.at_end ? area_between_cuts(target, part, std::move(polygons), ring)
                                      : within_turn(polygons));
    }
  return sum;
}

}  // namespace tubecut::part
