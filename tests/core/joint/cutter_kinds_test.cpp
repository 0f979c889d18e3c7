#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/joint/cutters/cutter.hpp"
#include "core/joint/intersection.hpp"
#include "core/joint/node/sheets.hpp"
#include "core/joint/solid.hpp"
#include "core/math/rotation.hpp"
#include "tests/support/cut_oracle.hpp"
#include "tests/support/random_cut.hpp"

// Every kind of cutter through every operation that core/joint/cutters/kind.hpp requires of it,
// against the oracle's signed distance, which knows a kind only by its description.
namespace tubecut::joint {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kKinds = std::variant_size_v<Partner>;
constexpr int kEach = 12;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One partner with the oracle's values.
struct Case {
  Partner partner;
  Cutter cutter;
  PreparedCutter prepared;
  oracle::Solid outside;
  double rho, scale;

  [[nodiscard]] double distance(const Vector3d& p) const { return outside({p.x(), p.y(), p.z()}); }
  [[nodiscard]] Vector3d gradient(const Vector3d& p) const {
    const double h = 1e-5 * scale;
    Vector3d out;
    for (const Eigen::Index i : {0, 1, 2})
      out[i] =
          (distance(p + h * Vector3d::Unit(i)) - distance(p - h * Vector3d::Unit(i))) / (2 * h);
    return out;
  }
};

Vector3d on(const Generator& line, double z) {
  return {line.radius * line.cos_phi, line.radius * line.sin_phi, z};
}

Vector3d anywhere(oracle::Random& random, double scale) {
  return {random.any(-scale, scale), random.any(-scale, scale), random.any(-scale, scale)};
}

/// Calls `check` with cases of every kind, met all around and not, and counts the kinds.
template <class F>
void for_every_kind(unsigned seed, F check) {
  oracle::Random random{std::mt19937_64(seed)};
  std::set<std::size_t> partners, cutters;
  for (std::size_t kind = 0; kind < kKinds; ++kind)
    for (int i = 0; i < kEach; ++i) {
      const double rho = random.any(20, 80);
      const auto partner = oracle::random_partner(random, rho, kind, i % 2 == 0);
      const auto cutter = resolve({&partner, 1});
      ASSERT_TRUE(cutter);
      const auto prepared = prepare(cutter->front());
      if (!prepared) continue;  // a cone the target runs inside of
      partners.insert(partner.index());
      cutters.insert(prepared->index());
      SCOPED_TRACE("kind " + std::to_string(kind) + ", case " + std::to_string(i));
      check(random,
            Case{partner, cutter->front(), *prepared, oracle::solid_of(partner), rho, 4.0 * rho});
    }
  EXPECT_EQ(partners.size(), kKinds) << "random_partner makes every kind";
  EXPECT_EQ(cutters.size(), std::variant_size_v<Cutter>);
}

double value(const Trig<1>& t, double phi) {
  return t.c[1].re + 2.0 * (t.c[2].re * std::cos(phi) - t.c[2].im * std::sin(phi));
}
double value(const Trig<2>& t, double phi) {
  return t.c[2].re + 2.0 * (t.c[3].re * std::cos(phi) - t.c[3].im * std::sin(phi)) +
         2.0 * (t.c[4].re * std::cos(2 * phi) - t.c[4].im * std::sin(2 * phi));
}

TEST(CutterKinds, LeaveTheirGeneratorsAtTheirOwnSurface) {
  int hits = 0;
  for_every_kind(1, [&](oracle::Random& random, const Case& c) {
    for (int k = 0; k < 60; ++k) {
      const double phi = random.any(0, kTwoPi);
      const auto line = generator_at(c.rho, phi);
      const auto top = upper_sheet(c.prepared, line);
      EXPECT_TRUE(std::isfinite(continued_sheet(c.prepared, line)));
      if (!top) {
        for (int i = 0; i < 40; ++i)
          EXPECT_GT(c.distance(on(line, random.any(-3, 3) * c.scale)), -1e-9 * c.scale);
        continue;
      }
      ++hits;
      EXPECT_EQ(continued_sheet(c.prepared, line), *top);
      const double size = rounding_size(c.prepared, c.rho);
      EXPECT_GT(size, 0.0);
      EXPECT_LT(std::abs(c.distance(on(line, *top))), 1e-10 * size);
      for (int i = 0; i < 20; ++i)
        EXPECT_GT(c.distance(on(line, *top + random.any(1e-3, 3) * c.scale)), 0.0);
      const auto at = hit(c.prepared, line);
      ASSERT_TRUE(at);
      EXPECT_EQ(at->z, *top);
      if (at->normal.z() < 0.1) continue;  // differences next to a silhouette prove nothing
      const Vector3d g = c.gradient(on(line, *top));
      const Vector3d seen(g.x() * line.cos_phi + g.y() * line.sin_phi,
                          g.y() * line.cos_phi - g.x() * line.sin_phi, g.z());
      EXPECT_LT((seen - at->normal).norm(), 1e-4);
      EXPECT_NEAR(at->z_dphi, -c.rho * at->normal.y() / at->normal.z(), 1e-9 * size);
      const double h = 1e-5;
      const auto before = hit(c.prepared, generator_at(c.rho, phi - h));
      const auto after = hit(c.prepared, generator_at(c.rho, phi + h));
      const bool smooth = before && after && (before->normal - after->normal).norm() < 1e-3;
      if (smooth) {
        EXPECT_NEAR(at->z_dphi, (after->z - before->z) / (2 * h), 1e-3 * size);
      }
      const bool tube = std::holds_alternative<TubeCutter>(c.cutter);
      const auto published = published_normal(c.prepared, line);
      EXPECT_EQ(published.x(), at->normal.x());
      if (!tube) {
        EXPECT_EQ(published, at->normal);
      }
    }
  });
  EXPECT_GT(hits, 2000);
}

TEST(CutterKinds, AreMetBetweenTheirSilhouettes) {
  int borders = 0;
  for_every_kind(2, [&](oracle::Random& random, const Case& c) {
    const auto hits = [&](double phi) {
      return upper_sheet(c.prepared, generator_at(c.rho, phi)).has_value();
    };
    auto phases = silhouettes(c.prepared, c.rho);
    for (double& phi : phases) phi = math::whole_turn(phi);
    std::ranges::sort(phases);
    int met_by = 0;
    for (int k = 0; k < 360; ++k) met_by += hits(kTwoPi * k / 360) ? 1 : 0;
    const auto told = met(c.prepared, c.rho);
    if (told == Met::always) {
      EXPECT_EQ(met_by, 360);
    }
    if (told == Met::never) {
      EXPECT_EQ(met_by, 0);
    }
    if (phases.empty()) {
      EXPECT_TRUE(met_by == 0 || met_by == 360);
    }
    for (std::size_t k = 0; k < phases.size(); ++k) {
      const double from = phases[k];
      const double to = k + 1 < phases.size() ? phases[k + 1] : phases[0] + kTwoPi;
      if (to - from < 1e-6) continue;
      const bool between = hits(from + 0.5 * (to - from));
      for (int i = 0; i < 10; ++i)
        EXPECT_EQ(hits(from + random.any(0.001, 0.999) * (to - from)), between);
      if (hits(from - 1e-6) == hits(from + 1e-6)) continue;
      ++borders;
      const auto line = generator_at(c.rho, from);
      const double z = silhouette_height(c.prepared, line);
      EXPECT_LT(std::abs(c.distance(on(line, z))), 1e-7 * c.scale);
      EXPECT_LT(std::abs(c.gradient(on(line, z)).z()), 1e-2);
      EXPECT_TRUE(std::isfinite(silhouette_slope(c.prepared, line)));
    }
    EXPECT_TRUE(kinks(c.prepared, c.rho).empty());
  });
  EXPECT_GT(borders, 40);
}

TEST(CutterKinds, HaveSheetsThatHoldTheirHeights) {
  int closed = 0;
  for_every_kind(3, [&](oracle::Random& random, const Case& c) {
    const auto pieces = sheets(c.prepared, c.rho);
    EXPECT_EQ(pieces.empty(), std::holds_alternative<ElbowCutter>(c.cutter));
    if (pieces.empty()) return;
    ++closed;
    for (int k = 0; k < 60; ++k) {
      const double phi = random.any(0, kTwoPi);
      const auto top = upper_sheet(c.prepared, generator_at(c.rho, phi));
      if (!top) continue;
      double nearest = c.scale, most = 0.0;
      for (const auto& piece : pieces) {
        most = std::max(most, piece.size);
        const double square = value(piece.square, phi);
        if (!piece.curved) {
          EXPECT_EQ(square, 0.0);
        }
        if (square < 0.0) continue;
        nearest = std::min(nearest, std::abs(value(piece.mid, phi) + std::sqrt(square) - *top));
      }
      EXPECT_EQ(most, rounding_size(c.prepared, c.rho));
      EXPECT_LT(nearest, 1e-6 * most);
    }
  });
  EXPECT_GT(closed, 40);
}

TEST(CutterKinds, BoundTheirHeightsNearAGenerator) {
  for_every_kind(4, [&](oracle::Random& random, const Case& c) {
    for (int k = 0; k < 40; ++k) {
      const auto line = generator_at(c.rho, random.any(0, kTwoPi));
      const double off = random.any(0.001, 0.2) * c.rho;
      const auto heights = heights_near(c.prepared, line, off);
      for (int i = 0; i < 20; ++i) {
        const double way = random.any(0, off), turn = random.any(0, kTwoPi);
        const double x = c.rho * line.cos_phi + way * std::cos(turn);
        const double y = c.rho * line.sin_phi + way * std::sin(turn);
        const auto top = upper_sheet(c.prepared, generator_at(std::hypot(x, y), std::atan2(y, x)));
        EXPECT_LE(top.value_or(-kInfinity), heights.most + 1e-9 * c.scale);
        EXPECT_GE(top.value_or(-kInfinity), heights.least - 1e-9 * c.scale);
      }
    }
  });
}

TEST(CutterKinds, KeepAStraightCutOutOfTheWall) {
  for_every_kind(5, [&](oracle::Random& random, const Case& c) {
    const Wall wall{0.8 * c.rho, c.rho};
    for (int k = 0; k < 12; ++k) {
      const auto line = generator_at(wall.inner, random.any(0, kTwoPi));
      const double slope = random.any(-1.5, 1.5);
      const auto root = upper_sheet(c.prepared, line);
      const double z_root = root.value_or(0.0) + random.any(0.01, 0.5) * c.rho;
      double foot = -kInfinity, steep = -kInfinity;
      constexpr int kAcross = 400;
      for (int i = 0; i <= kAcross; ++i) {
        const double across = (wall.outer - wall.inner) * i / kAcross;
        const auto top = upper_sheet(c.prepared, {wall.inner + across, line.cos_phi, line.sin_phi});
        if (!top) continue;
        foot = std::max(foot, *top - across * slope);
        if (i > 0) steep = std::max(steep, (*top - z_root) / across);
      }
      const double least = support(c.prepared, wall, line, slope);
      EXPECT_GE(least, foot - 1e-6 * c.scale);
      if (foot > -kInfinity) {
        EXPECT_LE(least, foot + 0.02 * c.scale);
      }
      if (root) {
        EXPECT_GE(steepest(c.prepared, wall, line, z_root), steep - 1e-5);
      }
      if (root && steep > -kInfinity && std::abs(steep) < 3) {
        EXPECT_LE(steepest(c.prepared, wall, line, z_root), steep + 0.2);
      }
    }
  });
}

TEST(CutterKinds, GrowAndTurnAsSolids) {
  for_every_kind(6, [&](oracle::Random& random, const Case& c) {
    const double by = random.any(-0.1, 0.3);
    const auto thicker = oracle::solid_of(grown(c.partner, by));
    const auto angle = Angle::rad(random.any(-3, 3));
    const auto other = turned(c.partner, angle);
    const auto aside = oracle::solid_of(other);
    for (int k = 0; k < 40; ++k) {
      const Vector3d p = anywhere(random, 3 * c.scale);
      EXPECT_NEAR(thicker({p.x(), p.y(), p.z()}), c.distance(p) - by, 1e-9 * c.scale);
      const double x = std::cos(angle.rad()) * p.x() - std::sin(angle.rad()) * p.y();
      const double y = std::sin(angle.rad()) * p.x() + std::cos(angle.rad()) * p.y();
      EXPECT_NEAR(aside({x, y, p.z()}), c.distance(p), 1e-9 * c.scale);
    }
    const auto a = bearing(c.partner), b = bearing(other);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) return;
    const auto turned_by = [&](double from, double to) {
      return std::abs(std::remainder(to - from - angle.rad(), kTwoPi));
    };
    EXPECT_LT(turned_by(a->perpendicular, b->perpendicular), 1e-9);
    ASSERT_EQ(a->lean.has_value(), b->lean.has_value());
    if (a->lean) {
      EXPECT_LT(turned_by(*a->lean, *b->lean), 1e-9);
    }
  });
}

