#include "core/motion/path/straight_edges.hpp"

#include <cmath>

#include "core/base/elementary.hpp"

namespace tubecut::motion {
namespace {

double mixed(double a, double b, double share) { return a + share * (b - a); }

double mixed_angle(double a, double b, double share) {
  if (a == b) return a;
  return elementary::atan(mixed(elementary::tan(a), elementary::tan(b), share));
}

}  // namespace

std::optional<InnerExit> inner_exit(const WallRadii& wall, const TorchLean& at) {
  const double c = wall.outer * wall.outer - wall.inner * wall.inner;
  const double rho = elementary::tan(at.a);
  const double root = wall.outer * wall.outer - (1.0 + rho * rho) * c;
  if (!(root > 0.0)) return std::nullopt;
  const double h = c / (wall.outer + std::sqrt(root));
  return InnerExit{.phi = at.phi - elementary::atan2(h * rho, wall.outer - h),
                   .z = at.z - h * elementary::tan(at.b)};
}

TorchLean between(const WallRadii& wall, const TorchLean& from, const TorchLean& to, double share) {
  TorchLean out{.phi = mixed(from.phi, to.phi, share), .z = mixed(from.z, to.z, share)};
  const bool in_plane = from.a == 0.0 && to.a == 0.0;
  const auto first = in_plane ? std::nullopt : inner_exit(wall, from);
  const auto last = in_plane ? std::nullopt : inner_exit(wall, to);
  if (!first || !last) {
    out.b = mixed_angle(from.b, to.b, share);
    out.a = in_plane ? 0.0 : mixed_angle(from.a, to.a, share);
    return out;
  }
  const auto [sin, cos] = elementary::sincos(mixed(first->phi, last->phi, share) - out.phi);
  const double outwards = wall.outer - wall.inner * cos;
  out.a = elementary::atan2(-wall.inner * sin, outwards);
  out.b = elementary::atan2(out.z - mixed(first->z, last->z, share), outwards);
  return out;
}

}  // namespace tubecut::motion
