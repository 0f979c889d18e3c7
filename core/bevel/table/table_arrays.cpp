#include "core/bevel/table/table_arrays.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/base/angle.hpp"
#include "core/base/lanes.hpp"

namespace tubecut::bevel {
namespace {

struct Vectors {
  const double *x, *y, *z;
};
Vectors of(const joint::PointArrays& p) { return {p.x.data(), p.y.data(), p.z.data()}; }

struct WallCircle {
  const double *sine, *cosine;
};
WallCircle of(const Directions& t) { return {t.sine.data(), t.cosine.data()}; }

/// Computes the lengths of radial - side normal and of radial + side normal.
TUBECUT_WIDE void half_tangents(WallCircle phi, Vectors normal, double side, double* apart,
                                double* along, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const double x = side * normal.x[i], y = side * normal.y[i], z = side * normal.z[i];
    const double dx = phi.cosine[i] - x, dy = phi.sine[i] - y;
    const double sx = phi.cosine[i] + x, sy = phi.sine[i] + y;
    apart[i] = std::sqrt(dx * dx + dy * dy + z * z);
    along[i] = std::sqrt(sx * sx + sy * sy + z * z);
  }
}

TUBECUT_WIDE void plane_errors_of(WallCircle phi, Vectors normal, const double* noise,
                                  WallCircle tau, WallCircle b, double outwards, double* out,
                                  std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const double c = phi.cosine[i], s = phi.sine[i];
    // The curve's tangent: radial x normal.
    const double ax = s * normal.z[i], ay = -(c * normal.z[i]);
    const double az = c * normal.y[i] - s * normal.x[i];
    const double length = std::sqrt(ax * ax + ay * ay + az * az);
    const double to_unit = length > 0.0 ? length : 1.0;
    const double tx = ax / to_unit, ty = ay / to_unit, tz = az / to_unit;
    // In the target's tangent plane across the curve, upwards: tangent x radial, or its opposite.
    const double rise = tx * s - ty * c, sign = rise < 0.0 ? -1.0 : 1.0;
    const double vx = sign * -(tz * s), vy = sign * (tz * c), vz = sign * rise;
    const double ox = outwards * c, oy = outwards * s;
    const double wx = tau.cosine[i] * ox + tau.sine[i] * vx;
    const double wy = tau.cosine[i] * oy + tau.sine[i] * vy;
    const double wz = tau.sine[i] * vz;
    const double px = ty * wz - tz * wy, py = tz * wx - tx * wz, pz = tx * wy - ty * wx;
    const double across = std::sqrt(px * px + py * py + pz * pz);
    const double unit = across > 0.0 ? across : 1.0;
    const double off =
        b.cosine[i] * ox * (px / unit) + b.cosine[i] * oy * (py / unit) + b.sine[i] * (pz / unit);
    out[i] = std::abs(off) - noise[i] / length;
  }
}

/// Counts in whole lanes: a number is finite if not all bits of its exponent are set.
TUBECUT_WIDE std::uint64_t count_not_finite(const double* values, std::size_t n) {
  constexpr std::uint64_t kExponent = 0x7FF0000000000000U;
  std::uint64_t out = 0;
  for (std::size_t i = 0; i < n; ++i) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, values + i, sizeof bits);
    out += (bits & kExponent) == kExponent ? 1U : 0U;
  }
  return out;
}

/// Interpolates between each entry and the next at the given fractions; `v` has one entry more.
TUBECUT_WIDE void mix(const double* share, const double* v, double* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] = (1.0 - share[i]) * v[i] + share[i] * v[i + 1];
}

struct Radii {
  double inner, edge, outer;
};

TUBECUT_WIDE void heights(Radii at, const double* radius, const double* z_inner,
                          const double* z_edge, const double* z_outer, double* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const bool land = radius[i] < at.edge;
    const double low = land ? at.inner : at.edge, high = land ? at.edge : at.outer;
    const double z_low = land ? z_inner[i] : z_edge[i], z_high = land ? z_edge[i] : z_outer[i];
    out[i] = z_low + (radius[i] - low) / (high - low) * (z_high - z_low);
  }
}

