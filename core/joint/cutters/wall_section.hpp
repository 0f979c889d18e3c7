#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/joint/cutters/kind.hpp"
#include "core/math/search.hpp"

namespace tubecut::joint {

/// The distances by which a generator passes outside a partner's left and right side, mm across; it
/// meets the partner if neither is > 0. Both are linear in the generator's radius at one phi.
struct Sides {
  double left = 0.0, right = 0.0;
};

/// A convex partner in the half plane of one phi, where it is convex too.
template <class Kind>
class WallSection {
 public:
  WallSection(const Kind& cutter, const Wall& wall, const Generator& inner)
      : cutter_(cutter), wall_(wall), inner_(inner), from_(wall.inner), to_(wall.outer) {
    const auto in = cutter.sides(at(wall.inner));
    const auto out = cutter.sides(at(wall.outer));
    for (const auto side : {&Sides::left, &Sides::right}) clip(in.*side, out.*side);
  }

  /// Computes the largest slope from the root to the partner: if the root is on it, its own slope,
  /// else from above, where the slope is unimodal.
  [[nodiscard]] double steepest(double z_root) const {
    if (!(from_ <= to_) || to_ <= wall_.inner * (1.0 + kSameHeight)) return -kInfinity;
    const double noise = kSameHeight * (wall_.outer + std::abs(z_root));
    if (from_ <= wall_.inner && top(wall_.inner) >= z_root - noise) {
      const auto n = cutter_.continued_hit(inner_).normal;
      if (n.z() > 0.0) return -n.x() / n.z();
      return n.x() > 0.0 ? -kInfinity : kInfinity;
    }
    const auto slope = [&](double rho) { return (top(rho) - z_root) / (rho - wall_.inner); };
    const double from = std::max(from_, wall_.inner + kSameHeight * wall_.outer);
    return std::max({slope(from), slope(to_), math::golden_maximum(slope, from, to_).value});
  }

  [[nodiscard]] double support(double slope) const {
    if (!(from_ <= to_)) return -kInfinity;
    const auto foot = [&](double rho) { return top(rho) - (rho - wall_.inner) * slope; };
    return std::max({foot(from_), foot(to_), math::golden_maximum(foot, from_, to_).value});
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  [[nodiscard]] Generator at(double rho) const { return {rho, inner_.cos_phi, inner_.sin_phi}; }
  [[nodiscard]] double top(double rho) const { return cutter_.continued_sheet(at(rho)); }

  void clip(double in, double out) {
    const double slack = kTouch * wall_.outer;
    if (in <= slack && out <= slack) return;
    const double rho = wall_.inner + (wall_.outer - wall_.inner) * (slack - in) / (out - in);
    if (in > slack && out > slack)
      from_ = kInfinity;
    else if (in > slack)
      from_ = std::max(from_, rho);
    else
      to_ = std::min(to_, rho);
  }

  const Kind& cutter_;
  const Wall& wall_;
  const Generator& inner_;
  double from_, to_;  // the part of the wall in which the partner is met; empty when from > to
};

}  // namespace tubecut::joint
