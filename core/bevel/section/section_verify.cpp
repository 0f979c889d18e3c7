#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/bevel/beam/beam.hpp"
#include "core/bevel/section/section_beam.hpp"
#include "core/bevel/section/section_rows.hpp"
#include "core/bevel/section/section_surface.hpp"
#include "core/bevel/smoothing/least_area.hpp"
#include "core/joint/section/section_intersection.hpp"
#include "core/joint/solid.hpp"

namespace tubecut::bevel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kOnSection = 1e-9;    // mm
constexpr double kAngle = 1e-6;        // deg
constexpr double kPenetration = 1e-6;  // mm
constexpr double kStated = 1e-3;       // mm
constexpr double kNearLimit = 1e-9;    // rad from the end of the torch range
constexpr double kPlane = 1e-8;        // sine of the angle between line and plane
constexpr double kAreaExcess = 1e-6;   // of the least area
constexpr double kGougeStated = 5e-3;  // mm
constexpr double kSilhouette = 1e-5;   // axial part of the normal below which angles lose digits

/// Checks one table from its own numbers.
class Proof {
 public:
  Proof(const section::Section& section, const TableSpec& spec, const SectionTable& table)
      : section_(section), wall_(section), spec_(spec), t_(table), surface_(wall_, spec, table) {
    if (const auto cutters = grown_partners(spec))
      for (const auto& cutter : *cutters) solids_.emplace_back(cutter);
  }

  std::vector<Check> checks() {
    std::vector<Check> out;
    double on = 0.0, dihedral = 0.0, plane = 0.0, below = 0.0, beyond = 0.0, deep = 0.0;
    double touch = 0.0;
    for (std::size_t i = 0; i < t_.at.size() && !stopped(); ++i) {
      worsen(on, off_outlines(i));
      worsen(dihedral, off_dihedral(i));
      worsen(plane, off_plane(i));
      worsen(below, (input(i) - t_.b[i]) * kDegPerRad);
      if (spec_.contact == Contact::inner) worsen(below, (t_.b_required[i] - t_.b[i]) * kDegPerRad);
      worsen(beyond, (t_.b[i] - spec_.torch.max.rad()) * kDegPerRad);
      worsen(beyond, (spec_.torch.min.rad() - t_.b[i]) * kDegPerRad);
      const double clear = clearance(i);
      if (spec_.contact != Contact::none) worsen(deep, -clear);
      if (spec_.contact == Contact::automatic) worsen(touch, touches(i) ? 0.0 : clear);
    }
    out.push_back({"on_section", on, kOnSection, "mm"});
    out.push_back({"dihedral", dihedral, kAngle, "deg"});
    out.push_back({"bevel_plane", plane, kPlane, ""});
    out.push_back({"above_required", below, kAngle, "deg"});
    out.push_back({"torch_range", beyond, kAngle, "deg"});
    if (spec_.contact != Contact::none) out.push_back({"penetration", deep, kPenetration, "mm"});
    if (spec_.contact == Contact::automatic) out.push_back({"touch", touch, kPenetration, "mm"});
    if (spec_.untilted) out.push_back({"gap_map", off_gaps(), kPenetration, "mm"});
    smoothing_checks(out);
    const double found = worst_of({sampled_depth(), t_.penetration.depth});
    out.push_back(
        {"penetration_stated",
         worst_of({std::abs(depth_there() - t_.penetration.depth), found - t_.penetration.depth}),
         kStated, "mm"});
    if (promises_no_penetration(spec_))
      out.push_back(
          {"penetration_between", worst_of({0.0, found}), penetration_limit(spec_), "mm"});
    if (spec_.kerf > 0.0) torch_checks(out);
    return out;
  }

 private:
  /// Both places of a row lie on their outlines, and the wall is the way between them.
  [[nodiscard]] double off_outlines(std::size_t i) const {
    const Vector2d p = t_.at[i].point, q = p - t_.wall[i] * t_.at[i].normal;
    return std::max(std::abs(joint::outline_distance(section_, true, p)),
                    std::abs(joint::outline_distance(section_, false, q)));
  }

  /// Where the row's root lies on its partner: `gap` is the way from there to a lifted cut.
  [[nodiscard]] Vector3d root(std::size_t i) const {
    const Vector2d p = t_.at[i].point;
    if (spec_.root_surface == RootSurface::outer) return {p.x(), p.y(), t_.z_outer[i]};
    const Vector2d q = p - t_.wall[i] * t_.at[i].normal;
    const double lift = spec_.contact == Contact::automatic ? t_.gap[i] : 0.0;
    return {q.x(), q.y(), t_.z_inner[i] - lift};
  }

