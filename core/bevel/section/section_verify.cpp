#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"
#include "core/bevel/beam/beam.hpp"
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
    double on = 0.0, dihedral = 0.0, below = 0.0, beyond = 0.0, deep = 0.0, touch = 0.0;
    for (std::size_t i = 0; i < t_.at.size(); ++i) {
      worsen(on, off_outlines(i));
      worsen(dihedral, off_dihedral(i));
      worsen(below, (std::min(t_.b_raw[i], spec_.torch.max.rad()) - t_.b[i]) * kDegPerRad);
      if (spec_.contact == Contact::inner) worsen(below, (t_.b_required[i] - t_.b[i]) * kDegPerRad);
      worsen(beyond, (t_.b[i] - spec_.torch.max.rad()) * kDegPerRad);
      worsen(beyond, (spec_.torch.min.rad() - t_.b[i]) * kDegPerRad);
      const double clear = clearance(i);
      if (spec_.contact != Contact::none) worsen(deep, -clear);
      if (spec_.contact == Contact::automatic) worsen(touch, touches(i) ? 0.0 : clear);
    }
    out.push_back({"on_section", on, kOnSection, "mm"});
    out.push_back({"dihedral", dihedral, kAngle, "deg"});
    out.push_back({"above_required", below, kAngle, "deg"});
    out.push_back({"torch_range", beyond, kAngle, "deg"});
    out.push_back({"penetration", deep, kPenetration, "mm"});
    smoothing_checks(out);
    const double found = worst_of({sampled_depth(), t_.penetration.depth});
    out.push_back({"penetration_stated", found - t_.penetration.depth, kStated, "mm"});
    if (promises_no_penetration(spec_))
      out.push_back(
          {"penetration_between", worst_of({0.0, found}), penetration_limit(spec_), "mm"});
    if (spec_.kerf > 0.0) out.push_back({"gouge", gouge(), kGougeLimit, "mm"});
    return out;
  }

 private:
  /// Both places of a row lie on their outlines, and the wall is the way between them.
  [[nodiscard]] double off_outlines(std::size_t i) const {
    const Vector2d p = t_.at[i].point, q = p - t_.wall[i] * t_.at[i].normal;
    return std::max(std::abs(joint::outline_distance(section_, true, p)),
                    std::abs(joint::outline_distance(section_, false, q)));
  }

  /// Returns by how much the dihedral differs from that of the partner's solid.
  [[nodiscard]] double off_dihedral(std::size_t i) const {
    const bool outer = spec_.root_surface == RootSurface::outer;
    if (t_.corner[i] || spec_.contact == Contact::automatic) return 0.0;
    const Vector2d p =
        outer ? t_.at[i].point : Vector2d(t_.at[i].point - t_.wall[i] * t_.at[i].normal);
    const double z = outer ? t_.z_outer[i] : t_.z_inner[i];
    const auto n = solids_.at(t_.cutter[i]).normal({p.x(), p.y(), z});
    if (std::abs(n.z()) < kSilhouette) return 0.0;
    const double cosine = -(n.x() * t_.at[i].normal.x() + n.y() * t_.at[i].normal.y());
    const double angle = elementary::acos(std::clamp(cosine, -1.0, 1.0)) * kDegPerRad;
    return std::abs(angle - t_.dihedral[i] * kDegPerRad);
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

  void smoothing_checks(std::vector<Check>& out) const {
    const auto* method = std::get_if<EnvelopeSmoothing>(&spec_.smoothing);
    if (method == nullptr) return;
    const bool by_length = method->along == Along::length;
    const auto& s = by_length ? t_.length : t_.developed;
    AngleProfile path{.s = {}, .b = {}, .period = by_length ? t_.length_total : t_.developed_total};
    for (std::size_t i = 0; i < s.size(); ++i) {
      if (i > 0 && s[i] == s[i - 1]) continue;
      path.s.push_back(s[i]);
      path.b.push_back(t_.b[i]);
    }
    const auto most = allowed_steepness(path, method->limits), got = steepness(path);
    out.push_back({"slope", got.slope * kDegPerRad, most.slope * kDegPerRad, "deg_per_mm"});
    out.push_back(
        {"second_difference", got.second * kDegPerRad, most.second * kDegPerRad, "deg_per_mm2"});
  }

  /// The deepest of places between rows by the golden ratio.
  [[nodiscard]] double sampled_depth() const {
    constexpr double kGolden = 0.6180339887498949;
    double seed = 0.0, deep = 0.0;
    for (std::size_t i = 0; i < t_.at.size(); ++i)
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

  /// The beam as a cylinder about the axis at and between rows, against places of the finished
  /// surface beside it: how deep one lies in it, on the part's side.
  [[nodiscard]] double gouge() const {
    constexpr int kAlong = 12, kAcross = 4;
    const double half = 0.5 * spec_.kerf;
    double worst = 0.0;
    for (std::size_t i = 0; i < t_.at.size(); ++i)
      for (const double share : {0.0, 0.37, 0.71}) {
        if (share > 0.0 && !(surface_.width(i) > 0.0)) continue;
        const auto j = surface_.next(i);
        const auto own = surface_.line(i, share);
        const double inner = (1.0 - share) * t_.torch_inner[i] + share * t_.torch_inner[j];
        const double outer = (1.0 - share) * t_.torch_outer[i] + share * t_.torch_outer[j];
        const auto head = SectionSurface::place(own, 0.0, outer);
        const Vector3d along = (head - SectionSurface::place(own, own.wall, inner)).normalized();
        const Vector3d up(-along.z() * own.at.normal.x(), -along.z() * own.at.normal.y(),
                          elementary::hypot(along.x(), along.y()));
        for (int k = -kAlong; k <= kAlong; ++k) {
          const double s = own.at.s + half * k / kAlong;
          const double there = s - t_.girth * std::floor(s / t_.girth);
          const auto line = surface_.line_at(surface_.row_before(there), there);
          for (int a = 0; a <= kAcross; ++a) {
            const double depth = line.wall * a / kAcross;
            const Vector3d off = SectionSurface::place(line, depth, surface_.z(line, depth)) - head;
            if (off.dot(up) <= 0.0) continue;  // on the scrap's side of the axis
            worsen(worst, half - (off - off.dot(along) * along).norm());
          }
        }
      }
    return worst;
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
