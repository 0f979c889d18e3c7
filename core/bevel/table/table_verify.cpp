#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/base/elementary.hpp"
#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/bevel/smoothing/least_area.hpp"
#include "core/bevel/smoothing/smoothed_area.hpp"
#include "core/bevel/table/table.hpp"
#include "core/bevel/table/table_arrays.hpp"
#include "core/bevel/table/table_columns.hpp"
#include "core/bevel/table/table_parts.hpp"
#include "core/joint/solid_arrays.hpp"
#include "core/math/cylinder.hpp"
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
constexpr double kTangent = 5e-5;      // sine between the normals: at a corner less than 4.5e-5

/// Returns the smoother's input at each row: at a jump the larger of the two.
std::vector<double> smoother_input(const TableSpec& spec, const Table& t) {
  const auto n = t.phi.size();
  const bool lifted = spec.contact == Contact::automatic;
  const bool square = std::holds_alternative<SquareCut>(spec.groove);
  const bool floored = spec.contact == Contact::inner || (lifted && !square);
  const double most = lifted ? spec.torch.max.rad() : std::numeric_limits<double>::infinity();
  std::vector<double> own(n);
  for (std::size_t i = 0; i < n; ++i)
    own[i] = std::min(floored ? std::max(t.b_raw[i], t.b_required[i]) : t.b_raw[i], most);
  auto out = own;
  for (std::size_t i = 1; i < n; ++i) {
    if (t.phi[i - 1] != t.phi[i]) continue;
    out[i] = std::max(out[i], own[i - 1]);
    out[i - 1] = std::max(out[i - 1], own[i]);
  }
  return out;
}

/// The smoothed path, nodes of one jump as one: the input, and b.
struct Path {
  AngleProfile input, smoothed;
};

Path path(const Table& t, const std::vector<double>& input, Along along) {
  Path out;
  const bool by_length = along == Along::length;
  const auto& s = by_length ? t.length : t.developed;
  for (auto* column : {&out.input.s, &out.input.b, &out.smoothed.b}) column->reserve(s.size());
  for (std::size_t i = 0; i < s.size(); ++i) {
    if (i > 0 && s[i] == s[i - 1]) continue;
    out.input.s.push_back(s[i]);
    out.input.b.push_back(input[i]);
    out.smoothed.b.push_back(t.b[i]);
  }
  out.input.period = by_length ? t.length_total : t.developed_total;
  out.smoothed.s = out.input.s;
  out.smoothed.period = out.input.period;
  return out;
}

SmoothedArea area_of(const TableSpec& spec, const EnvelopeSmoothing& method, const Path& p,
                     const Multipliers& multipliers) {
  const double area = area_above(p.input, p.smoothed.b);
  const double least = least_area(p.input, detail::envelope_of(spec, method), multipliers, area);
  return {area, least, area_excess(p.input, least, area)};
}

/// Checks slopes and second differences of b along the path, and the excess of its area over the
/// minimum.
void envelope_checks(const TableSpec& spec, const EnvelopeSmoothing& method, const Table& t,
                     const std::vector<double>& input, std::vector<Check>& out) {
  const auto both = path(t, input, method.along);
  const auto& p = both.smoothed;
  const auto n = p.s.size();
  double slope = 0.0, second = 0.0, left = 0.0;
  const auto rise = [&](std::size_t i, double& h) {
    const auto j = i + 1 < n ? i + 1 : 0;
    h = p.s[j] - p.s[i] + (j == 0 ? p.period : 0.0);
    return (p.b[j] - p.b[i]) / h;
  };
  double before = rise(n - 1, left);
  for (std::size_t i = 0; i < n; ++i) {
    double right = 0.0;
    const double after = rise(i, right);
    worsen(slope, std::abs(after));
    worsen(second, std::abs(after - before) / ((left + right) / 2.0));
    before = after;
    left = right;
  }
  const auto most = allowed_steepness(p, method.limits);
  out.push_back({"slope", slope * kDegPerRad, most.slope * kDegPerRad, "deg_per_mm"});
  out.push_back(
      {"second_difference", second * kDegPerRad, most.second * kDegPerRad, "deg_per_mm2"});
  if (method.refine)
    out.push_back(
        {"area_excess", area_of(spec, method, both, t.multipliers).excess, kAreaExcess, ""});
}

