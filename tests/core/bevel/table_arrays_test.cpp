#include "core/bevel/table/table_arrays.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "tests/support/random_cut.hpp"

// The array form of a table's verification, compared with the form for one row at a time.

namespace tubecut::bevel {
namespace {

using Eigen::Vector3d;

struct Cut {
  TableSpec spec;
  Table table;
  std::vector<joint::Solid> partners;
};

/// Tables of every kind, and their partners.
std::vector<Cut> make_cuts() {
  std::vector<Cut> out;
  oracle::Random random{std::mt19937_64(20261126)};
  for (int n = 0; n < 120; ++n) {
    Cut cut{oracle::random_cut(random), {}, {}};
    const auto made = table(cut.spec);
    if (!made) continue;
    cut.table = *made;
    const auto grown = grown_partners(cut.spec);
    for (const auto& cutter : *grown) cut.partners.emplace_back(cutter);
    out.push_back(std::move(cut));
  }
  EXPECT_GT(out.size(), 50U);
  return out;
}

const std::vector<Cut>& cuts() {
  static const auto kCuts = make_cuts();
  return kCuts;
}

Vector3d radial(double phi) { return {std::cos(phi), std::sin(phi), 0.0}; }

TEST(TableArrays, NormalsAreThoseOfThePartnersAtTheRootPoints) {
  for (const auto& [spec, t, partners] : cuts()) {
    const Directions phi(t.phi);
    const auto rows = row_normals(spec, t, partners, phi);
    const bool outer = spec.root_surface == RootSurface::outer;
    const double rho = outer ? spec.target.outer_radius : spec.target.inner_radius();
    for (std::size_t i = 0; i < t.phi.size(); ++i) {
      const double z = outer ? t.z_outer[i] : t.z_inner[i] - t.gap[i];
      const Vector3d root{rho * phi.cosine[i], rho * phi.sine[i], z};
      EXPECT_EQ(rows.partner.at(i), partners[t.cutter[i]].normal(root)) << i;
    }
  }
}

// The angle between two unit vectors by its cosine, and the line of B against the plane of the
// curve's tangent and the bevel's line, both as vectors.
TEST(TableArrays, AnglesAndPlanesAreThoseOfVectors) {
  std::size_t seen = 0;
  for (const auto& [spec, t, partners] : cuts()) {
    const Directions phi(t.phi), tau(t.tau), b(t.b_raw);
    const auto rows = row_normals(spec, t, partners, phi);
    const auto angle = dihedrals(rows, spec.dihedral);
    const auto planes = plane_errors(rows, spec.dihedral, tau, b);
    const double side = spec.dihedral == Dihedral::weld_side ? -1.0 : 1.0;
    for (std::size_t i = 0; i < t.phi.size(); ++i) {
      const Vector3d tube = radial(t.phi[i]), partner = rows.partner.at(i);
      EXPECT_NEAR(std::cos(angle[i]), side * tube.dot(partner), 1e-12) << i;
      const Vector3d along = tube.cross(partner);
      if (along.norm() < 1e-3) continue;
      ++seen;
      const Vector3d tangent = along.normalized();
      Vector3d across = tangent.cross(tube);
      if (across.z() < 0.0) across = -across;
      const Vector3d out = -side * tube;
      const Vector3d bevel = std::cos(t.tau[i]) * out + std::sin(t.tau[i]) * across;
      const Vector3d torch = std::cos(t.b_raw[i]) * out + std::sin(t.b_raw[i]) * Vector3d::UnitZ();
      const double off = std::abs(torch.dot(tangent.cross(bevel).normalized()));
      EXPECT_NEAR(planes[i], off - rows.noise[i] / along.norm(), 1e-10) << i;
    }
  }
  EXPECT_GT(seen, 5000U);
}

TEST(TableArrays, ATubesNormalOnAndOffItsAxis) {
  const std::vector<joint::Partner> along_x{
      joint::AxisTube{.radius = 3.0, .axis = {.point = {0, 0, 0}, .direction = {1.0, 0.0, 0.0}}}};
  const joint::Solid tube(joint::resolve(along_x).value().front());
  joint::PointArrays at(3), normal(3);
  at.set(0, {7.0, 5.0, 0.0});
  at.set(1, {-2.0, 0.0, -1e-3});
  at.set(2, {4.0, 0.0, 0.0});
  joint::normals(tube, at, 0, 3, normal);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(normal.at(i), tube.normal(at.at(i))) << i;
  EXPECT_NEAR(normal.at(0).y(), 1.0, 1e-15);
  EXPECT_NEAR(normal.at(1).z(), -1.0, 1e-15);
}

TEST(TableArrays, CountsNonFiniteNumbers) {
  const double kInfinite = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < 40; ++n) {
    std::vector<double> values(n, -0.0);
    for (std::size_t i = 0; i < n; ++i)
      values[i] = i % 3 == 0 ? std::numeric_limits<double>::max() : -1e-310;
    EXPECT_EQ(not_finite(values), 0U);
    for (std::size_t i = 0; i < n; ++i)
      for (const double bad : {kInfinite, -kInfinite, std::nan(""), -std::nan("1")}) {
        auto one = values;
        one[i] = bad;
        EXPECT_EQ(not_finite(one), 1U) << i << " of " << n;
      }
  }
}

// The wall between rows is straight: at a fraction of 0 its edges are the row's, at 1 the next
// one's, and between the edges, and the rows, it lies at the requested fraction.
TEST(TableArrays, PlacesBetweenRowsLieOnTheWall) {
  for (const auto& [spec, t, partners] : cuts()) {
    const auto n = t.phi.size();
    const BetweenRows wall(spec, t);
    const double inner = spec.target.inner_radius(), outer = spec.target.outer_radius;
    const double edge = t.z_face.empty() ? inner : inner + spec.root_face;
    const auto& z_edge = t.z_face.empty() ? t.z_inner : t.z_face;
    for (const double share : {0.0, 0.25, 1.0}) {
      const std::vector<double> shares(n, share);
      const auto phases = wall.phases(shares);
      const Directions phi(phases);
      const auto at = [&](double radius) {
        return wall.places(shares, phi, std::vector<double>(n, radius));
      };
      const auto low = at(inner), land = at(edge), high = at(outer),
                 middle = at(0.5 * (edge + outer));
      for (std::size_t i = 0; i < n; ++i) {
        const auto j = (i + 1) % n;
        const auto between = [&](const std::vector<double>& v, double turn = 0.0) {
          return (1.0 - share) * v[i] + share * (v[j] + (j == 0 ? turn : 0.0));
        };
        EXPECT_DOUBLE_EQ(phases[i], between(t.phi, kTwoPi));
        EXPECT_NEAR(low.z[i], between(t.z_inner), 1e-12);
        EXPECT_NEAR(land.z[i], between(z_edge), 1e-12);
        EXPECT_NEAR(high.z[i], between(t.z_outer), 1e-12);
        EXPECT_NEAR(middle.z[i], 0.5 * (land.z[i] + high.z[i]), 1e-12);
        EXPECT_NEAR((middle.at(i) - 0.5 * (edge + outer) * radial(phases[i])).head<2>().norm(), 0.0,
                    1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace tubecut::bevel
