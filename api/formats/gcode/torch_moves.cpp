#include "api/formats/gcode/torch_moves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/elementary.hpp"
#include "core/motion/path/straight_edges.hpp"

namespace tubecut::api {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kHalvings = 16;

double squared(double v) { return v * v; }

/// The torch below the outer wall, for a tilt across of tangent `rho`: how deep, in its own frame's
/// x, it meets the inner wall, and the first two derivatives of that by rho. They all grow with
/// |rho|. With C = ro^2 - ri^2 depth h solves (1 + rho^2) h^2 - 2 ro h + C = 0.
struct Depth {
  double h, first, second;
  double root;  // D = ri times the cosine in the plane across the tube
};
std::optional<Depth> depth(const TorchReach& r, double rho) {
  const double c = squared(r.outer_radius) - squared(r.inner_radius);
  const double root = squared(r.outer_radius) - (1.0 + rho * rho) * c;
  if (!(root > 0.0)) return std::nullopt;
  const double d = std::sqrt(root), h = c / (r.outer_radius + d);
  return Depth{
      .h = h,
      .first = rho * h * h / d,
      .second = h * h * (1.0 / d + 2.0 * rho * rho * h / (d * d) + rho * rho * c / (d * d * d)),
      .root = d};
}

/// Bounds over a whole move: maximum |tan|, and of its first and second derivative.
struct Tangent {
  double least, most, first, second;
};
Tangent tangent(double from, double to) {
  const double a = std::abs(from), b = std::abs(to), step = std::abs(to - from);
  const double most = elementary::tan(std::max(a, b)), slope = 1.0 + most * most;
  const bool through_zero = (from < 0.0) != (to < 0.0);
  return {.least = through_zero ? 0.0 : elementary::tan(std::min(a, b)),
          .most = most,
          .first = slope * step,
          .second = 2.0 * most * slope * step * step};
}

/// A torch in the axial plane: u'' is B'^2, and the walls are straight lines there.
double sag_in_plane(const TorchReach& r, const TorchPlace& from, const TorchPlace& to) {
  const auto b = tangent(from.b, to.b);
  const double tip = r.pivot * squared(to.b - from.b);
  const double inner = (r.outer_radius - r.inner_radius) * b.second;
  return (tip * std::sqrt(1.0 + b.most * b.most) + inner) / 8.0;
}

/// v = (1, tan a, tan b), u = v / |v|: |u''| <= |v''| / |v| + 2 |v'|^2 / |v|^2.
double tip_sag(const TorchReach& r, const Tangent& a, const Tangent& b) {
  const double least = 1.0 + a.least * a.least + b.least * b.least;
  return r.pivot / 8.0 *
         (elementary::hypot(a.second, b.second) / std::sqrt(least) +
          2.0 * (squared(a.first) + squared(b.first)) / least);
}

/// Bounds the sag of the inner edge while the tip keeps to its line, by the second derivatives of
/// the line's intersection with the inner wall, across (|w''| bounds ri |phi''|) and along.
double inner_sag(const Depth& d, const Tangent& a, const Tangent& b) {
  const double h1 = d.first * a.first, h2 = d.second * squared(a.first) + d.first * a.second;
  const double across = h2 * a.most + 2.0 * h1 * a.first + d.h * a.second;
  const double along = h2 * b.most + 2.0 * h1 * b.first + d.h * b.second;
  return elementary::hypot(h2, across, along) / 8.0;
}

double sag_in_space(const TorchReach& r, const TorchPlace& from, const TorchPlace& to) {
  const auto a = tangent(from.a, to.a), b = tangent(from.b, to.b);
  const auto d = depth(r, a.most);
  if (!d) return kInfinity;
  const double tip = tip_sag(r, a, b);
  // Cosine between torch and inner wall; at the outer one it is greater.
  const double cosine =
      d->root / (r.inner_radius * std::sqrt(1.0 + a.most * a.most + b.most * b.most));
  const double edge = tip / cosine;
  // Off the tangent plane by at most 6 % as long as the wall bends little over that way.
  if (edge > 0.1 * cosine * r.inner_radius) return kInfinity;
  return 1.1 * edge + inner_sag(*d, a, b);
}

/// On a flat, places on the inner wall are linear functions of the tangents.
double sag_on_flat(const TorchReach& r, const TorchPlace& from, const TorchPlace& to) {
  const auto a = tangent(from.a, to.a), b = tangent(from.b, to.b);
  const double cosine = 1.0 / std::sqrt(1.0 + a.most * a.most + b.most * b.most);
  const double inner = (r.outer_radius - r.inner_radius) * elementary::hypot(a.second, b.second);
  return tip_sag(r, a, b) / cosine + inner / 8.0;
}

motion::WallRadii wall(const TorchReach& r) { return {r.outer_radius, r.inner_radius}; }
motion::TorchLean lean(const TorchPlace& p) { return {p.phi, p.z, p.b, p.a}; }

/// The place at which both edges are on their lines.
TorchPlace between(const TorchReach& r, const TorchPlace& from, const TorchPlace& to,
                   double share) {
  const auto at = motion::between(wall(r), lean(from), lean(to), share);
  return {at.phi, at.z, at.b, at.a};
}

}  // namespace

std::optional<InnerPlace> inner_place(const TorchReach& reach, const TorchPlace& at) {
  const auto exit = motion::inner_exit(wall(reach), lean(at));
  return exit ? std::optional(InnerPlace{exit->phi, exit->z}) : std::nullopt;
}

double metal_in_beam(const TorchReach& reach, const TorchPlace& at) {
  const double across = elementary::tan(at.a), along = elementary::tan(at.b);
  if (at.on_flat)
    return (reach.outer_radius - reach.inner_radius) *
           std::sqrt(1.0 + squared(across) + squared(along));
  const auto d = depth(reach, across);
  return d ? d->h * std::sqrt(1.0 + squared(across) + squared(along)) : kInfinity;
}

double sag(const TorchReach& reach, const TorchPlace& from, const TorchPlace& to) {
  if (from.a == 0.0 && to.a == 0.0) return sag_in_plane(reach, from, to);
  if (from.on_flat) return sag_on_flat(reach, from, to);
  return sag_in_space(reach, from, to);
}

std::vector<TorchPlace> straight_moves(const TorchReach& reach, const TorchPlace& from,
                                       const TorchPlace& to, double limit) {
  struct SubMove {
    double end;
    int halvings;
  };
  std::vector<TorchPlace> out;
  std::vector<SubMove> todo{{1.0, 0}};
  auto at = from;
  double share = 0.0;
  while (!todo.empty()) {
    const auto [end, halvings] = todo.back();
    const auto next = end == 1.0 ? to : between(reach, from, to, end);
    if (halvings < kHalvings && sag(reach, at, next) > limit) {
      todo.back().halvings = halvings + 1;
      todo.push_back({(share + end) / 2.0, halvings + 1});
      continue;
    }
    out.push_back(next);
    at = next;
    share = end;
    todo.pop_back();
  }
  return out;
}

}  // namespace tubecut::api
