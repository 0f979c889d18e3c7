#pragma once

#include <random>
#include <vector>

#include "core/joint/cutters/cutter.hpp"
#include "tests/support/ray_caster.hpp"

namespace tubecut::joint {

struct RandomNode {
  double rho = 0.0;
  std::vector<Cutter> cutters;
  std::vector<ray::Body> bodies;
};

inline ray::Body body_of(const TubeCutter& t) {
  const auto rad = [](Angle a) { return static_cast<ray::Real>(a.rad()); };
  return ray::tube(t.radius, rad(t.inclination), rad(t.clocking), t.offset, t.height);
}

inline ray::Body body_of(const PlaneCutter& p) {
  ray::Body body{
      0, {p.point.x(), p.point.y(), p.point.z()}, {p.normal.x(), p.normal.y(), p.normal.z()}};
  if (body.direction[2] < 0)
    for (auto& d : body.direction) d = -d;
  return body;
}

inline ray::Body body_of(const Cutter& cutter) {
  return std::visit([](const auto& one) { return body_of(one); }, cutter);
}

/// 2 to 5 tubes around a target of radius 30 to 60. `closed`: the first is wide enough to be met
/// everywhere. `symmetric`: mirrored pairs, equal radii, right angles. `planes`: one of them may
/// be a plane.
inline RandomNode random_node(std::mt19937_64& random, bool closed, bool symmetric, bool planes) {
  const auto any = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  RandomNode node;
  node.rho = any(30, 60);
  const auto count = std::uniform_int_distribution<std::size_t>(2, 5)(random);
  while (node.cutters.size() < count) {
    const bool first = node.cutters.empty();
    TubeCutter tube{.radius = any(0.4, 1.6) * node.rho,
                    .inclination = Angle::deg(any(25, 155)),
                    .clocking = Angle::deg(any(0, 360)),
                    .offset = any(-1.2, 1.2) * node.rho,
                    .height = any(-0.5, 0.5) * node.rho};
    if (symmetric) {
      tube.inclination = Angle::deg(first ? 90 : 15.0 * std::floor(any(2, 10)));
      tube.clocking = Angle::deg(45.0 * std::floor(any(0, 8)));
      tube.offset = std::floor(any(0, 3)) * 0.25 * node.rho;
      tube.height = 0.0;
      tube.radius = (0.5 + 0.25 * std::floor(any(0, 3))) * node.rho;
    }
    if (first && closed) {
      tube.offset *= 0.5;
      tube.radius = std::abs(tube.offset) + node.rho * any(1.001, 1.8);
      if (symmetric) tube.radius = std::abs(tube.offset) + 1.25 * node.rho;
    }
    node.cutters.emplace_back(tube);
    if (symmetric && !first && node.cutters.size() < count) {
      tube.clocking = Angle::deg(180) - tube.clocking;
      tube.offset = -tube.offset;
      node.cutters.emplace_back(tube);
    }
  }
  if (planes && any(0, 1) < 0.4)
    node.cutters.back() =
        PlaneCutter{{0, 0, any(0.2, 1.5) * node.rho},
                    {any(-0.6, 0.6), any(-0.6, 0.6), any(0, 1) < 0.5 ? 1.0 : -1.0}};
  for (const auto& cutter : node.cutters) node.bodies.push_back(body_of(cutter));
  return node;
}

}  // namespace tubecut::joint