TEST(CutterKinds, AreTheOraclesSolids) {
  int tops = 0, passing = 0;
  for_every_kind(7, [&](oracle::Random& random, const Case& c) {
    const Solid solid(c.cutter);
    EXPECT_EQ(solid.scale() == 0.0, std::holds_alternative<PlaneCutter>(c.cutter));
    for (int k = 0; k < 30; ++k) {
      const Vector3d p = anywhere(random, 2 * c.scale), q = anywhere(random, 2 * c.scale);
      EXPECT_NEAR(solid.distance(p), c.distance(p), 1e-9 * c.scale);
      const Vector3d g = c.gradient(p);
      if (std::abs(g.norm() - 1.0) < 1e-4) {
        EXPECT_LT((solid.normal(p) - g).norm(), 2e-2);
      }
      double least = solid.distance(p);
      for (int i = 0; i <= 400; ++i) least = std::min(least, c.distance(p + i / 400.0 * (q - p)));
      const double found = solid.least_distance(p, q);
      EXPECT_LE(found, least + 0.01 * c.scale);
      EXPECT_GE(found, least - 0.01 * c.scale);
      by_kind(solid.kind(), [&]<class Kind>(const Kind& kind) {
        const Vector3d way = (q - p).normalized();
        const double h = 1e-3 * c.scale, at = kind.distance(p);
        const double second =
            (kind.distance(p + h * way) - 2 * at + kind.distance(p - h * way)) / (h * h);
        const double slack = 1e-6 / c.scale;
        EXPECT_GE(kind.most_hollow(at + h), 0.0);
        EXPECT_GE(second, -kind.most_hollow(at + h) - slack);
        if constexpr (PlainSolid<Kind>) {
          EXPECT_LE(second, kind.most_bent(at - h) + slack);
          EXPECT_NEAR(kind.distance(p + kind.nearest_share(p, q) * (q - p)), found, 1e-6 * c.scale);
        }
      });
      const auto line = generator_at(c.rho, random.any(0, kTwoPi));
      const Vector3d foot = on(line, 0.0);
      const auto top = upper_sheet(c.prepared, line);
      const auto proved = solid.top(foot.x(), foot.y());
      const double clearance = solid.clearance(foot.x(), foot.y());
      if (std::abs(clearance) < 1e-6 * c.scale) continue;
      ASSERT_EQ(top.has_value(), proved.has_value());
      EXPECT_EQ(top.has_value(), clearance < 0.0);
      (top ? tops : passing) += 1;
      if (top) {
        EXPECT_NEAR(*top, *proved, 1e-6 * c.scale);
      }
    }
  });
  EXPECT_GT(tops, 1000);
  EXPECT_GT(passing, 100);
}

