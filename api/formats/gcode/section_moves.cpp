#include "api/formats/gcode/section_moves.hpp"

#include <algorithm>
#include <cmath>

#include "api/stop.hpp"
#include "core/base/elementary.hpp"
#include "core/motion/path/straight_edges.hpp"

namespace tubecut::api {
namespace {

constexpr double kMargin = 1.5;  // of the turn's sag, found at three places of a move
constexpr int kHalvings = 16;
const Angle kLean = Angle::deg(1.0);  // as of a schedule that states none

/// The tip in the plane across the tube.
Eigen::Vector2d tip(const UprightPlace& at) {
  const auto [sin, cos] = elementary::sincos(at.angle);
  return {at.out * cos - at.across * sin, at.out * sin + at.across * cos};
}

TorchPlace between(const TorchReach& r, const TorchPlace& from, const TorchPlace& to,
                   double share) {
  const auto mixed = [&](double x, double y) { return x + share * (y - x); };
  const auto turned = [&](double x, double y) {
    return elementary::atan(mixed(elementary::tan(x), elementary::tan(y)));
  };
  if (from.on_flat)  // both edges are straight there if the tangents are linear
    return {mixed(from.phi, to.phi),
            mixed(from.z, to.z),
            turned(from.b, to.b),
            turned(from.a, to.a),
            true,
            from.still};
  const auto at = motion::between({r.outer_radius, r.inner_radius}, {from.phi, from.z, from.b},
                                  {to.phi, to.z, to.b}, share);
  return {.phi = at.phi, .z = at.z, .b = at.b, .still = from.still};
}

}  // namespace

SectionTurn::SectionTurn(const section::Section& section)
    : section_(section), up_(section, kLean), radius_(motion::equal_radius(section)) {}

UprightPlace SectionTurn::at(const TorchPlace& place) const {
  const double s = radius_ * place.phi;
  const double angle = place.still ? *place.still : up_.angle(s);
  const auto p = up_.point(s);
  const auto [sin, cos] = elementary::sincos(angle);
  return {angle, p.y() * cos - p.x() * sin, p.x() * cos + p.y() * sin};
}

/// An edge on the bore is farther than the tip by the wall times the difference of the angle.
double SectionTurn::turn_sag(const TorchReach& reach, const TorchPlace& from,
                             const TorchPlace& to) const {
  const auto a = at(from), b = at(to);
  double most = 0.0;
  for (const double share : {0.25, 0.5, 0.75}) {
    const auto mixed = [&](double x, double y) { return x + share * (y - x); };
    const UprightPlace straight{mixed(a.angle, b.angle), mixed(a.across, b.across),
                                mixed(a.out, b.out)};
    auto middle = from;
    middle.phi = mixed(from.phi, to.phi);
    const auto exact = at(middle);
    const double wall = reach.outer_radius - reach.inner_radius;
    most = std::max(
        most, (tip(straight) - tip(exact)).norm() + wall * std::abs(straight.angle - exact.angle));
  }
  return kMargin * most;
}

std::vector<TorchPlace> SectionTurn::moves(const TorchReach& reach, const TorchPlace& from,
                                           const TorchPlace& to, double limit,
                                           double& worst) const {
  std::vector<double> shares;
  const double low = std::min(from.phi, to.phi), high = std::max(from.phi, to.phi);
  for (const double s : up_.breaks(radius_ * low, radius_ * high))
    shares.push_back((s / radius_ - from.phi) / (to.phi - from.phi));
  std::ranges::sort(shares);
  shares.push_back(1.0);
  struct Rest {
    double end;
    int halvings;
  };
  std::vector<TorchPlace> out;
  auto at = from;
  double share = 0.0;
  for (const double end : shares) {
    std::vector<Rest> todo{{end, 0}};
    while (!todo.empty()) {
      ask();
      const auto [next_end, halvings] = todo.back();
      const auto next = next_end == 1.0 ? to : between(reach, from, to, next_end);
      const double off = sag(reach, at, next) + turn_sag(reach, at, next);
      if (halvings < kHalvings && off > limit) {
        todo.back().halvings = halvings + 1;
        todo.push_back({0.5 * (share + next_end), halvings + 1});
        continue;
      }
      worst = std::max(worst, off);
      out.push_back(at = next);
      share = next_end;
      todo.pop_back();
    }
  }
  return out;
}

}  // namespace tubecut::api