/// Returns the distance of each row's cut to the nearest partner, mm; negative: it enters.
std::vector<double> clearances(const TableSpec& spec, const Table& t,
                               const std::vector<joint::Solid>& solids, const Directions& phi) {
  const auto n = t.phi.size();
  const bool face = !t.z_face.empty();
  std::vector<double> least(n, std::numeric_limits<double>::infinity()), one(n);
  const auto edge = [&](double radius, const std::vector<double>& z) {
    joint::PointArrays out(n);
    for (std::size_t i = 0; i < n; ++i)
      out.set(i, {radius * phi.cosine[i], radius * phi.sine[i], z[i]});
    return out;
  };
  const double inner = spec.target.inner_radius();
  const auto from = edge(inner, t.z_inner), to = edge(spec.target.outer_radius, t.z_outer);
  const auto corner = face ? edge(inner + spec.root_face, t.z_face) : from;
  const auto see = [&](const joint::PointArrays& a, const joint::PointArrays& b) {
    for (const auto& solid : solids) {
      if (stopped()) return;
      joint::least_distances(solid, a, b, one);
      joint::lower(least, one);
    }
  };
  see(corner, to);
  if (face) see(from, corner);
  return least;
}

/// Returns fractions that cover the interval evenly, by the golden ratio.
std::vector<double> golden_shares(std::size_t n) {
  constexpr double kGolden = 0.6180339887498949;
  std::vector<double> out(n);
  double seed = 0.0;
  for (double& share : out) {
    seed += kGolden;
    if (seed >= 1.0) seed -= 1.0;
    share = seed;
  }
  return out;
}

/// Returns the largest depth at these points between each row and the next: in the middle at every
/// edge and once between them, and one anywhere in the gap.
double sampled_depth(const TableSpec& spec, const Table& t,
                     const std::vector<joint::Solid>& solids) {
  const auto n = t.phi.size();
  const BetweenRows surface(spec, t);
  std::vector<double> least(n, std::numeric_limits<double>::infinity()), distance(n), at(n);
  const auto see = [&](std::span<const double> share, const Directions& phi,
                       std::span<const double> radius) {
    if (stopped()) return;
    const auto places = surface.places(share, phi, radius);
    for (const auto& solid : solids) {
      if (stopped()) return;
      joint::distances(solid, places, distance);
      joint::lower(least, distance);
    }
  };
  const double inner = spec.target.inner_radius(), wall = spec.target.wall;
  const auto golden = golden_shares(3 * n);
  if (stopped()) return 0.0;
  const std::vector<double> half(n, 0.5);
  const Directions middle(surface.phases(half));
  see(half, middle, std::vector<double>(n, inner));
  if (!t.z_face.empty()) see(half, middle, std::vector<double>(n, inner + spec.root_face));
  see(half, middle, std::vector<double>(n, spec.target.outer_radius));
  for (std::size_t i = 0; i < n; ++i) at[i] = inner + wall * golden[3 * i];
  see(half, middle, at);
  std::vector<double> share(n);
  for (std::size_t i = 0; i < n; ++i) {
    share[i] = golden[3 * i + 1];
    at[i] = inner + wall * golden[3 * i + 2];
  }
  see(share, Directions(surface.phases(share)), at);
  double lowest = 0.0;
  bool numbers = true;
  for (const double d : least) {
    lowest = std::min(lowest, d);
    numbers &= d == d;
  }
  return numbers ? -lowest : std::numeric_limits<double>::quiet_NaN();
}

