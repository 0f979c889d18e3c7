#include "api/formats/mesh/cut_solid.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "api/formats/mesh/binary.hpp"
#include "api/formats/mesh/gltf.hpp"
#include "api/formats/text.hpp"
#include "api/stop.hpp"
#include "api/verdict.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

constexpr std::size_t kStlHeader = 80;           // bytes
constexpr double kSteepest = 89.5 * kRadPerDeg;  // drawn of an unsmoothed cut

/// The wall's section at one phi: (radius, z) along the cut.
struct Row {
  double phi = 0.0;
  std::vector<Eigen::Vector2d> cut;
};

/// B before smoothing, of a table of either kind.
template <class Table>
double unsmoothed(const bevel::TableSpec& spec, const Table& t, std::size_t i) {
  const bool raised =
      spec.contact == bevel::Contact::inner || spec.contact == bevel::Contact::automatic;
  const double b = raised ? std::max(t.b_raw[i], t.b_required[i]) : t.b_raw[i];
  return std::clamp(b, -kSteepest, kSteepest);
}

Row row(const bevel::TableSpec& spec, const bevel::Table& t, std::size_t i, Smoothed which) {
  const double inner = spec.target.inner_radius(), outer = spec.target.outer_radius;
  Row out{.phi = t.phi[i], .cut = {{inner, t.z_inner[i]}}};
  double from = inner, z = t.z_inner[i];
  if (!t.z_face.empty()) {
    from += spec.root_face;
    z = t.z_face[i];
    out.cut.emplace_back(from, z);
  }
  if (which == Smoothed::after) {
    out.cut.emplace_back(outer, t.z_outer[i]);
    return out;
  }
  const double rise = (outer - from) * elementary::tan(unsmoothed(spec, t, i));
  if (spec.root_surface == bevel::RootSurface::inner) {
    out.cut.emplace_back(outer, z + rise);
  } else {
    out.cut.emplace_back(outer, t.z_outer[i]);
    out.cut.front().y() = t.z_outer[i] + (t.inward ? rise : -rise);
  }
  return out;
}

double highest(const bevel::TableSpec& spec, const bevel::Table& t) {
  double z = t.z_inner.front();
  for (const auto which : {Smoothed::before, Smoothed::after})
    for (std::size_t i = 0; i < t.phi.size(); ++i) {
      ask();
      for (const auto& p : row(spec, t, i, which).cut) z = std::max(z, p.y());
    }
  return z;
}

std::vector<Eigen::Vector3d> ring(const Row& r, double inner, double outer, double far) {
  const auto [sin, cos] = elementary::sincos(r.phi);
  std::vector<Eigen::Vector3d> out;
  for (const auto& p : r.cut) out.emplace_back(p.x() * cos, p.x() * sin, p.y());
  out.emplace_back(outer * cos, outer * sin, far);
  out.emplace_back(inner * cos, inner * sin, far);
  return out;
}

Row between(const Row& a, const Row& b, double share) {
  Row out{.phi = a.phi + share * (b.phi - a.phi), .cut = a.cut};
  for (std::size_t k = 0; k < a.cut.size(); ++k) out.cut[k] += share * (b.cut[k] - a.cut[k]);
  return out;
}

using Point = std::array<float, 3>;

Eigen::Vector3f normal(const Point& a, const Point& b, const Point& c) {
  const Eigen::Map<const Eigen::Vector3f> pa(a.data()), pb(b.data()), pc(c.data());
  const Eigen::Vector3d n = (pb - pa).cast<double>().cross((pc - pa).cast<double>());
  return n.norm() > 0.0 ? Eigen::Vector3f((n / n.norm()).cast<float>()) : Eigen::Vector3f::Zero();
}

/// Returns 80 bytes; text that does not fit is in the answer's header Tubecut-Verdict.
std::string stl_header(const Caption& caption) {
  std::string out = "tubecut unit mm, facets within " + fixed(kFacetError) + " mm, verdict " +
                    verdict_in_short(caption.verdict);
  if (caption.verdict.reasons.empty()) out += ", input " + caption.input_sha256.substr(0, 16);
  if (out.size() > kStlHeader) out.replace(kStlHeader - 3, out.npos, "...");
  out.resize(kStlHeader, ' ');
  return out;
}

