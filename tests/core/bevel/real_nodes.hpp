#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "core/bevel/smoothing/smoothing.hpp"

/// Bevel angles of random sound nodes, straight from the closed forms, for tests of the smoothing
/// only.
namespace tubecut::bevel::real_nodes {

struct Tube {
  double r, alpha, beta, s, h;
};

/// z and B (half dihedral, cap 45 deg, weld side) of one tube on the generator phi; empty where it
/// misses.
inline std::optional<std::pair<double, double>> hit(const Tube& t, double rho, double phi) {
  const double u = rho * std::cos(phi - t.beta);
  const double v = rho * std::sin(phi - t.beta);
  const double x = u + t.s;
  if (std::abs(x) >= t.r) return std::nullopt;
  const double y = std::sqrt((t.r - x) * (t.r + x));
  const double z = t.h + (y - v * std::cos(t.alpha)) / std::sin(t.alpha);
  const double out = (x * u + std::cos(t.alpha) * y * v) / (t.r * rho);     // normal, radial
  const double round = (-x * v + std::cos(t.alpha) * y * u) / (t.r * rho);  // tangential
  const double up = std::sin(t.alpha) * y / t.r;                            // axial
  const double psi = std::atan2(std::hypot(round, up), -out);
  const double groove = std::min(0.5 * psi, std::atan(1.0));
  const double tau = 2.0 * std::atan(1.0) - psi + groove;
  return std::pair{z, std::atan2(std::sin(tau) * std::hypot(round, up), std::cos(tau) * up)};
}

/// A chord that meets every generator and 1 to 4 braces; B limited to +-`torch` rad.
inline AngleProfile random_node(std::mt19937_64& random, std::size_t points, double torch) {
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  const double pi = 4.0 * std::atan(1.0);
  const double rho = uniform(20.0, 60.0);
  std::vector<Tube> tubes{
      {rho * uniform(1.15, 2.5), uniform(0.3, 0.7) * pi, uniform(0.0, 2.0) * pi, 0.0, 0.0}};
  tubes[0].s = uniform(-0.95, 0.95) * (tubes[0].r - rho);
  for (int braces = std::uniform_int_distribution<int>(1, 4)(random); braces > 0; --braces)
    tubes.push_back({rho * uniform(0.6, 1.3), uniform(0.15, 0.85) * pi, uniform(0.0, 2.0) * pi,
                     rho * uniform(-0.3, 0.3), rho * uniform(-0.2, 0.6)});
  AngleProfile out{.s = {}, .b = {}, .period = 2.0 * pi * rho};
  for (std::size_t i = 0; i < points; ++i) {
    const double phi = 2.0 * pi * static_cast<double>(i) / static_cast<double>(points);
    std::pair<double, double> highest{-1e300, 0.0};
    for (const auto& tube : tubes)
      if (const auto at = hit(tube, rho, phi); at && at->first > highest.first) highest = *at;
    out.s.push_back(rho * phi);
    out.b.push_back(std::clamp(highest.second, -torch, torch));
  }
  return out;
}

}  // namespace tubecut::bevel::real_nodes