/// At a corner both sides' hits are the limits of the adjacent ones; elsewhere they are the hit.
TEST(CutterKinds, DistinguishBothSidesOfACorner) {
  const double rho = 40.0;
  for (const double offset : {12.0, -12.0, 0.0}) {
    const TubeCutter tube{.radius = rho + std::abs(offset),
                          .inclination = Angle::deg(70),
                          .clocking = Angle::deg(30),
                          .offset = offset};
    const auto prepared = *prepare(tube);
    const auto corners = kinks(prepared, rho);
    ASSERT_EQ(corners.size(), offset == 0.0 ? 2u : 1u);
    for (const double phi : corners)
      for (const auto side : {Side::before, Side::after}) {
        const double h = side == Side::before ? -1e-4 : 1e-4;
        const auto at = hit_at_corner(prepared, generator_at(rho, phi), side);
        const auto beside = continued_hit(prepared, generator_at(rho, phi + h));
        EXPECT_NEAR(at.z, beside.z, 0.02);
        EXPECT_NEAR(at.z_dphi, beside.z_dphi, 0.05);
        EXPECT_LT((at.normal - beside.normal).norm(), 1e-3);
      }
  }
  for_every_kind(8, [&](oracle::Random& random, const Case& c) {
    if (std::holds_alternative<TubeCutter>(c.cutter)) return;
    const auto line = generator_at(c.rho, random.any(0, kTwoPi));
    if (!upper_sheet(c.prepared, line)) return;
    for (const auto side : {Side::before, Side::after})
      EXPECT_EQ(hit_at_corner(c.prepared, line, side).normal,
                continued_hit(c.prepared, line).normal);
  });
}

}  // namespace
}  // namespace tubecut::joint
