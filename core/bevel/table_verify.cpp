#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "core/base/elementary.hpp"
#include "core/bevel/table.hpp"
#include "core/joint/solid.hpp"

namespace tubecut::bevel {
namespace {

using Eigen::Vector3d;

constexpr double kAngle = 1e-9;        // deg
constexpr double kPlane = 1e-9;        // sine of the angle between line and plane
constexpr double kPenetration = 1e-6;  // mm
constexpr int kAcross = 5;             // points across the wall
constexpr double kSilhouette = 1e-5;   // axial part of the normal below which angles lose digits

/// One row seen in 3D, from the table's own z and the partner as a solid.
struct Row {
  Vector3d radial, axial{0.0, 0.0, 1.0};
  Vector3d normal;      // of the partner at the root point, outwards
  double axial_normal;  // its z part
};

Row row(const TableSpec& spec, const Table& t, const std::vector<joint::Solid>& solids,
        std::size_t i) {
  const bool outer = spec.root_surface == RootSurface::outer;
  const double rho = outer ? spec.target.outer_radius : spec.target.inner_radius();
  const auto turn = elementary::sincos(t.phi[i]);
  Row out;
  out.radial = {turn.cos, turn.sin, 0.0};
  const double z = outer ? t.z_outer[i] : t.z_inner[i];
  out.normal = solids.at(t.cutter[i]).normal(rho * out.radial + z * out.axial);
  out.axial_normal = out.normal.z();
  return out;
}

/// Angle between two unit vectors by half tangents: full accuracy near 0 and 180 degrees.
double between(const Vector3d& a, const Vector3d& b) {
  return 2.0 * elementary::atan2((a - b).norm(), (a + b).norm());
}

double dihedral_error(const TableSpec& spec, const Table& t, const Row& r, std::size_t i) {
  const bool weld = spec.dihedral == Dihedral::weld_side;
  const double angle = weld ? between(r.radial, -r.normal) : between(r.radial, r.normal);
  return std::abs(angle - t.dihedral[i]) * kDegPerRad;
}

/// Sine of the angle by which the torch line of b_raw leaves the plane of tangent and bevel line.
double plane_error(const TableSpec& spec, const Table& t, const Row& r, std::size_t i) {
  const Vector3d tangent = r.radial.cross(r.normal).normalized();
  Vector3d across = tangent.cross(r.radial);  // in the target's tangent plane, across the curve
  if (across.z() < 0.0) across = -across;
  const bool inward = spec.dihedral != Dihedral::weld_side;
  const auto tau = elementary::sincos(t.tau[i]);
  const auto b = elementary::sincos(t.b_raw[i]);
  const Vector3d out = inward ? Vector3d(-r.radial) : r.radial;
  const Vector3d bevel = tau.cos * out + tau.sin * across;
  const Vector3d torch = b.cos * out + b.sin * r.axial;
  return std::abs(torch.dot(tangent.cross(bevel).normalized()));
}

/// Slopes and second differences of b along the path that was smoothed, nodes of one jump as one.
struct Path {
  std::vector<double> s, b;
  double period;
};

Path path(const Table& t, bool along_length) {
  Path out{.s = {}, .b = {}, .period = along_length ? t.length_total : t.developed_total};
  const auto& s = along_length ? t.length : t.developed;
  for (std::size_t i = 0; i < s.size(); ++i) {
    if (i > 0 && s[i] == s[i - 1]) continue;
    out.s.push_back(s[i]);
    out.b.push_back(t.b[i]);
  }
  return out;
}

void steepness_checks(const EnvelopeSmoothing& method, const Table& t, std::vector<Check>& out) {
  const auto p = path(t, method.along == Along::length);
  const auto n = p.s.size();
  double slope = 0.0, second = 0.0, narrow = p.period, highest = 0.0;
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
    narrow = std::min(narrow, right);
    highest = std::max(highest, std::abs(p.b[i]));
  }
  constexpr double kEps = std::numeric_limits<double>::epsilon();
  const auto& limits = method.limits;
  out.push_back({"slope", slope * kDegPerRad,
                 (limits.slope * (1.0 + 1e-9) + 4.0 * kEps * highest / narrow) * kDegPerRad,
                 "deg_per_mm"});
  out.push_back({"second_difference", second * kDegPerRad,
                 (limits.curvature * (1.0 + 1e-6) + 8.0 * kEps * highest / (narrow * narrow)) *
                     kDegPerRad,
                 "deg_per_mm2"});
}

/// How deep the cut of row i enters a partner, mm: points across the wall against each solid.
double penetration(const TableSpec& spec, const Table& t, const std::vector<joint::Solid>& solids,
                   const Row& r, std::size_t i) {
  double worst = 0.0;
  for (int k = 0; k < kAcross; ++k) {
    const double share = static_cast<double>(k) / (kAcross - 1);
    const double rho = spec.target.inner_radius() + share * spec.target.wall;
    const double z = t.z_inner[i] + share * (t.z_outer[i] - t.z_inner[i]);
    const Vector3d at = rho * r.radial + z * r.axial;
    for (const auto& solid : solids) worst = std::max(worst, -solid.distance(at));
  }
  return worst;
}

}  // namespace

std::vector<Check> verify(const TableSpec& spec, const Table& t) {
  std::vector<joint::Solid> solids;
  if (const auto cutters = joint::resolve(spec.partners))
    for (const auto& cutter : *cutters) solids.emplace_back(cutter);
  double dihedral = 0.0, plane = 0.0, below = 0.0, beyond = 0.0, deep = 0.0;
  const bool published = spec.dihedral == Dihedral::as_published;
  const bool square = std::holds_alternative<SquareCut>(spec.groove);
  for (std::size_t i = 0; i < t.b.size(); ++i) {
    const auto r = row(spec, t, solids, i);
    const bool steep = std::abs(r.axial_normal) < kSilhouette;
    // Near a silhouette, at the limit of the torch, and with the paper's own gamma there is no such plane.
    const double cut_back = std::min(t.b_raw[i] - spec.torch.min.rad(),
                                     spec.torch.max.rad() - t.b_raw[i]);
    if (!steep) dihedral = std::max(dihedral, dihedral_error(spec, t, r, i));
    if (!steep && !published && !square && cut_back > 1e-9)
      plane = std::max(plane, plane_error(spec, t, r, i));
    const double least =
        spec.contact == Contact::inner ? std::max(t.b_required[i], t.b_raw[i]) : t.b_raw[i];
    below = std::max(below, (least - t.b[i]) * kDegPerRad);
    beyond = std::max({beyond, (t.b[i] - spec.torch.max.rad()) * kDegPerRad,
                       (spec.torch.min.rad() - t.b[i]) * kDegPerRad});
    if (spec.contact == Contact::inner) deep = std::max(deep, penetration(spec, t, solids, r, i));
  }
  std::vector<Check> out;
  out.push_back({"dihedral", dihedral, kAngle, "deg"});
  out.push_back({"bevel_plane", plane, kPlane, ""});
  const auto* envelope = std::get_if<EnvelopeSmoothing>(&spec.smoothing);
  if (envelope != nullptr) {
    out.push_back({"above_required", below, kAngle, "deg"});
    steepness_checks(*envelope, t, out);
  }
  out.push_back({"torch_range", beyond, kAngle, "deg"});
  if (spec.contact == Contact::inner) out.push_back({"penetration", deep, kPenetration, "mm"});
  return out;
}

}  // namespace tubecut::bevel
