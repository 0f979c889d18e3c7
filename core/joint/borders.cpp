#include "core/joint/borders.hpp"

#include <algorithm>
#include <cmath>

#include "core/joint/node/sheets.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::joint {
namespace {

using Eigen::Vector3d;

constexpr double kUpright = 1e-9;  // a steeper face has no height of its own

template <std::size_t Degree>
void add(const Trig<Degree>& zero, std::vector<double>& out) {
  for (const auto& root : root_phases(zero)) out.push_back(math::whole_turn(root.phi));
}

template <class Kind>
void find(const Kind& /*cutter*/, double /*rho*/, std::vector<double>& /*out*/) {}

// Finds the phases where a generator leaves a face at its edges: the other coordinate is that of a
// corner's centre.
void find(const PreparedRectangularTube& box, double rho, std::vector<double>& out) {
  const auto& w = box.frame.rise;
  const Eigen::Vector2d half(box.half_width, box.half_height);
  for (const Eigen::Index face : {0, 1}) {
    if (std::abs(w[face]) < kUpright) continue;
    const Eigen::Index other = 1 - face;
    const double share = w[other] / w[face];
    const double height = (w[face] > 0.0 ? half[face] : -half[face]) * share;
    const auto beside = box.frame.component(Vector3d::Unit(other), rho) -
                        share * box.frame.component(Vector3d::Unit(face), rho);
    for (const double side : {1.0, -1.0})
      add(beside + constant(height - side * (half[other] - box.corner)), out);
  }
}

/// The circle in which a leg of an elbow meets its bend, in the elbow's own frame.
struct Rim {
  Vector3d along, outwards;  // unit: of the leg's axis, and from the bend's centre
};

// Finds the phases on the rim: a generator crosses the plane of the circle at one point, which is
// on the rim if its distance from the centre is the leg's radius.
void find(const PreparedElbow& elbow, double rho, std::vector<double>& out) {
  const auto component = [&](const Vector3d& unit) {
    const Vector3d global = elbow.rows.transpose() * unit;
    return Trig<1>::first_order(-global.dot(elbow.center), rho * global.x(), rho * global.y());
  };
  const Vector3d end(elbow.end.x(), elbow.end.y(), 0.0), leaving(-end.y(), end.x(), 0.0);
  for (const auto& rim : {Rim{Vector3d::UnitY(), Vector3d::UnitX()}, Rim{leaving, end}}) {
    const double steep = rim.along.dot(elbow.rise);
    const auto off = component(rim.along);
    if (std::abs(steep) < kUpright) {
      add(off, out);
      continue;
    }
    const auto at = [&](const Vector3d& unit) {
      return component(unit) - (unit.dot(elbow.rise) / steep) * off;
    };
    const auto x = at(rim.outwards) - constant(elbow.bend_radius), z = at(Vector3d::UnitZ());
    const auto r = constant(elbow.radius);
    add(x * x + z * z - r * r, out);
  }
}

}  // namespace

std::vector<double> borders(const PreparedCutter& cutter, double rho) {
  std::vector<double> out;
  by_kind(cutter, [&](const auto& kind) { find(kind, rho, out); });
  std::ranges::sort(out);
  return out;
}

}  // namespace tubecut::joint