/// Checks the table's stated deepest point, at that point and at others.
void penetration_checks(const TableSpec& spec, const Table& t,
                        const std::vector<joint::Solid>& solids, double at_rows,
                        std::vector<Check>& out) {
  const auto& p = t.penetration;
  const auto at = math::cylinder_point(p.radius, p.phi, p.z);
  const double there = p.solid < solids.size() ? worst_of({0.0, -solids[p.solid].distance(at)})
                                               : std::numeric_limits<double>::infinity();
  const double found = worst_of({at_rows, sampled_depth(spec, t, solids)});
  out.push_back({"penetration_stated", worst_of({std::abs(there - p.depth), found - p.depth}),
                 kStated, "mm"});
  if (promises_no_penetration(spec))
    out.push_back(
        {"penetration_between", worst_of({p.depth, found}), penetration_limit(spec), "mm"});
}

/// Checks the gaps of an untilted cut: at the distance of its gap from each edge, back along the
/// nearest partner's normal, is that partner's surface, and no other is nearer.
double gaps_off(const TableSpec& spec, const Table& t, const std::vector<joint::Solid>& solids) {
  double worst = t.gaps.square.inner.size() == t.phi.size() ? 0.0 : 1.0;
  const auto edge = [&](const std::vector<double>& gaps, double radius,
                        const std::vector<double>& z) {
    for (std::size_t i = 0; i < gaps.size() && !stopped(); ++i) {
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

/// Returns true if tube and partner have nearly one tangent plane at the row. This also happens at
/// a tube's own corner, which turns within a few micrometres: the angles are those of one of its
/// sides.
bool tangent(const RowNormals& rows, std::size_t i) {
  const auto& n = rows.partner;
  const double across = rows.phi.cosine[i] * n.y[i] - rows.phi.sine[i] * n.x[i];
  return n.z[i] * n.z[i] + across * across < kTangent * kTangent;
}

/// Root gaps of zones, as the increment of each next zone: of a row by its dihedral, deg.
class GapRamps {
 public:
  explicit GapRamps(const ZonedGroove& zoned)
      : zones_(zoned.zones), half_(zoned.overlap.deg() / 2) {
    std::ranges::stable_sort(zones_, {}, [](const GrooveZone& z) { return z.dihedral_to.deg(); });
  }
  [[nodiscard]] double least() const {
    double out = *zones_.front().root_gap;
    for (const auto& zone : zones_) out = std::min(out, *zone.root_gap);
    return out;
  }
  [[nodiscard]] double at(double deg) const {
    double out = *zones_.front().root_gap;
    for (std::size_t k = 1; k < zones_.size(); ++k) {
      const double from = zones_[k].dihedral_from.deg() - half_;
      const double to = zones_[k - 1].dihedral_to.deg() + half_;
      const double share = deg >= to ? 1.0 : deg <= from ? 0.0 : (deg - from) / (to - from);
      out += share * (*zones_[k].root_gap - *zones_[k - 1].root_gap);
    }
    return out;
  }

 private:
  std::vector<GrooveZone> zones_;
  double half_;
};

/// Returns the error of the root's gap against its zones': the distance from it to the only
/// partner.
double gaps_missed(const TableSpec& spec, const Table& t, const std::vector<joint::Solid>& solids,
                   const GapRamps& ramps) {
  double worst = solids.size() == 1 ? 0.0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < t.phi.size() && solids.size() == 1; ++i) {
    const auto at = math::cylinder_point(spec.target.inner_radius(), t.phi[i], t.z_inner[i]);
    const double there = solids.front().distance(at) + ramps.least();
    const double off = there - ramps.at(t.dihedral[i] * kDegPerRad);
    // If lifted, the root may open further.
    worsen(worst, spec.contact == Contact::automatic ? -off : std::abs(off));
  }
  return worst;
}

/// Returns how many entries of the columns are not finite, except rates, which may be absent. If
/// there is one, no other check has a meaning.
std::size_t not_numbers(const Table& t) {
  std::size_t out = 0;
  const auto count = [&](ColumnKind kind, const std::vector<double>& column) {
    if (kind != ColumnKind::rate) out += not_finite(column);
  };
  each_column(count, t);
  return out;
}

}  // namespace

std::optional<SmoothedArea> smoothed_area(const TableSpec& spec, const Table& t) {
  const auto* method = std::get_if<EnvelopeSmoothing>(&spec.smoothing);
  if (method == nullptr || !method->refine) return std::nullopt;
  return area_of(spec, *method, path(t, smoother_input(spec, t), method->along), t.multipliers);
}

std::vector<Check> verify(const TableSpec& spec, const Table& t) {
  if (const auto none = not_numbers(t); none > 0)
    return {{"numbers", static_cast<double>(none), 0.0, ""}};
  std::vector<joint::Solid> solids;
  if (const auto cutters = grown_partners(spec))
    for (const auto& cutter : *cutters) solids.emplace_back(cutter);
  double dihedral = 0.0, plane = 0.0, below = 0.0, beyond = 0.0, deep = 0.0, off = 0.0;
  const bool lifted = spec.contact == Contact::automatic;
  const bool published = spec.dihedral == Dihedral::as_published;
  const bool square = std::holds_alternative<SquareCut>(spec.groove);
  const double low = spec.torch.min.rad(), high = spec.torch.max.rad();
  const Directions phi(t.phi);
  const auto clear_of = clearances(spec, t, solids, phi);
  if (stopped()) return {};
  const auto rows = row_normals(spec, t, solids, phi);
  const auto angle = dihedrals(rows, spec.dihedral);
  if (stopped()) return {};
  const auto planes = plane_errors(rows, spec.dihedral, Directions(t.tau), Directions(t.b_raw));
  const auto input = smoother_input(spec, t);
  const auto* zoned = std::get_if<ZonedGroove>(&spec.groove);
  std::optional<GapRamps> ramps;
  if (zoned != nullptr && zoned->has_root_gaps()) ramps.emplace(*zoned);
  for (std::size_t i = 0; i < t.b.size() && !stops(i); ++i) {
    const bool steep = std::abs(rows.partner.z[i]) < kSilhouette;
    // Near a silhouette, at a corner, at the limit of the torch, and with the paper's own gamma
    // there is no such plane.
    const double cut_back = std::min(t.b_raw[i] - low, high - t.b_raw[i]);
    if (!steep) worsen(dihedral, (std::abs(angle[i] - t.dihedral[i]) - rows.noise[i]) * kDegPerRad);
    const bool plain = !steep && !tangent(rows, i);
    if (plain && !published && !square && cut_back > 1e-9) worsen(plane, planes[i]);
    worsen(below, (input[i] - t.b[i]) * kDegPerRad);
    worsen(beyond, (t.b[i] - high) * kDegPerRad);
    worsen(beyond, (low - t.b[i]) * kDegPerRad);
    const double more = ramps ? ramps->at(t.dihedral[i] * kDegPerRad) - ramps->least() : 0.0;
    worsen(deep, more - clear_of[i]);
    worsen(off, clear_of[i] - more);
  }
  std::vector<Check> out;
  out.push_back({"dihedral", dihedral, kAngle, "deg"});
  out.push_back({"bevel_plane", plane, kPlane, ""});
  const auto* envelope = std::get_if<EnvelopeSmoothing>(&spec.smoothing);
  if (envelope != nullptr) {
    out.push_back({"above_required", below, kAngle, "deg"});
    envelope_checks(spec, *envelope, t, input, out);
  }
  out.push_back({"torch_range", beyond, kAngle, "deg"});
  if (spec.contact != Contact::none) out.push_back({"penetration", deep, kPenetration, "mm"});
  if (lifted) out.push_back({"touch", off, kPenetration, "mm"});
  if (ramps) out.push_back({"zone_gap", gaps_missed(spec, t, solids, *ramps), kPenetration, "mm"});
  if (spec.untilted) out.push_back({"gap_map", gaps_off(spec, t, solids), kPenetration, "mm"});
  penetration_checks(spec, t, solids, deep, out);
  for (auto& check : verify_torch_line(beam_cut(spec, t), t.torch_line))
    out.push_back(std::move(check));
  return out;
}

}  // namespace tubecut::bevel
