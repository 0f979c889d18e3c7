#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"
#include "core/bevel/least_area.hpp"
#include "core/bevel/smoothed_area.hpp"
#include "core/bevel/table.hpp"
#include "core/bevel/table_parts.hpp"
#include "core/joint/solid_arrays.hpp"
#include "core/math/search.hpp"

namespace tubecut::bevel {
namespace {

using Eigen::Vector3d;

constexpr double kAngle = 1e-9;        // deg
constexpr double kPlane = 1e-9;        // sine of the angle between line and plane
constexpr double kPenetration = 1e-6;  // mm
constexpr double kAreaExcess = 1e-6;   // of the least area
constexpr double kStated = 1e-3;       // mm
constexpr double kSilhouette = 1e-5;   // axial part of the normal below which angles lose digits

/// One row seen in 3D, from the table's own z and the partner as a solid.
struct Row {
  Vector3d radial, axial{0.0, 0.0, 1.0};
  Vector3d normal;      // of the partner at the root point, outwards
  double axial_normal;  // its z part
  double noise;         // of the normal, from the rounding of z
};

Row row(const TableSpec& spec, const Table& t, const std::vector<joint::Solid>& solids,
        std::size_t i) {
  const bool outer = spec.root_surface == RootSurface::outer;
  const double rho = outer ? spec.target.outer_radius : spec.target.inner_radius();
  const auto turn = elementary::sincos(t.phi[i]);
  Row out;
  out.radial = {turn.cos, turn.sin, 0.0};
  const double z = outer ? t.z_outer[i] : t.z_inner[i] - t.gap[i];
  out.normal = solids.at(t.cutter[i]).normal(rho * out.radial + z * out.axial);
  out.axial_normal = out.normal.z();
  out.noise = 16.0 * std::numeric_limits<double>::epsilon() * (rho + std::abs(z)) / rho;
  return out;
}

/// Angle between two unit vectors by half tangents: full accuracy near 0 and 180 degrees.
double between(const Vector3d& a, const Vector3d& b) {
  return 2.0 * elementary::atan2((a - b).norm(), (a + b).norm());
}

double dihedral_error(const TableSpec& spec, const Table& t, const Row& r, std::size_t i) {
  const bool weld = spec.dihedral == Dihedral::weld_side;
  const double angle = weld ? between(r.radial, -r.normal) : between(r.radial, r.normal);
  return std::max(0.0, std::abs(angle - t.dihedral[i]) - r.noise) * kDegPerRad;
}

/// Sine of the angle by which the torch line of b_raw leaves the plane of tangent and bevel line,
/// beyond rounding: where both surfaces have one tangent plane the curve's tangent loses its
/// digits.
double plane_error(const TableSpec& spec, const Table& t, const Row& r, std::size_t i) {
  const Vector3d along = r.radial.cross(r.normal);
  const Vector3d tangent = along.normalized();
  Vector3d across = tangent.cross(r.radial);  // in the target's tangent plane, across the curve
  if (across.z() < 0.0) across = -across;
  const bool inward = spec.dihedral != Dihedral::weld_side;
  const auto tau = elementary::sincos(t.tau[i]);
  const auto b = elementary::sincos(t.b_raw[i]);
  const Vector3d out = inward ? Vector3d(-r.radial) : r.radial;
  const Vector3d bevel = tau.cos * out + tau.sin * across;
  const Vector3d torch = b.cos * out + b.sin * r.axial;
  return std::max(0.0,
                  std::abs(torch.dot(tangent.cross(bevel).normalized())) - r.noise / along.norm());
}

/// What the smoother was given at row i: at a jump the larger of the two.
double smoother_input(const TableSpec& spec, const Table& t, std::size_t i) {
  const auto of = [&](std::size_t k) {
    double least = t.b_raw[k];
    const bool square = std::holds_alternative<SquareCut>(spec.groove);
    const bool lifted = spec.contact == Contact::automatic;
    if (spec.contact == Contact::inner || (lifted && !square))
      least = std::max(least, t.b_required[k]);
    return lifted ? std::min(least, spec.torch.max.rad()) : least;
  };
  double input = of(i);
  if (i > 0 && t.phi[i - 1] == t.phi[i]) input = std::max(input, of(i - 1));
  if (i + 1 < t.phi.size() && t.phi[i + 1] == t.phi[i]) input = std::max(input, of(i + 1));
  return input;
}

/// The path that was smoothed, nodes of one jump as one: what went in, and b.
struct Path {
  AngleProfile input, smoothed;
};

Path path(const TableSpec& spec, const Table& t, bool along_length) {
  Path out;
  const auto& s = along_length ? t.length : t.developed;
  for (std::size_t i = 0; i < s.size(); ++i) {
    if (i > 0 && s[i] == s[i - 1]) continue;
    out.input.s.push_back(s[i]);
    out.input.b.push_back(smoother_input(spec, t, i));
    out.smoothed.b.push_back(t.b[i]);
  }
  out.input.period = along_length ? t.length_total : t.developed_total;
  out.smoothed.s = out.input.s;
  out.smoothed.period = out.input.period;
  return out;
}

/// Slopes and second differences of b along the path, and by how much its area exceeds the least.
void envelope_checks(const TableSpec& spec, const EnvelopeSmoothing& method, const Table& t,
                     std::vector<Check>& out) {
  const auto p = path(spec, t, method.along == Along::length).smoothed;
  const auto n = p.s.size();
  double slope = 0.0, second = 0.0;
  const auto rise = [&](std::size_t i, double& h) {
    const auto j = (i + 1) % n;
    h = p.s[j] - p.s[i] + (j == 0 ? p.period : 0.0);
    return (p.b[j] - p.b[i]) / h;
  };
  for (std::size_t i = 0; i < n; ++i) {
    double left = 0.0, right = 0.0;
    const double a = rise((i + n - 1) % n, left);
    const double b = rise(i, right);
    slope = std::max(slope, std::abs(b));
    second = std::max(second, std::abs(b - a) / ((left + right) / 2.0));
  }
  const auto most = allowed_steepness(p, method.limits);
  out.push_back({"slope", slope * kDegPerRad, most.slope * kDegPerRad, "deg_per_mm"});
  out.push_back(
      {"second_difference", second * kDegPerRad, most.second * kDegPerRad, "deg_per_mm2"});
  if (const auto area = smoothed_area(spec, t))
    out.push_back({"area_excess", area->excess, kAreaExcess, ""});
}

/// How far the cut of each row stays from the nearest partner, mm; negative: it enters.
std::vector<double> clearances(const TableSpec& spec, const Table& t,
                               const std::vector<joint::Solid>& solids) {
  const auto n = t.phi.size();
  const bool face = !t.z_face.empty();
  std::vector<double> cosine(n), sine(n), least(n, std::numeric_limits<double>::infinity()), one(n);
  elementary::sincos(t.phi, sine, cosine);
  const auto edge = [&](double radius, const std::vector<double>& z) {
    joint::Places out(n);
    for (std::size_t i = 0; i < n; ++i) out.set(i, {radius * cosine[i], radius * sine[i], z[i]});
    return out;
  };
  const double inner = spec.target.inner_radius();
  const auto from = edge(inner, t.z_inner), to = edge(spec.target.outer_radius, t.z_outer);
  const auto corner = face ? edge(inner + spec.root_face, t.z_face) : from;
  const auto see = [&](const joint::Places& a, const joint::Places& b) {
    for (const auto& solid : solids) {
      joint::least_distances(solid, a, b, one);
      for (std::size_t i = 0; i < n; ++i) least[i] = std::min(least[i], one[i]);
    }
  };
  see(corner, to);
  if (face) see(from, corner);
  return least;
}

/// A place of the finished surface: between row i and the next, at a radius.
Vector3d between_rows(const TableSpec& spec, const Table& t, std::size_t i, double share,
                      double radius) {
  const auto j = (i + 1) % t.phi.size();
  const auto mixed = [&](const std::vector<double>& v, double turn) {
    return (1.0 - share) * v[i] + share * (v[j] + turn);
  };
  const double inner = spec.target.inner_radius(), outer = spec.target.outer_radius;
  double low = inner, z_low = mixed(t.z_inner, 0.0);
  double high = outer, z_high = mixed(t.z_outer, 0.0);
  if (!t.z_face.empty()) {
    const double edge = inner + spec.root_face, z_edge = mixed(t.z_face, 0.0);
    (radius < edge ? high : low) = edge;
    (radius < edge ? z_high : z_low) = z_edge;
  }
  const auto turn = elementary::sincos(mixed(t.phi, j == 0 ? kTwoPi : 0.0));
  const double z = z_low + (radius - low) / (high - low) * (z_high - z_low);
  return {radius * turn.cos, radius * turn.sin, z};
}

/// The deepest of a fixed set of places between the rows: half way, at every edge and once between
/// them, and one place more anywhere in the gap, by the golden ratio.
double sampled_depth(const TableSpec& spec, const Table& t, const std::vector<joint::Solid>& solids,
                     const std::stop_token& stop) {
  constexpr double kGolden = 0.6180339887498949;
  const double inner = spec.target.inner_radius(), wall = spec.target.wall;
  std::vector<Vector3d> seen;
  double seed = 0.0;
  const auto next = [&] { return seed = seed + kGolden - std::floor(seed + kGolden); };
  const auto see = [&](std::size_t i, double share, double radius) {
    seen.push_back(between_rows(spec, t, i, share, radius));
  };
  for (std::size_t i = 0; i < t.phi.size() && !stop.stop_requested(); ++i) {
    for (const double radius : {inner, inner + wall * next(), spec.target.outer_radius})
      see(i, 0.5, radius);
    if (!t.z_face.empty()) see(i, 0.5, inner + spec.root_face);
    const double share = next();
    see(i, share, inner + wall * next());
  }
  joint::Places places(seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i) places.set(i, seen[i]);
  std::vector<double> distance(seen.size());
  double deepest = 0.0;
  for (const auto& solid : solids) {
    joint::distances(solid, places, distance);
    for (const double d : distance) deepest = -d > deepest || d != d ? -d : deepest;
  }
  return deepest;
}

/// What the table states of its deepest place, held against that place and against others.
void penetration_checks(const TableSpec& spec, const Table& t,
                        const std::vector<joint::Solid>& solids, double at_rows,
                        std::vector<Check>& out, const std::stop_token& stop) {
  const auto& p = t.penetration;
  const auto turn = elementary::sincos(p.phi);
  const Vector3d at(p.radius * turn.cos, p.radius * turn.sin, p.z);
  const double there = p.solid < solids.size() ? std::max(0.0, -solids[p.solid].distance(at))
                                               : std::numeric_limits<double>::infinity();
  const double found = std::max(at_rows, sampled_depth(spec, t, solids, stop));
  out.push_back(
      {"penetration_stated", std::max(std::abs(there - p.depth), found - p.depth), kStated, "mm"});
  if (promises_no_penetration(spec))
    out.push_back({"penetration_between", std::max(p.depth, found), penetration_limit(spec), "mm"});
}

/// The gaps of an untilted cut: from each edge its gap back along the nearest partner's normal lies
/// that partner's surface, and none nearer.
double gaps_off(const TableSpec& spec, const Table& t, const std::vector<joint::Solid>& solids,
                const std::stop_token& stop) {
  double worst = t.gaps.square.inner.size() == t.phi.size() ? 0.0 : 1.0;
  const auto edge = [&](const std::vector<double>& gaps, double radius,
                        const std::vector<double>& z) {
    for (std::size_t i = 0; i < gaps.size() && !stop.stop_requested(); ++i) {
      const auto turn = elementary::sincos(t.phi[i]);
      const Vector3d at(radius * turn.cos, radius * turn.sin, z[i]);
      double off = std::numeric_limits<double>::infinity();
      for (const auto& solid : solids) {
        const double foot = solid.distance(at - gaps[i] * solid.normal(at));
        off = std::min(off, std::abs(foot));
        worst = std::max(worst, gaps[i] - solid.distance(at));
      }
      worst = off > worst || off != off ? off : worst;
    }
  };
  edge(t.gaps.square.inner, spec.target.inner_radius(), t.z_inner);
  edge(t.gaps.square.outer, spec.target.outer_radius, t.z_outer);
  return worst;
}

}  // namespace

std::optional<SmoothedArea> smoothed_area(const TableSpec& spec, const Table& t) {
  const auto* method = std::get_if<EnvelopeSmoothing>(&spec.smoothing);
  if (method == nullptr || !method->refine) return std::nullopt;
  const auto p = path(spec, t, method->along == Along::length);
  const auto limits = detail::envelope_of(spec, *method);
  const double area = area_above(p.input, p.smoothed.b);
  return SmoothedArea{area, least_area(p.input, limits, t.multipliers, area),
                      area_excess(p.input, limits, t.multipliers, area)};
}

std::vector<Check> verify(const TableSpec& spec, const Table& t, const std::stop_token& stop) {
  std::vector<joint::Solid> solids;
  if (const auto cutters = grown_partners(spec))
    for (const auto& cutter : *cutters) solids.emplace_back(cutter);
  double dihedral = 0.0, plane = 0.0, below = 0.0, beyond = 0.0, deep = 0.0, off = 0.0;
  const bool lifted = spec.contact == Contact::automatic;
  const bool published = spec.dihedral == Dihedral::as_published;
  const bool square = std::holds_alternative<SquareCut>(spec.groove);
  const auto clear_of = clearances(spec, t, solids);
  for (std::size_t i = 0; i < t.b.size() && !stop.stop_requested(); ++i) {
    const auto r = row(spec, t, solids, i);
    const bool steep = std::abs(r.axial_normal) < kSilhouette;
    // Near a silhouette, at the limit of the torch, and with the paper's own gamma there is no such
    // plane.
    const double cut_back =
        std::min(t.b_raw[i] - spec.torch.min.rad(), spec.torch.max.rad() - t.b_raw[i]);
    if (!steep) dihedral = std::max(dihedral, dihedral_error(spec, t, r, i));
    if (!steep && !published && !square && cut_back > 1e-9)
      plane = std::max(plane, plane_error(spec, t, r, i));
    below = std::max(below, (smoother_input(spec, t, i) - t.b[i]) * kDegPerRad);
    beyond = std::max({beyond, (t.b[i] - spec.torch.max.rad()) * kDegPerRad,
                       (spec.torch.min.rad() - t.b[i]) * kDegPerRad});
    const double clear = clear_of[i];
    deep = std::max(deep, -clear);
    off = std::max(off, clear);
  }
  std::vector<Check> out;
  out.push_back({"dihedral", dihedral, kAngle, "deg"});
  out.push_back({"bevel_plane", plane, kPlane, ""});
  const auto* envelope = std::get_if<EnvelopeSmoothing>(&spec.smoothing);
  if (envelope != nullptr) {
    out.push_back({"above_required", below, kAngle, "deg"});
    envelope_checks(spec, *envelope, t, out);
  }
  out.push_back({"torch_range", beyond, kAngle, "deg"});
  if (spec.contact != Contact::none) out.push_back({"penetration", deep, kPenetration, "mm"});
  if (lifted) out.push_back({"touch", off, kPenetration, "mm"});
  if (spec.untilted)
    out.push_back({"gap_map", gaps_off(spec, t, solids, stop), kPenetration, "mm"});
  penetration_checks(spec, t, solids, deep, out, stop);
  for (auto& check : verify_torch_line(beam_cut(spec, t), t.torch_line, stop))
    out.push_back(std::move(check));
  return out;
}

}  // namespace tubecut::bevel
