#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/bevel/table/table.hpp"

/// Metal that a round beam takes and leaves, by brute force: every point of the finished surface
/// against a dense row of torch positions, each in the half plane of the torch. No tree, no bound,
/// no normals: the finished height where the axis passes shows whether it is in the part.
namespace tubecut::bevel::beam_oracle {

struct Found {
  double gouge = 0.0, gouge_phi = 0.0, left = 0.0, left_phi = 0.0;
};

class Scan {
 public:
  Scan(const TableSpec& spec, const Table& table)
      : spec_(spec), t_(table), half_(spec.kerf / 2), ri_(spec.target.inner_radius()) {
    for (std::size_t i = 0; i < t_.phi.size(); ++i) {
      const double way = std::max(run(i, t_.torch_inner, ri_), run(i, t_.torch_outer, ro()));
      const int steps = std::max(1, static_cast<int>(std::ceil(way / (half_ / 8))));
      for (int k = 0; k < steps; ++k) torch_.push_back(at(i, static_cast<double>(k) / steps));
    }
  }

  /// Every stretch coarsely, then the worst ones finer and finer around their worst place.
  Found worst(double apart) const {
    struct Spot {
      Figures at;
      std::size_t row;
      double u, v, du;
    };
    std::vector<Spot> gouges, lefts;
    std::size_t near = 0;
    for (std::size_t i = 0; i < t_.phi.size(); ++i) {
      const double way = std::max(run(i, t_.z_inner, ri_), run(i, t_.z_outer, ro()));
      const int steps = std::clamp(static_cast<int>(std::ceil(way / apart)), 2, 400);
      Spot gouge{{-1e9, -1e9}, i, 0, 0, 1.0 / steps}, left = gouge;
      for (int k = 0; k <= steps; ++k)
        for (int m = 0; m <= kAcross; ++m) {
          const double u = static_cast<double>(k) / steps, v = static_cast<double>(m) / kAcross;
          const auto seen = see(i, u, v, near);
          if (seen.gouge > gouge.at.gouge) gouge = {seen, i, u, v, 1.0 / steps};
          if (seen.left > left.at.left) left = {seen, i, u, v, 1.0 / steps};
        }
      gouges.push_back(gouge);
      lefts.push_back(left);
    }
    const auto finer = [&](std::vector<Spot>& spots, double Figures::*figure) {
      std::ranges::sort(spots,
                        [&](const Spot& a, const Spot& b) { return a.at.*figure > b.at.*figure; });
      spots.resize(std::min<std::size_t>(spots.size(), 12));
      Spot best = spots.front();
      for (auto& spot : spots)
        for (double part = 0.5; part > 1e-3; part *= 0.4) {
          const auto centre = spot;
          for (int a = -2; a <= 2; ++a)
            for (int b = -2; b <= 2; ++b) {
              const double u = std::clamp(centre.u + 0.5 * a * part * spot.du, 0.0, 1.0);
              const double v = std::clamp(centre.v + 0.5 * b * part / kAcross, 0.0, 1.0);
              const auto seen = see(spot.row, u, v, near);
              if (seen.*figure > spot.at.*figure) spot = {seen, spot.row, u, v, spot.du};
            }
          if (spot.at.*figure > best.at.*figure) best = spot;
        }
      return best;
    };
    const auto gouge = finer(gouges, &Figures::gouge), left = finer(lefts, &Figures::left);
    const auto phi = [&](const Spot& s) { return mix(t_.phi[s.row], turned(s.row + 1), s.u); };
    return {std::max(0.0, gouge.at.gouge), phi(gouge), std::max(0.0, left.at.left), phi(left)};
  }

  /// The largest of both at one phase, across the wall.
  Found at(double phi) const {
    Found out{-1e9, phi, -1e9, phi};
    std::size_t near = 0;
    for (std::size_t i = 0; i < t_.phi.size(); ++i) {
      for (const double there : {phi, phi + kTwoPi}) {
        const double from = t_.phi[i], to = turned(i + 1);
        if (there < from - 1e-12 || there > to + 1e-12) continue;
        const bool jump = !(to > from);
        for (int k = 0; k <= (jump ? 64 : 0); ++k)
          for (int m = 0; m <= kFine; ++m) {
            const double u = jump ? k / 64.0 : std::clamp((there - from) / (to - from), 0.0, 1.0);
            const auto seen = see(i, u, static_cast<double>(m) / kFine, near);
            out.gouge = std::max(out.gouge, seen.gouge);
            out.left = std::max(out.left, seen.left);
          }
      }
    }
    return out;
  }

