#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/base/elementary.hpp"
#include "core/base/error.hpp"
#include "core/base/stop.hpp"
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

/// Sines and cosines of many angles, side by side.
struct Turns {
  std::vector<double> sine, cosine;

  explicit Turns(std::span<const double> angles) : sine(angles.size()), cosine(angles.size()) {
    elementary::sincos(angles, sine, cosine);
  }
  [[nodiscard]] elementary::SinCos at(std::size_t i) const {
    return {.sin = sine[i], .cos = cosine[i]};
  }
};

/// One row seen in 3D, from the table's own z and the partner as a solid.
struct Row {
  Vector3d radial, axial{0.0, 0.0, 1.0};
  Vector3d normal;      // of the partner at the root point, outwards
  double axial_normal;  // its z part
  double noise;         // of the normal, from the rounding of z
};

Row row(const TableSpec& spec, const Table& t, const std::vector<joint::Solid>& solids,
        const elementary::SinCos& turn, std::size_t i) {
  const bool outer = spec.root_surface == RootSurface::outer;
  const double rho = outer ? spec.target.outer_radius : spec.target.inner_radius();
  Row out;
  out.radial = {turn.cos, turn.sin, 0.0};
  const double z = outer ? t.z_outer[i] : t.z_inner[i] - t.gap[i];
  out.normal = solids.at(t.cutter[i]).normal(rho * out.radial + z * out.axial);
  out.axial_normal = out.normal.z();
  out.noise = 16.0 * std::numeric_limits<double>::epsilon() * (rho + std::abs(z)) / rho;
  return out;
}

/// Angles between the tube's and the partner's surface at each row by half tangents: full accuracy
/// near 0 and 180 degrees.
std::vector<double> dihedrals(const TableSpec& spec, const std::vector<Row>& rows) {
  const double side = spec.dihedral == Dihedral::weld_side ? -1.0 : 1.0;
  std::vector<double> apart(rows.size()), along(rows.size()), out(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Vector3d normal = side * rows[i].normal;
    apart[i] = (rows[i].radial - normal).norm();
    along[i] = (rows[i].radial + normal).norm();
  }
  elementary::atan2(apart, along, out);
  for (double& angle : out) angle *= 2.0;
  return out;
}

/// Sine of the angle by which the torch line of b_raw leaves the plane of tangent and bevel line,
/// beyond rounding: where both surfaces have one tangent plane the curve's tangent loses its
/// digits.
double plane_error(const TableSpec& spec, const Row& r, const elementary::SinCos& tau,
                   const elementary::SinCos& b) {
  const Vector3d along = r.radial.cross(r.normal);
  const Vector3d tangent = along.normalized();
  Vector3d across = tangent.cross(r.radial);  // in the target's tangent plane, across the curve
  if (across.z() < 0.0) across = -across;
  const bool inward = spec.dihedral != Dihedral::weld_side;
  const Vector3d out = inward ? Vector3d(-r.radial) : r.radial;
  const Vector3d bevel = tau.cos * out + tau.sin * across;
  const Vector3d torch = b.cos * out + b.sin * r.axial;
  return worst_of(
      {0.0, std::abs(torch.dot(tangent.cross(bevel).normalized())) - r.noise / along.norm()});
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
    worsen(slope, std::abs(b));
    worsen(second, std::abs(b - a) / ((left + right) / 2.0));
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
                               const std::vector<joint::Solid>& solids, const Turns& phi,
                               const std::stop_token& stop) {
  const auto n = t.phi.size();
  const bool face = !t.z_face.empty();
  std::vector<double> least(n, std::numeric_limits<double>::infinity()), one(n);
  const auto edge = [&](double radius, const std::vector<double>& z) {
    joint::Places out(n);
    for (std::size_t i = 0; i < n; ++i)
      out.set(i, {radius * phi.cosine[i], radius * phi.sine[i], z[i]});
    return out;
  };
  const double inner = spec.target.inner_radius();
  const auto from = edge(inner, t.z_inner), to = edge(spec.target.outer_radius, t.z_outer);
  const auto corner = face ? edge(inner + spec.root_face, t.z_face) : from;
  const auto see = [&](const joint::Places& a, const joint::Places& b) {
    for (const auto& solid : solids) {
      if (stop.stop_requested()) return;
      joint::least_distances(solid, a, b, one);
      joint::lower(least, one);
    }
  };
  see(corner, to);
  if (face) see(from, corner);
  return least;
}

