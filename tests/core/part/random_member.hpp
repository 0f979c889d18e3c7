#pragma once

#include <Eigen/Geometry>
#include <random>

#include "core/part/member.hpp"

namespace tubecut::testing {

using Eigen::Vector3d;

struct Random {
  std::mt19937_64 engine;
  double between(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(engine);
  }
  int upto(int last) { return std::uniform_int_distribution<int>(0, last)(engine); }
  Vector3d direction() {
    std::normal_distribution<double> normal;
    return Vector3d(normal(engine), normal(engine), normal(engine)).normalized();
  }
};

/// A direction at `angle` rad to `axis`.
inline Vector3d leaning(Random& random, const Vector3d& axis, double angle) {
  Vector3d side = random.direction().cross(axis).normalized();
  return std::cos(angle) * axis + std::sin(angle) * side;
}

/// A member between two nodes, each a chord that every generator meets and up to two smaller tubes
/// that cut it too.
inline part::MemberSpec random_member(Random& random) {
  part::MemberSpec out;
  auto& members = out.node.members;
  joint::Member own{.name = "B"};
  own.outer_radius = random.between(20, 80);
  own.wall = random.between(3, 0.25 * own.outer_radius + 2);
  own.start = 2000 * random.direction();
  const Vector3d axis = random.direction();
  own.finish = own.start + random.between(900, 2500) * axis;
  own.priority = 9;
  own.up = leaning(random, axis, random.between(0.5, 2.5));
  members.push_back(own);
  std::vector<joint::Link> links;
  for (const auto end : {joint::End::start, joint::End::finish}) {
    joint::Link link{.member = 0, .end = end, .to = {}};
    const int others = random.upto(2);
    for (int k = 0; k <= others; ++k) {
      const double deg = k == 0 ? random.between(50, 130) : random.between(40, 140);
      const Vector3d d = leaning(random, axis, deg * kRadPerDeg);
      joint::Member m{.name = std::to_string(members.size())};
      m.outer_radius =
          own.outer_radius * (k == 0 ? random.between(1.3, 2.5) : random.between(0.6, 1.2));
      m.wall = 4;
      const double room =
          k == 0 ? 0.9 * (m.outer_radius - own.outer_radius) : 0.3 * own.outer_radius;
      const Vector3d at = own.at(end) + random.between(-room, room) * axis.cross(d).normalized();
      m.start = at - 3000 * d;
      m.finish = at + 3000 * d;
      m.priority = k;
      link.to.push_back(members.size());
      members.push_back(m);
    }
    links.push_back(link);
  }
  out.node.connect = links;
  out.datum = part::Datum::up;
  out.cut.groove = bevel::HalfDihedral{};
  out.cut.torch = {Angle::deg(-88), Angle::deg(88)};
  out.cut.smoothing = bevel::EnvelopeSmoothing{
      .limits = {.slope = 5 * kRadPerDeg, .curvature = 1 * kRadPerDeg}, .refine = false};
  return out;
}

}  // namespace tubecut::testing