 private:
  static constexpr int kAcross = 4, kFine = 512;
  struct Figures {
    double gouge, left;
  };
  struct Pose {
    std::size_t row;
    double u, phi, foot, slope;
  };
  double ro() const { return spec_.target.outer_radius; }
  double turned(std::size_t i) const { return i < t_.phi.size() ? t_.phi[i] : t_.phi[0] + kTwoPi; }
  double run(std::size_t i, const std::vector<double>& z, double r) const {
    return std::hypot(r * (turned(i + 1) - t_.phi[i]), z[(i + 1) % z.size()] - z[i]);
  }
  static double mix(double a, double b, double u) { return a + u * (b - a); }
  double mix(const std::vector<double>& v, std::size_t i, double u) const {
    return mix(v[i], v[(i + 1) % v.size()], u);
  }
  Pose at(std::size_t i, double u) const {
    const double in = mix(t_.torch_inner, i, u), out = mix(t_.torch_outer, i, u);
    return {i, u, mix(t_.phi[i], turned(i + 1), u), in, (out - in) / spec_.target.wall};
  }
  /// Finished height at the distance `a` from the tube's axis.
  double height(std::size_t i, double u, double a) const {
    const double f = spec_.root_face, zi = mix(t_.z_inner, i, u), zo = mix(t_.z_outer, i, u);
    if (f == 0.0) return mix(zi, zo, (a - ri_) / spec_.target.wall);
    const double ze = mix(t_.z_face, i, u);
    if (a < ri_ + f) return mix(zi, ze, (a - ri_) / f);
    return mix(ze, zo, (a - ri_ - f) / (spec_.target.wall - f));
  }

  /// Signed distance of the axis from (rho, phi, z): negative where it passes in the part.
  double off(const Pose& p, double rho, double phi, double z) const {
    const double a = rho * std::cos(phi - p.phi), b = rho * std::sin(phi - p.phi);
    const double above = z - (p.foot + (a - ri_) * p.slope);
    const double c = 1.0 / std::hypot(1.0, p.slope);
    const double d = std::hypot(b, above * c);
    const double foot_a = a + above * p.slope * c * c;  // where the nearest point of the axis is
    const double foot_z = p.foot + (foot_a - ri_) * p.slope;
    return foot_z > height(p.row, p.u, foot_a) + 1e-12 ? -d : d;
  }

  Figures see(std::size_t i, double u, double v, std::size_t& near) const {
    while (near > 0 && (torch_[near].row > i || (torch_[near].row == i && torch_[near].u > u)))
      --near;
    while (near + 1 < torch_.size() &&
           (torch_[near + 1].row < i || (torch_[near + 1].row == i && torch_[near + 1].u <= u)))
      ++near;
    const double rho = ri_ + v * spec_.target.wall;
    const double phi = mix(t_.phi[i], turned(i + 1), u), z = height(i, u, rho);
    const auto n = static_cast<std::ptrdiff_t>(torch_.size());
    double best = std::abs(off(at(i, u), rho, phi, z));
    std::vector<std::pair<std::ptrdiff_t, double>> measured;
    const auto pose = [&](std::ptrdiff_t k) {
      auto p = torch_[static_cast<std::size_t>((k % n + n) % n)];
      p.phi += kTwoPi * std::floor(static_cast<double>(k) / static_cast<double>(n));
      return p;
    };
    const auto measure = [&](std::ptrdiff_t k) {
      const auto p = pose(k);
      if (rho * std::sin(std::min(kPi / 2, std::abs(phi - p.phi))) > best) return false;
      const double d = std::abs(off(p, rho, phi, z));
      measured.emplace_back(k, d);
      best = std::min(best, d);
      return true;
    };
    const auto start = static_cast<std::ptrdiff_t>(near);
    for (auto k = start; k < start + n / 2 && measure(k); ++k) {
    }
    for (auto k = start - 1; k > start - n / 2 && measure(k); --k) {
    }
    double sign = off(at(i, u), rho, phi, z) < 0.0 ? -1.0 : 1.0;
    // Next to all that are nearly as near: spaced half / 8, so the nearest may lie half / 128
    // nearer.
    const double nearly = best + half_ / 64;
    for (const auto& [k, d0] : measured) {
      if (d0 > nearly) continue;
      for (const auto from : {k - 1, k}) {
        const auto a = pose(from), b = pose(from + 1);
        const double end = b.row == a.row && b.u > a.u ? b.u : 1.0;
        double low = a.u, high = end;
        const auto d = [&](double w) {
          auto p = at(a.row, w);
          p.phi += a.phi - at(a.row, a.u).phi;
          return off(p, rho, phi, z);
        };
        for (int r = 0; r < 40; ++r) {
          const double p = mix(low, high, 0.382), q = mix(low, high, 0.618);
          (std::abs(d(p)) < std::abs(d(q)) ? high : low) = std::abs(d(p)) < std::abs(d(q)) ? q : p;
        }
        const double got = d(0.5 * (low + high));
        if (std::abs(got) <= best) {
          best = std::abs(got);
          sign = got < 0.0 ? -1.0 : 1.0;
        }
      }
    }
    const bool by_beam = rho >= ri_ + spec_.root_face;
    return {half_ - sign * best, by_beam ? sign * best - half_ : -1e9};
  }

  const TableSpec& spec_;
  const Table& t_;
  double half_, ri_;
  std::vector<Pose> torch_;
};

}  // namespace tubecut::bevel::beam_oracle