Mesh coloured(std::string name, const CutSolid& solid, const std::vector<double>& hue) {
  const Eigen::Vector3f steel(0.62F, 0.65F, 0.68F);
  Mesh out{.name = std::move(name), .positions = {}, .colors = {}, .indices = {}};
  const auto n = solid.rings.size(), across = solid.rings.front().size();
  Pace pace;
  const auto strip = [&](std::size_t from, std::size_t to, bool cut) {
    const auto base = static_cast<std::uint32_t>(out.positions.size());
    for (std::size_t i = 0; i < n; ++i)
      for (const auto k : {from, to}) {
        pace.tick();
        out.positions.push_back(solid.rings[i][k]);
        out.colors.push_back(cut ? diverging(hue[i]) : steel);
      }
    for (const auto index : band_triangles(n, 2)) {
      pace.tick();
      out.indices.push_back(base + index);
    }
  };
  out.reserve(2 * n * across);
  out.indices.reserve(6 * n * across);
  for (std::size_t k = 0; k < across; ++k) strip(k, (k + 1) % across, k + 1 < solid.cut_points);
  return out;
}

/// Returns B of a ring from its own points, as a fraction of 60 deg.
std::vector<double> hues(const CutSolid& solid) {
  std::vector<double> out;
  Pace pace;
  for (const auto& r : solid.rings) {
    pace.tick();
    const auto &a = r[solid.cut_points - 2], &b = r[solid.cut_points - 1];
    const double across = b.head<2>().norm() - a.head<2>().norm();
    out.push_back(elementary::atan2(b.z() - a.z(), across) / (60.0 * kRadPerDeg));
  }
  return out;
}

}  // namespace

double far_end(const bevel::TableSpec& spec, const bevel::Table& table) {
  const double top = highest(spec, table), far = top + spec.target.outer_radius;
  const bool ends = spec.target.length && *spec.target.length > top + 1e-3;
  return ends ? std::min(far, *spec.target.length) : far;
}

CutSolid cut_solid(const bevel::TableSpec& spec, const bevel::Table& t, Smoothed which) {
  const double inner = spec.target.inner_radius(), outer = spec.target.outer_radius;
  CutSolid out{.rings = {}, .cut_points = t.z_face.empty() ? 2U : 3U, .far = far_end(spec, t)};
  const double step = 2.0 * elementary::acos(1.0 - std::min(1.0, kFacetError / outer));
  const auto n = t.phi.size();
  for (std::size_t i = 0; i < n; ++i) {
    ask();
    const auto a = row(spec, t, i, which);
    auto b = row(spec, t, (i + 1) % n, which);
    if (i + 1 == n) b.phi += kTwoPi;
    const int parts = std::max(1, static_cast<int>(std::ceil((b.phi - a.phi) / step)));
    for (int k = 0; k < parts; ++k)
      out.rings.push_back(
          ring(between(a, b, static_cast<double>(k) / parts), inner, outer, out.far));
  }
  return out;
}

namespace {

/// A ring of a section: the place outside, and z along the cut at depths across the wall.
struct SectionRow {
  double s = 0.0, z_inner = 0.0, z_outer = 0.0;
  std::optional<double> z_face;
};

SectionRow section_row(const bevel::TableSpec& spec, const bevel::SectionTable& t, std::size_t i,
                       Smoothed which) {
  SectionRow out{.s = t.at[i].s, .z_inner = t.z_inner[i], .z_outer = t.z_outer[i]};
  if (!t.z_face.empty()) out.z_face = t.z_face[i];
  if (which == Smoothed::after) return out;
  const double land = out.z_face ? spec.root_face : 0.0;
  const double rise = (t.wall[i] - land) * elementary::tan(unsmoothed(spec, t, i));
  if (spec.root_surface == bevel::RootSurface::inner)
    out.z_outer = out.z_face.value_or(out.z_inner) + rise;
  else
    out.z_inner = out.z_outer - rise;
  return out;
}

SectionRow between(const SectionRow& a, const SectionRow& b, double share) {
  const auto mid = [&](double x, double y) { return x + share * (y - x); };
  SectionRow out{mid(a.s, b.s), mid(a.z_inner, b.z_inner), mid(a.z_outer, b.z_outer), {}};
  if (a.z_face) out.z_face = mid(*a.z_face, *b.z_face);
  return out;
}

std::vector<Eigen::Vector3d> ring(const section::Wall& wall, const bevel::TableSpec& spec,
                                  const SectionRow& row, double far) {
  const auto at = wall.outer().at(row.s);
  const auto across = wall.across(at);
  const auto point = [](const Eigen::Vector2d& p, double z) {
    return Eigen::Vector3d(p.x(), p.y(), z);
  };
  std::vector<Eigen::Vector3d> out{point(across.bore.point, row.z_inner)};
  if (row.z_face)
    out.push_back(point(at.point - (across.wall - spec.root_face) * at.normal, *row.z_face));
  out.push_back(point(at.point, row.z_outer));
  out.push_back(point(at.point, far));
  out.push_back(point(across.bore.point, far));
  return out;
}

}  // namespace