/// Returns the column with its first entry, plus `turn`, appended.
std::vector<double> closed(const std::vector<double>& column, double turn) {
  auto out = column;
  out.push_back(column.front() + turn);
  return out;
}

}  // namespace

RowNormals row_normals(const TableSpec& spec, const Table& t,
                       const std::vector<joint::Solid>& partners, const Directions& phi) {
  const auto n = t.phi.size();
  const bool outer = spec.root_surface == RootSurface::outer;
  const double rho = outer ? spec.target.outer_radius : spec.target.inner_radius();
  RowNormals out{.phi = phi, .partner = joint::PointArrays(n), .noise = std::vector<double>(n)};
  joint::PointArrays root(n);
  for (std::size_t i = 0; i < n; ++i) {
    root.x[i] = rho * phi.cosine[i];
    root.y[i] = rho * phi.sine[i];
    root.z[i] = outer ? t.z_outer[i] : t.z_inner[i] - t.gap[i];
    out.noise[i] =
        16.0 * std::numeric_limits<double>::epsilon() * (rho + std::abs(root.z[i])) / rho;
  }
  for (std::size_t from = 0, to = 0; from < n; from = to) {
    while (to < n && t.cutter[to] == t.cutter[from]) ++to;
    joint::normals(partners.at(t.cutter[from]), root, from, to, out.partner);
  }
  return out;
}

std::vector<double> dihedrals(const RowNormals& rows, Dihedral dihedral) {
  const auto n = rows.noise.size();
  std::vector<double> apart(n), along(n), out(n);
  half_tangents(of(rows.phi), of(rows.partner), dihedral == Dihedral::weld_side ? -1.0 : 1.0,
                apart.data(), along.data(), n);
  elementary::atan2(apart, along, out);
  for (double& angle : out) angle *= 2.0;
  return out;
}

std::vector<double> plane_errors(const RowNormals& rows, Dihedral dihedral, const Directions& tau,
                                 const Directions& b) {
  std::vector<double> out(rows.noise.size());
  plane_errors_of(of(rows.phi), of(rows.partner), rows.noise.data(), of(tau), of(b),
                  dihedral == Dihedral::weld_side ? 1.0 : -1.0, out.data(), out.size());
  return out;
}

std::size_t not_finite(std::span<const double> values) {
  return count_not_finite(values.data(), values.size());
}

BetweenRows::BetweenRows(const TableSpec& spec, const Table& t)
    : inner_(spec.target.inner_radius()),
      edge_(t.z_face.empty() ? inner_ : inner_ + spec.root_face),
      outer_(spec.target.outer_radius),
      phi_(closed(t.phi, kTwoPi)),
      z_inner_(closed(t.z_inner, 0.0)),
      z_edge_(closed(t.z_face.empty() ? t.z_inner : t.z_face, 0.0)),
      z_outer_(closed(t.z_outer, 0.0)) {}

std::vector<double> BetweenRows::phases(std::span<const double> share) const {
  std::vector<double> out(share.size());
  mix(share.data(), phi_.data(), out.data(), share.size());
  return out;
}

joint::PointArrays BetweenRows::places(std::span<const double> share, const Directions& phi,
                                       std::span<const double> radius) const {
  const auto n = share.size();
  joint::PointArrays out(n);
  std::vector<double> low(n), edge(n), high(n);
  mix(share.data(), z_inner_.data(), low.data(), n);
  mix(share.data(), z_edge_.data(), edge.data(), n);
  mix(share.data(), z_outer_.data(), high.data(), n);
  heights({inner_, edge_, outer_}, radius.data(), low.data(), edge.data(), high.data(),
          out.z.data(), n);
  for (std::size_t i = 0; i < n; ++i) {
    out.x[i] = radius[i] * phi.cosine[i];
    out.y[i] = radius[i] * phi.sine[i];
  }
  return out;
}

}  // namespace tubecut::bevel