  /// Returns by how much the dihedral differs from that of the partner's solid.
  [[nodiscard]] double off_dihedral(std::size_t i) const {
    if (t_.corner[i]) return 0.0;
    const auto n = solids_.at(t_.cutter[i]).normal(root(i));
    if (std::abs(n.z()) < kSilhouette) return 0.0;
    const double cosine = -(n.x() * t_.at[i].normal.x() + n.y() * t_.at[i].normal.y());
    const double angle = elementary::acos(std::clamp(cosine, -1.0, 1.0)) * kDegPerRad;
    return std::abs(angle - t_.dihedral[i] * kDegPerRad);
  }

  /// The normal of the root's own surface, from the lengths of the section.
  [[nodiscard]] Vector3d root_normal(std::size_t i) const {
    const Vector2d n = t_.at[i].normal;
    if (spec_.root_surface == RootSurface::outer || wall_.concentric()) return {n.x(), n.y(), 0.0};
    const Vector2d q = t_.at[i].point - t_.wall[i] * n;
    const double radius = section_.inner_corner;
    const Vector2d half(0.5 * section_.height - section_.wall,
                        0.5 * section_.width - section_.wall);
    const Vector2d past = q.cwiseAbs() - (half - Vector2d(radius, radius));
    const Vector2d out(std::max(past.x(), 0.0), std::max(past.y(), 0.0));
    const Vector2d unit = out.normalized();
    return {std::copysign(unit.x(), q.x()), std::copysign(unit.y(), q.y()), 0.0};
  }

  /// Returns the sine of the angle between the wall's line at the rule's B and the plane through
  /// the root's tangent that makes the groove's angle with the partner.
  [[nodiscard]] double off_plane(std::size_t i) const {
    const double cut_back =
        std::min(t_.b_raw[i] - spec_.torch.min.rad(), spec_.torch.max.rad() - t_.b_raw[i]);
    const bool square = std::holds_alternative<SquareCut>(spec_.groove);
    if (t_.corner[i] || square || cut_back < kNearLimit) return 0.0;
    const auto n = solids_.at(t_.cutter[i]).normal(root(i));
    const Vector3d across = n.cross(root_normal(i));
    if (std::abs(n.z()) < kSilhouette || across.norm() < kSilhouette) return 0.0;
    const Vector3d along = across.normalized();
    const auto groove = elementary::sincos(t_.groove[i]), lean = elementary::sincos(t_.b_raw[i]);
    const Vector3d plane = groove.cos * n - groove.sin * along.cross(n);
    const auto& out = t_.at[i].normal;
    return std::abs(plane.dot(Vector3d(lean.cos * out.x(), lean.cos * out.y(), lean.sin)));
  }

