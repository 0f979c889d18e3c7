#include "tests/support/cut_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

namespace tubecut::oracle {
namespace {

Point plus(const Point& a, const Point& b, double k) {
  return {a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]};
}
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Point unit(const Point& a) {
  const double size = std::sqrt(dot(a, a));
  return {a[0] / size, a[1] / size, a[2] / size};
}
Point from(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// Axes of a partner's own frame, the last one along it; a point's coordinates there.
struct Frame {
  Point origin, first, second, third;

  Frame(const Point& at, const Point& along, const Point& side) : origin(at), third(unit(along)) {
    first = unit(plus(side, third, -dot(side, third)));
    second = cross(third, first);
  }
  [[nodiscard]] Point seen(const Point& p) const {
    const Point v = plus(p, origin, -1.0);
    return {dot(v, first), dot(v, second), dot(v, third)};
  }
};

/// Any direction that is not nearly along `d`.
Point beside(const Point& d) {
  const Point u = unit(d);
  return std::abs(u[0]) < 0.6 ? Point{1, 0, 0} : Point{0, 1, 0};
}

Point turned(const Point& p, std::size_t i, std::size_t j, double angle) {
  Point out = p;
  out[i] = std::cos(angle) * p[i] - std::sin(angle) * p[j];
  out[j] = std::sin(angle) * p[i] + std::cos(angle) * p[j];
  return out;
}

Solid round_tube(const Point& at, const Point& along, double radius) {
  const Frame frame(at, along, beside(along));
  return [=](const Point& p) {
    const Point q = frame.seen(p);
    return std::hypot(q[0], q[1]) - radius;
  };
}

/// A tube that lies along z is shifted by -offset in x, tilted about x, turned about z and lifted.
Solid solid(const joint::TubeCutter& t) {
  const auto place = [&](Point p) {
    p[0] -= t.offset;
    p = turned(turned(p, 1, 2, t.inclination.rad()), 0, 1, t.clocking.rad());
    p[2] += t.height;
    return p;
  };
  const Point foot = place({0, 0, 0});
  return round_tube(foot, plus(place({0, 0, 1}), foot, -1.0), t.radius);
}
Solid solid(const joint::AxisTube& t) {
  return round_tube(from(t.axis.point), from(t.axis.direction), t.radius);
}
Solid solid(const joint::PlaneCutter& plane) {
  Point n = unit(from(plane.normal));
  if (n[2] < 0) n = {-n[0], -n[1], -n[2]};
  return [n, at = from(plane.point)](const Point& p) { return dot(plus(p, at, -1.0), n); };
}
Solid solid(const joint::RectangularTubeCutter& box) {
  const Frame frame(from(box.point), from(box.direction), from(box.up));
  const double a = 0.5 * box.height - box.corner, b = 0.5 * box.width - box.corner;
  return [=, c = box.corner](const Point& p) {
    const Point q = frame.seen(p);
    const double x = std::abs(q[0]) - a, y = std::abs(q[1]) - b;
    return std::hypot(std::max(x, 0.0), std::max(y, 0.0)) + std::min(std::max(x, y), 0.0) - c;
  };
}
/// In the half plane through the axis the surface is a ray from the apex.
Solid solid(const joint::ConeCutter& cone) {
  const Frame frame(from(cone.point), from(cone.direction), beside(from(cone.direction)));
  const double k = std::tan(cone.half_angle.rad());
  return [=, r = cone.radius](const Point& p) {
    const Point q = frame.seen(p);
    return (std::hypot(q[0], q[1]) - (r + k * q[2])) / std::sqrt(1.0 + k * k);
  };
}
/// Arc and legs each where they are: a torus between the end planes, tubes beyond them.
Solid solid(const joint::ElbowCutter& elbow) {
  const Point along = unit(from(elbow.direction));
  const Point in = unit(plus(from(elbow.inwards), along, -dot(from(elbow.inwards), along)));
  const Point up = cross(along, in);
  const Point centre = plus(from(elbow.point), in, elbow.bend_radius);
  const double bend = elbow.bend.rad();
  return [=, big = elbow.bend_radius, small = elbow.radius](const Point& p) {
    const Point v = plus(p, centre, -1.0);
    const double x = -dot(v, in), y = dot(v, along), h = dot(v, up);
    const double angle = std::atan2(y, x);
    double out = std::numeric_limits<double>::infinity();
    if (angle >= 0.0 && angle <= bend)
      out = std::min(out, std::hypot(std::hypot(x, y) - big, h) - small);
    if (y <= 0.0) out = std::min(out, std::hypot(x - big, h) - small);
    const double ex = std::cos(bend) * x + std::sin(bend) * y;
    const double ey = std::cos(bend) * y - std::sin(bend) * x;
    if (ey >= 0.0) out = std::min(out, std::hypot(ex - big, h) - small);
    return out;
  };
}

struct OverlapPoint {
  std::size_t gap = 0, solid = 0;
  double along = 0.0, across = 0.0, depth = -std::numeric_limits<double>::infinity();
};

/// Steps in both directions, halved if no step improves the result.
void refine(const Wall& wall, std::span<const Solid> solids, OverlapPoint& best) {
  const double widest = static_cast<double>(wall.edges.size() - 1);
  const double size = std::max(1.0, wall.way(best.gap));
  for (double step = 0.15; step * size > 1e-7; step *= 0.5)
    for (bool better = true; better;) {
      better = false;
      for (const auto& [du, dv] :
           {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}) {
        const double u = std::clamp(best.along + du * step, 0.0, 1.0);
        const double v = std::clamp(best.across + dv * step, 0.0, widest);
        const double depth = -solids[best.solid](wall.at(best.gap, u, v));
        if (!(depth > best.depth + 1e-12)) continue;
        best.along = u;
        best.across = v;
        best.depth = depth;
        better = true;
      }
    }
}

/// The places across a wall: every edge, and jittered ones between.
std::vector<double> places_across(const Wall& wall, std::size_t count, std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(0.0, 1.0);
  std::vector<double> out;
  for (std::size_t edge = 0; edge < wall.edges.size(); ++edge) {
    out.push_back(static_cast<double>(edge));
    if (edge + 1 == wall.edges.size()) break;
    for (std::size_t k = 0; k < count; ++k)
      out.push_back(static_cast<double>(edge) +
                    (static_cast<double>(k) + any(random)) / static_cast<double>(count));
  }
  return out;
}

}  // namespace

Solid solid_of(const joint::Partner& partner, double grown) {
  auto outside = std::visit([](const auto& one) { return solid(one); }, partner);
  if (grown == 0.0) return outside;
  return [outside = std::move(outside), grown](const Point& p) { return outside(p) - grown; };
}

std::vector<Solid> solids_of(const bevel::TableSpec& spec) {
  std::vector<Solid> out;
  for (const auto& partner : spec.partners)
    out.push_back(solid_of(partner, spec.coating + spec.root_gap));
  return out;
}

Point Wall::at(std::size_t gap, double along, double across) const {
  const auto next = (gap + 1) % gaps();
  const auto on = [&](const Edge& e) -> Point {
    const double to = e.phi[next] + (next == 0 ? turn : 0.0);
    const double phi = e.phi[gap] + along * (to - e.phi[gap]);
    const double z = e.z[gap] + along * (e.z[next] - e.z[gap]);
    return {e.radius * std::cos(phi), e.radius * std::sin(phi), z};
  };
  const auto first = std::min(static_cast<std::size_t>(across), edges.size() - 2);
  const double share = across - static_cast<double>(first);
  const Point a = on(edges[first]), b = on(edges[first + 1]);
  return plus(a, plus(b, a, -1.0), share);
}

double Wall::way(std::size_t gap) const {
  const auto next = (gap + 1) % gaps();
  double out = 0.0;
  for (const auto& e : edges) {
    const double to = e.phi[next] + (next == 0 ? turn : 0.0);
    out = std::max(out, std::hypot(e.radius * (to - e.phi[gap]), e.z[next] - e.z[gap]));
  }
  return out;
}

Wall finished(const bevel::TableSpec& spec, const bevel::Table& t) {
  const double inner = spec.target.outer_radius - spec.target.wall;
  Wall out{.edges = {{inner, t.phi, t.z_inner}}, .turn = 8.0 * std::atan(1.0)};
  if (!t.z_face.empty()) out.edges.push_back({inner + spec.root_face, t.phi, t.z_face});
  out.edges.push_back({spec.target.outer_radius, t.phi, t.z_outer});
  return out;
}

Found deepest(const Wall& wall, std::span<const Solid> solids, const Search& search) {
  std::mt19937_64 random(search.seed);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  std::vector<OverlapPoint> best;
  for (std::size_t gap = 0; gap < wall.gaps(); ++gap) {
    const auto steps =
        static_cast<std::size_t>(std::clamp(std::ceil(wall.way(gap) / search.step), 3.0, 24.0));
    std::vector<OverlapPoint> here(solids.size());
    for (std::size_t k = 0; k < (search.rows_only ? 1 : steps); ++k) {
      const double along =
          k == 0 ? 0.0 : (static_cast<double>(k) - 0.5 + any(random)) / static_cast<double>(steps);
      for (const double across : places_across(wall, search.across, random)) {
        const Point p = wall.at(gap, std::min(along, 1.0), across);
        for (std::size_t s = 0; s < solids.size(); ++s) {
          const double depth = -solids[s](p);
          if (depth > here[s].depth) here[s] = {gap, s, std::min(along, 1.0), across, depth};
        }
      }
    }
    best.insert(best.end(), here.begin(), here.end());
  }
  std::ranges::sort(best, std::ranges::greater(), &OverlapPoint::depth);
  best.resize(std::min(best.size(), search.refined));
  if (!search.rows_only)
    for (auto& point : best) refine(wall, solids, point);
  const auto& top = *std::ranges::max_element(best, {}, &OverlapPoint::depth);
  const Point p = wall.at(top.gap, top.along, top.across);
  const auto next = (top.gap + 1) % wall.gaps();
  const auto& phi = wall.edges.front().phi;
  const double to = phi[next] + (next == 0 ? wall.turn : 0.0);
  return {.depth = top.depth,
          .gap = top.gap,
          .solid = top.solid,
          .phi = phi[top.gap] + top.along * (to - phi[top.gap]),
          .radius = std::hypot(p[0], p[1]),
          .z = p[2]};
}

}  // namespace tubecut::oracle