/// A place of the finished surface: between row i and the next, at a radius.
struct Between {
  std::size_t row, next;
  double share, radius;

  [[nodiscard]] double mixed(const std::vector<double>& v, double turn = 0.0) const {
    return (1.0 - share) * v[row] + share * (v[next] + turn);
  }
  [[nodiscard]] double phi(const Table& t) const { return mixed(t.phi, next == 0 ? kTwoPi : 0.0); }
  [[nodiscard]] double z(const TableSpec& spec, const Table& t) const {
    double low = spec.target.inner_radius(), z_low = mixed(t.z_inner);
    double high = spec.target.outer_radius, z_high = mixed(t.z_outer);
    if (!t.z_face.empty()) {
      const double edge = spec.target.inner_radius() + spec.root_face, z_edge = mixed(t.z_face);
      (radius < edge ? high : low) = edge;
      (radius < edge ? z_high : z_low) = z_edge;
    }
    return z_low + (radius - low) / (high - low) * (z_high - z_low);
  }
};

/// Between each row and the next: half way, at every edge and once between them, and one place more
/// anywhere in the gap, by the golden ratio.
std::vector<Between> samples(const TableSpec& spec, const Table& t) {
  constexpr double kGolden = 0.6180339887498949;
  const double inner = spec.target.inner_radius(), wall = spec.target.wall;
  const bool face = !t.z_face.empty();
  std::vector<Between> out;
  out.reserve((face ? 5 : 4) * t.phi.size());
  double seed = 0.0;
  const auto next = [&] { return seed = seed + kGolden - std::floor(seed + kGolden); };
  for (std::size_t i = 0; i < t.phi.size(); ++i) {
    const auto after = i + 1 < t.phi.size() ? i + 1 : 0;
    for (const double radius : {inner, inner + wall * next(), spec.target.outer_radius})
      out.push_back({i, after, 0.5, radius});
    if (face) out.push_back({i, after, 0.5, inner + spec.root_face});
    const double share = next();
    out.push_back({i, after, share, inner + wall * next()});
  }
  return out;
}

/// The deepest of the samples.
double sampled_depth(const TableSpec& spec, const Table& t, const std::vector<joint::Solid>& solids,
                     const std::stop_token& stop) {
  const auto seen = samples(spec, t);
  const auto n = seen.size();
  if (stop.stop_requested()) return 0.0;
  std::vector<double> phi(n), distance(n);
  for (std::size_t k = 0; k < n; ++k) phi[k] = seen[k].phi(t);
  if (stop.stop_requested()) return 0.0;
  const Turns turn(phi);
  joint::Places places(n);
  for (std::size_t k = 0; k < n && !stops(stop, k); ++k) {
    const double radius = seen[k].radius;
    places.set(k, {radius * turn.cosine[k], radius * turn.sine[k], seen[k].z(spec, t)});
  }
  std::vector<double> least(n, std::numeric_limits<double>::infinity());
  for (const auto& solid : solids) {
    if (stop.stop_requested()) break;
    joint::distances(solid, places, distance);
    joint::lower(least, distance);
  }
  double lowest = 0.0;
  bool numbers = true;
  for (const double d : least) {
    lowest = std::min(lowest, d);
    numbers &= d == d;
  }
  return numbers ? -lowest : std::numeric_limits<double>::quiet_NaN();
}