  /// How far the row's cut stays from the nearest partner; negative: it enters.
  [[nodiscard]] double clearance(std::size_t i) const {
    const auto line = surface_.line(i, 0.0);
    const auto in = SectionSurface::place(line, line.wall, line.inner);
    const auto out = SectionSurface::place(line, 0.0, line.outer);
    const auto face = SectionSurface::place(line, line.wall - spec_.root_face, line.face);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& solid : solids_)
      least = std::min({least, solid.least_distance(in, face), solid.least_distance(face, out)});
    return least;
  }
  /// At a jump one of the two rows touches.
  [[nodiscard]] bool touches(std::size_t i) const {
    return t_.corner[i] || clearance(i) <= kPenetration;
  }

  /// The input of the smoothing at a row, from the columns.
  [[nodiscard]] double input(std::size_t i) const {
    const bool lifted = spec_.contact == Contact::automatic;
    const bool square = std::holds_alternative<SquareCut>(spec_.groove);
    const bool floored = spec_.contact == Contact::inner || (lifted && !square);
    const double own = floored ? std::max(t_.b_raw[i], t_.b_required[i]) : t_.b_raw[i];
    return std::min(own, spec_.torch.max.rad());
  }

  void smoothing_checks(std::vector<Check>& out) const {
    const auto* method = std::get_if<EnvelopeSmoothing>(&spec_.smoothing);
    if (method == nullptr) return;
    const bool by_length = method->along == Along::length;
    const auto& s = by_length ? t_.length : t_.developed;
    AngleProfile path{.s = {}, .b = {}, .period = by_length ? t_.length_total : t_.developed_total};
    auto before = path;
    for (std::size_t i = 0; i < s.size(); ++i) {
      // At a jump the larger input counts.
      const bool pair = i + 1 < s.size() && t_.at[i].s == t_.at[i + 1].s;
      const bool second = i > 0 && t_.at[i].s == t_.at[i - 1].s;
      double most = input(i);
      if (pair) most = std::max(most, input(i + 1));
      if (second) most = std::max(most, input(i - 1));
      if (i > 0 && s[i] == s[i - 1]) continue;
      path.s.push_back(s[i]);
      path.b.push_back(t_.b[i]);
      before.b.push_back(most);
    }
    before.s = path.s;
    const auto most = allowed_steepness(path, method->limits), got = steepness(path);
    out.push_back({"slope", got.slope * kDegPerRad, most.slope * kDegPerRad, "deg_per_mm"});
    out.push_back(
        {"second_difference", got.second * kDegPerRad, most.second * kDegPerRad, "deg_per_mm2"});
    if (!method->refine) return;
    const EnvelopeSpec limits{
        .limits = method->limits, .highest = spec_.torch.max.rad(), .refine = true};
    const double excess = area_excess(before, limits, t_.multipliers, area_above(before, path.b));
    out.push_back({"area_excess", excess, kAreaExcess, ""});
  }

  /// Returns how deep the stated place lies in its partner.
  [[nodiscard]] double depth_there() const {
    const auto& p = t_.penetration;
    const auto line = surface_.line_at(surface_.row_before(p.s), p.s);
    return std::max(0.0, -solids_.at(p.solid).distance(SectionSurface::place(line, p.below, p.z)));
  }

  /// The deepest of places between rows by the golden ratio.
  [[nodiscard]] double sampled_depth() const {
    constexpr double kGolden = 0.6180339887498949;
    double seed = 0.0, deep = 0.0;
    for (std::size_t i = 0; i < t_.at.size() && !stopped(); ++i)
      for (int k = 0; k < 6; ++k) {
        seed += kGolden;
        seed -= std::floor(seed);
        const auto line = surface_.line(i, seed);
        seed += kGolden;
        seed -= std::floor(seed);
        const double depth = (k == 0 ? 0.0 : k == 1 ? 1.0 : seed) * line.wall;
        const auto place = SectionSurface::place(line, depth, surface_.z(line, depth));
        for (const auto& solid : solids_) worsen(deep, -solid.distance(place));
      }
    return deep;
  }

  /// At the distance of its gap from each edge, back along the nearest partner's normal, is that
  /// partner's surface. Returns the distance by which it is missed.
  [[nodiscard]] double off_gaps() const {
    double worst = t_.gaps.square.inner.size() == t_.at.size() ? 0.0 : 1.0;
    const auto edge = [&](std::size_t i, double depth, double z, double gap) {
      const auto at = SectionSurface::place(surface_.line(i, 0.0), depth, z);
      double off = std::numeric_limits<double>::infinity();
      for (const auto& solid : solids_)
        off = std::min(off, std::abs(solid.distance(at - gap * solid.normal(at))));
      worsen(worst, off);
    };
    for (std::size_t i = 0; i < t_.gaps.square.inner.size(); ++i) {
      edge(i, t_.wall[i], t_.z_inner[i], t_.gaps.square.inner[i]);
      edge(i, 0.0, t_.z_outer[i], t_.gaps.square.outer[i]);
    }
    return worst;
  }

  /// The beam as a cylinder about the stated axis, at and between rows.
  void torch_checks(std::vector<Check>& out) const {
    double gouge = 0.0;
    for (std::size_t i = 0; i < t_.at.size() && !stopped(); ++i)
      for (const double share : {0.0, 0.13, 0.44, 0.62, 0.88})
        if (share == 0.0 || surface_.width(i) > 0.0)
          worsen(gouge, beam_depth(surface_, t_, i, share, spec_.kerf));
    const double stated = t_.torch_line.gouge;
    out.push_back({"gouge", worst_of({gouge, stated}), kGougeLimit, "mm"});
    out.push_back({"gouge_stated", worst_of({0.0, gouge - stated}), kGougeStated, "mm"});
  }

  const section::Section& section_;
  section::Wall wall_;
  const TableSpec& spec_;
  const SectionTable& t_;
  SectionSurface surface_;
  std::vector<joint::Solid> solids_;
};

}  // namespace

std::vector<Check> verify(const section::Section& section, const TableSpec& spec,
                          const SectionTable& table) {
  return Proof(section, spec, table).checks();
}

}  // namespace tubecut::bevel
