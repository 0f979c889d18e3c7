#pragma once

// Random bevel tables of every kind the service offers: one to six partners of every kind (now
// and then twenty), every contact, groove rule, sampling and smoothing, with and without root face,
// kerf, gap and coating.

#include <algorithm>
#include <cmath>
#include <random>

#include "core/bevel/table/table.hpp"

namespace tubecut::oracle {

struct Random {
  std::mt19937_64 engine;

  double any(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  }
  std::size_t upto(std::size_t last) {
    return std::uniform_int_distribution<std::size_t>(0, last)(engine);
  }
  bool chance(double share) { return any(0.0, 1.0) < share; }
  Eigen::Vector3d sideways(double rise) {
    const double phi = any(0.0, kTwoPi);
    return {std::cos(phi), std::sin(phi), any(-rise, rise)};
  }
};

/// A partner of one kind (0 tube, 1 tube by its axis, 2 plane, 3 box, 4 cone, 5 elbow) for a target
/// of radius rho; `wide`: every generator meets it.
inline joint::Partner random_partner(Random& random, double rho, std::size_t kind, bool wide) {
  const double size = rho * (wide ? random.any(1.05, 2.2) : random.any(0.5, 1.6));
  const double off = wide ? random.any(-0.9, 0.9) * (size - rho) : random.any(-0.8, 0.8) * rho;
  const double up = wide ? 0.0 : rho * random.any(-0.3, 0.9);
  const Eigen::Vector3d along = random.sideways(0.7);
  const Eigen::Vector3d at(random.any(-0.3, 0.3) * rho, random.any(-0.3, 0.3) * rho, up);
  switch (kind) {
    case 1:
      return joint::AxisTube{.radius = wide ? 1.5 * size : size,
                             .axis = {.point = {0.4 * off * along.y(), -0.4 * off * along.x(), up},
                                      .direction = along}};
    case 2:
      return joint::PlaneCutter{.point = {0, 0, up},
                                .normal = {random.any(-0.8, 0.8), random.any(-0.8, 0.8), 1.0}};
    case 3: {
      const double width = (wide ? 3.2 : 2.0) * size, height = width * random.any(0.6, 1.4);
      return joint::RectangularTubeCutter{.width = width,
                                          .height = height,
                                          .corner = random.any(0.03, 0.4) * std::min(width, height),
                                          .point = at,
                                          .direction = along,
                                          .up = {0.2, 0.1, 1.0}};
    }
    case 4:
      return joint::ConeCutter{.radius = wide ? 1.8 * size : size,
                               .half_angle = Angle::deg(random.any(-25, 25)),
                               .point = at,
                               .direction = along};
    case 5: {
      const double radius = (wide ? 1.4 : 1.0) * size;
      const double bend = radius * random.any(1.6, 4.0);
      return joint::ElbowCutter{.radius = radius,
                                .bend_radius = bend,
                                .bend = Angle::deg(random.any(20, 120)),
                                .point = -random.any(0.0, 1.0) * bend * along,
                                .direction = along,
                                .inwards = {random.any(-0.6, 0.6), random.any(-0.6, 0.6),
                                            random.chance(0.5) ? -1.0 : 1.0}};
    }
    default:
      return joint::TubeCutter{
          .radius = size,
          .inclination = Angle::deg(random.any(28, 152)),
          .clocking = Angle::deg(random.chance(0.3) ? 45.0 * static_cast<double>(random.upto(7))
                                                    : random.any(0, 360)),
          .offset = random.chance(0.3) ? 0.0 : off,
          .height = up};
  }
}

inline bevel::GrooveRule random_groove(Random& random) {
  const auto zone = [](const char* id, double from, double to, double g_from, double g_to) {
    return bevel::GrooveZone{id, Angle::deg(from), Angle::deg(to), Angle::deg(g_from),
                             Angle::deg(g_to)};
  };
  switch (random.upto(4)) {
    case 0:
      return bevel::HalfDihedral{.cap = Angle::deg(random.any(20, 60))};
    case 1:
      return bevel::FixedGroove{.angle = Angle::deg(random.any(0, 45))};
    case 2:
      return bevel::NoGroove{};
    case 3:
      return bevel::SquareCut{};
    default:
      return bevel::ZonedGroove{
          {zone("A", 120, 180, 45, 45), zone("B", 60, 120, 30, 40), zone("C", 0, 60, 0, 20)},
          Angle::deg(10)};
  }
}

inline joint::Sampling random_sampling(Random& random) {
  const auto metric = random.chance(0.3) ? joint::Metric::chord : joint::Metric::developed;
  const joint::Tolerance tolerance{.value = random.chance(0.5) ? 0.05 : random.any(0.01, 0.3),
                                   .metric = metric};
  switch (random.upto(5)) {
    case 0:
      return {.uniform_points = 60 + 12 * random.upto(55)};
    case 1:
      return {.uniform_points = 36 + random.upto(180), .tolerance = tolerance};
    default:
      return {.tolerance = tolerance};
  }
}

/// Root surface, contact and dihedral that go together.
inline void random_contact(Random& random, bevel::TableSpec& out) {
  using enum bevel::Contact;
  switch (random.upto(9)) {
    case 0:
    case 1:
      out.contact = automatic;
      break;
    case 2:
      out.contact = none;
      break;
    case 3:
      out.contact = none;
      out.root_surface = bevel::RootSurface::outer;
      if (random.chance(0.3)) out.dihedral = bevel::Dihedral::inside;
      if (random.chance(0.3)) out.dihedral = bevel::Dihedral::as_published;
      break;
    case 4:
      out.contact = outer;
      out.root_surface = bevel::RootSurface::outer;
      out.groove = bevel::NoGroove{};
      break;
    default:
      out.contact = inner;
      if (random.chance(0.6)) out.root_face = out.target.wall * random.any(0.05, 0.6);
  }
}

inline bevel::Smoothing random_smoothing(Random& random, const joint::Sampling& sampling) {
  if (!sampling.tolerance && random.chance(0.15))
    return bevel::HermiteSmoothing{.transition_points = static_cast<int>(5 + random.upto(15))};
  if (random.chance(0.5)) return bevel::NoSmoothing{};
  return bevel::EnvelopeSmoothing{
      .limits = {.slope = Angle::deg(random.any(1, 6)).rad(),
                 .curvature = Angle::deg(random.any(0.2, 1.5)).rad()},
      .along = random.chance(0.5) ? bevel::Along::developed : bevel::Along::length,
      .refine = random.chance(0.3)};
}

/// A table that may well be refused; most are not.
inline bevel::TableSpec random_cut(Random& random) {
  bevel::TableSpec out;
  const double rho = random.any(10, 170);
  out.target = {.outer_radius = rho, .wall = std::max(1.5, rho * random.any(0.04, 0.3))};
  const std::size_t most = random.chance(0.5) ? 1 : 5;
  out.partners.push_back(
      random_partner(random, rho, random.chance(0.6) ? 0 : random.upto(5), true));
  const std::size_t others = random.chance(0.02) ? 19 : random.upto(most);
  while (out.partners.size() < 1 + others)
    out.partners.push_back(
        random_partner(random, rho, random.chance(0.5) ? 0 : random.upto(5), false));
  out.groove = random_groove(random);
  random_contact(random, out);
  out.sampling = random_sampling(random);
  out.smoothing = random_smoothing(random, out.sampling);
  out.torch = {.min = Angle::deg(-85), .max = Angle::deg(85)};
  if (random.chance(0.2) && out.contact == bevel::Contact::automatic)
    out.torch = {.min = Angle::deg(-45), .max = Angle::deg(45)};
  if (random.chance(0.5)) out.kerf = random.any(0.2, 4.0);
  if (random.chance(0.2)) out.root_gap = random.any(0.0, 4.0);
  if (random.chance(0.1)) out.coating = random.any(0.0, 1.0);
  return out;
}

}  // namespace tubecut::oracle