/// What the table states of its deepest place, held against that place and against others.
void penetration_checks(const TableSpec& spec, const Table& t,
                        const std::vector<joint::Solid>& solids, double at_rows,
                        std::vector<Check>& out, const std::stop_token& stop) {
  const auto& p = t.penetration;
  const auto turn = elementary::sincos(p.phi);
  const Vector3d at(p.radius * turn.cos, p.radius * turn.sin, p.z);
  const double there = p.solid < solids.size() ? worst_of({0.0, -solids[p.solid].distance(at)})
                                               : std::numeric_limits<double>::infinity();
  const double found = worst_of({at_rows, sampled_depth(spec, t, solids, stop)});
  out.push_back({"penetration_stated", worst_of({std::abs(there - p.depth), found - p.depth}),
                 kStated, "mm"});
  if (promises_no_penetration(spec))
    out.push_back(
        {"penetration_between", worst_of({p.depth, found}), penetration_limit(spec), "mm"});
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
        worsen(worst, gaps[i] - solid.distance(at));
      }
      worsen(worst, off);
    }
  };
  edge(t.gaps.square.inner, spec.target.inner_radius(), t.z_inner);
  edge(t.gaps.square.outer, spec.target.outer_radius, t.z_outer);
  return worst;
}

/// How many entries of the columns are no finite number. With one of them no other line of the
/// proof says anything.
std::size_t not_numbers(const Table& t) {
  std::size_t out = 0;
  for (const auto* column : {&t.phi,
                             &t.developed,
                             &t.length,
                             &t.z_inner,
                             &t.z_outer,
                             &t.z_face,
                             &t.b_face,
                             &t.dihedral,
                             &t.groove,
                             &t.tau,
                             &t.gamma,
                             &t.flush,
                             &t.b_raw,
                             &t.b_required,
                             &t.b,
                             &t.gap,
                             &t.beam,
                             &t.torch_inner,
                             &t.torch_outer,
                             &t.gaps.square.inner,
                             &t.gaps.square.outer})
    out += static_cast<std::size_t>(
        std::ranges::count_if(*column, [](double v) { return !std::isfinite(v); }));
  return out;
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
  if (const auto none = not_numbers(t); none > 0)
    return {{"numbers", static_cast<double>(none), 0.0, ""}};
  std::vector<joint::Solid> solids;
  if (const auto cutters = grown_partners(spec))
    for (const auto& cutter : *cutters) solids.emplace_back(cutter);
  double dihedral = 0.0, plane = 0.0, below = 0.0, beyond = 0.0, deep = 0.0, off = 0.0;
  const bool lifted = spec.contact == Contact::automatic;
  const bool published = spec.dihedral == Dihedral::as_published;
  const bool square = std::holds_alternative<SquareCut>(spec.groove);
  const Turns phi(t.phi), tau(t.tau), b_raw(t.b_raw);
  const auto clear_of = clearances(spec, t, solids, phi, stop);
  std::vector<Row> rows;
  rows.reserve(t.b.size());
  for (std::size_t i = 0; i < t.b.size() && !stop.stop_requested(); ++i)
    rows.push_back(row(spec, t, solids, phi.at(i), i));
  const auto angle = dihedrals(spec, rows);
  for (std::size_t i = 0; i < rows.size() && !stop.stop_requested(); ++i) {
    const auto& r = rows[i];
    const bool steep = std::abs(r.axial_normal) < kSilhouette;
    // Near a silhouette, at the limit of the torch, and with the paper's own gamma there is no such
    // plane.
    const double cut_back =
        std::min(t.b_raw[i] - spec.torch.min.rad(), spec.torch.max.rad() - t.b_raw[i]);
    if (!steep) worsen(dihedral, (std::abs(angle[i] - t.dihedral[i]) - r.noise) * kDegPerRad);
    if (!steep && !published && !square && cut_back > 1e-9)
      worsen(plane, plane_error(spec, r, tau.at(i), b_raw.at(i)));
    worsen(below, (smoother_input(spec, t, i) - t.b[i]) * kDegPerRad);
    worsen(beyond, (t.b[i] - spec.torch.max.rad()) * kDegPerRad);
    worsen(beyond, (spec.torch.min.rad() - t.b[i]) * kDegPerRad);
    worsen(deep, -clear_of[i]);
    worsen(off, clear_of[i]);
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
