#include "core/bevel/table/radius_rates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "core/bevel/table/table.hpp"
#include "core/joint/solid.hpp"
#include "tests/support/random_cut.hpp"

namespace tubecut::bevel {
namespace {

constexpr double kRateStep = 1e-5;  // mm, of a radius

/// The partner with its radius larger; empty if it has no radius.
std::optional<joint::Partner> with_wider_radius(joint::Partner partner, double by) {
  const bool has = std::visit(
      [&](auto& kind) {
        if constexpr (requires { kind.radius; }) kind.radius += by;
        return requires { kind.radius; };
      },
      partner);
  return has ? std::optional(partner) : std::nullopt;
}

/// How high the partner reaches at a place of the wall, from the solid in space.
std::optional<double> top_of(const joint::Partner& partner, double rho, double phi) {
  const auto cutters = joint::resolve(std::vector{partner});
  if (!cutters) return std::nullopt;
  return joint::Solid(cutters->front()).top(rho * std::cos(phi), rho * std::sin(phi));
}

/// By differences of the heights of solids on both sides; empty if they do not settle.
std::optional<double> central_difference(const std::optional<double>& low,
                                         const std::optional<double>& high, double by) {
  if (!low || !high) return std::nullopt;
  return (*high - *low) / (2.0 * by);
}

TableSpec cut_by_kind(oracle::Random& random, std::size_t kind) {
  const double rho = random.any(10.0, 150.0);
  TableSpec spec{.target = {.outer_radius = rho, .wall = rho * random.any(0.03, 0.3)},
                 .partners = {oracle::random_partner(random, rho, kind, true)}};
  spec.sampling.uniform_points = 24;
  spec.root_surface = random.chance(0.5) ? RootSurface::inner : RootSurface::outer;
  spec.contact = Contact::none;
  spec.groove = NoGroove{};
  spec.smoothing = NoSmoothing{};
  return spec;
}

/// Number of comparisons, number without a rate, and the largest difference, of the rate.
struct ComparedRates {
  int rows = 0, none = 0;
  double worst = 0.0;
};

void compare_rates(const TableSpec& spec, const Table& t, ComparedRates& seen) {
  const double rho = spec.root_surface == RootSurface::outer ? spec.target.outer_radius
                                                             : spec.target.inner_radius();
  const auto& partner = spec.partners.front();
  const auto less = with_wider_radius(partner, -kRateStep),
             more = with_wider_radius(partner, kRateStep);
  for (std::size_t i = 0; i < t.phi.size(); ++i) {
    const double phi = t.phi[i];
    EXPECT_EQ(std::isnan(t.dz_chord[i]), !more.has_value());
    // A step of half the width shows the linearity of the surface there.
    const auto branch = central_difference(top_of(partner, rho - kRateStep, phi),
                                           top_of(partner, rho + kRateStep, phi), kRateStep);
    const auto again = central_difference(top_of(partner, rho - 4 * kRateStep, phi),
                                          top_of(partner, rho + 4 * kRateStep, phi), 4 * kRateStep);
    if (!branch || !again || std::abs(*branch - *again) > 1e-4 * (1.0 + std::abs(*branch)))
      continue;
    const auto held = [&](double got, double wanted) {
      seen.worst = std::max(seen.worst, std::abs(got - wanted) / (1.0 + std::abs(wanted)));
      ++seen.rows;
    };
    held(t.dz_branch[i], *branch);
    if (!more) {
      ++seen.none;
      continue;
    }
    if (const auto chord =
            central_difference(top_of(*less, rho, phi), top_of(*more, rho, phi), kRateStep))
      held(t.dz_chord[i], *chord);
  }
}

TEST(RadiusRates, AreTheDifferencesOfHeightsOfSolidsThatAreWider) {
  oracle::Random random{std::mt19937_64{20261127}};
  for (std::size_t kind = 0; kind < 6; ++kind) {
    ComparedRates seen;
    int tables = 0;
    for (int i = 0; i < 80; ++i) {
      const auto spec = cut_by_kind(random, kind);
      const auto t = table(spec);
      if (!t) continue;  // a partner that leaves a side open, or an elbow that hides itself
      ++tables;
      compare_rates(spec, *t, seen);
    }
    std::printf("kind %zu: %d tables, %d rates, %d rows without one, off by %.2g\n", kind, tables,
                seen.rows, seen.none, seen.worst);
    EXPECT_GE(tables, 35) << kind;
    EXPECT_GE(seen.rows, 24 * tables / 2) << kind;
    EXPECT_LT(seen.worst, 1e-6) << kind;
    EXPECT_EQ(seen.none > 0, kind == 2 || kind == 3) << kind;
  }
}

TEST(RadiusRates, TheGapIsTheChordsChangeAndTheBranchsByTheCosineOfTheDihedral) {
  oracle::Random random{std::mt19937_64{7}};
  int rows = 0;
  for (int i = 0; i < 60; ++i) {
    auto spec = cut_by_kind(random, 0);
    spec.root_surface = RootSurface::inner;
    const auto t = table(spec);
    if (!t) continue;
    for (std::size_t k = 0; k < t->phi.size(); ++k) {
      const double axial = 1.0 / t->dz_chord[k];  // a gap is the height times this
      EXPECT_NEAR(t->dz_branch[k] * axial, std::cos(t->dihedral[k]), 1e-9);
      ++rows;
    }
  }
  EXPECT_GT(rows, 800);
}

TEST(RadiusRates, AreAbsentAtASilhouette) {
  const auto cutter = joint::prepare(
      joint::Cutter{joint::TubeCutter{.radius = 40.0, .inclination = Angle::deg(60)}});
  ASSERT_TRUE(cutter);
  const auto rates = radius_rates(*cutter, {1.0, 0.0, 0.0});
  EXPECT_TRUE(std::isnan(rates.branch));
  EXPECT_TRUE(std::isnan(rates.chord));
}

}  // namespace
}  // namespace tubecut::bevel