CutSolid cut_solid(const section::Section& section, const bevel::TableSpec& spec,
                   const bevel::SectionTable& t, Smoothed which) {
  const section::Wall wall(section);
  double top = t.z_inner.front();
  for (const auto one : {Smoothed::before, Smoothed::after})
    for (std::size_t i = 0; i < t.at.size(); ++i) {
      const auto r = section_row(spec, t, i, one);
      top = std::max({top, r.z_inner, r.z_outer, r.z_face.value_or(top)});
    }
  const double far = top + 0.5 * std::max(section.height, section.width);
  const bool ends = spec.target.length && *spec.target.length > top + 1e-3;
  CutSolid out{.rings = {},
               .cut_points = t.z_face.empty() ? 2U : 3U,
               .far = ends ? std::min(far, *spec.target.length) : far};
  for (std::size_t i = 0; i < t.at.size(); ++i) {
    ask();
    const auto next = (i + 1) % t.at.size();
    const auto a = section_row(spec, t, i, which);
    auto b = section_row(spec, t, next, which);
    if (next == 0) b.s += t.girth;
    const double bent = wall.outer().at(0.5 * (a.s + b.s)).curvature;
    const double step = 2.0 * elementary::acos(1.0 - std::min(1.0, kFacetError * bent));
    const int parts =
        bent > 0.0 ? std::max(1, static_cast<int>(std::ceil((b.s - a.s) * bent / step))) : 1;
    for (int k = 0; k < parts; ++k)
      out.rings.push_back(ring(wall, spec, between(a, b, static_cast<double>(k) / parts), out.far));
  }
  return out;
}

TriangleMesh closed_mesh(const CutSolid& solid) {
  TriangleMesh out;
  std::map<Point, std::uint32_t> known;
  const auto n = solid.rings.size(), across = solid.rings.front().size();
  const auto index = [&](std::size_t i, std::size_t k) {
    const auto& p = solid.rings[i % n][k % across];
    const Point at{static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
    const auto [found, fresh] =
        known.try_emplace(at, static_cast<std::uint32_t>(out.points.size()));
    if (fresh) out.points.push_back(at);
    return found->second;
  };
  const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) out.triangles.push_back({a, b, c});
  };
  for (std::size_t i = 0; i < n; ++i) {
    ask();
    for (std::size_t k = 0; k < across; ++k) {
      const auto a = index(i, k), b = index(i + 1, k), c = index(i, k + 1), d = index(i + 1, k + 1);
      triangle(a, b, c);
      triangle(b, d, c);
    }
  }
  return out;
}

std::string print_cut_stl(const bevel::TableSpec& spec, const bevel::Table& table,
                          const Caption& caption) {
  const auto which = caption.view == "before" ? Smoothed::before : Smoothed::after;
  return print_stl(cut_solid(spec, table, which), caption);
}

std::string print_stl(const CutSolid& solid, const Caption& caption) {
  const auto mesh = closed_mesh(solid);
  std::string out = stl_header(caption);
  append_bytes(out, static_cast<std::uint32_t>(mesh.triangles.size()));
  out.reserve(84 + 50 * mesh.triangles.size());
  Pace pace;
  for (const auto& t : mesh.triangles) {
    pace.tick();
    const auto& [a, b, c] = t;
    const auto n = normal(mesh.points[a], mesh.points[b], mesh.points[c]);
    for (int k = 0; k < 3; ++k) append_bytes(out, n[k]);
    for (const auto i : t)
      for (const float v : mesh.points[i]) append_bytes(out, v);
    append_bytes(out, std::uint16_t{0});
  }
  return out;
}

std::string print_cut_gltf(const bevel::TableSpec& spec, const bevel::Table& table,
                           const Caption& caption) {
  const auto of = [&](Smoothed which) {
    auto solid = cut_solid(spec, table, which);
    auto shares = hues(solid);
    return ColouredSolid{std::move(solid), std::move(shares)};
  };
  return print_gltf(of(Smoothed::before), of(Smoothed::after), caption);
}

std::string print_gltf(const ColouredSolid& before, const ColouredSolid& after,
                       const Caption& caption) {
  std::vector<Mesh> meshes;
  for (const auto& [name, one] : {std::pair{"before", &before}, std::pair{"after", &after}})
    meshes.push_back(coloured(name, one->solid, one->b_shares));
  return print_gltf(meshes, caption);
}

}  // namespace tubecut::api
