#include "core/bevel/section/section_gaps.hpp"

#include <algorithm>
#include <limits>

#include "core/bevel/section/section_surface.hpp"

namespace tubecut::bevel::detail {
namespace {

constexpr int kAcrossOpen = 64;  // samples if nothing is met

/// The finished line of a table at row i of `rows`: at a jump the first of two belongs to the
/// first.
SectionSurface::Line line_of(const SectionSurface& surface, const SectionTable& table,
                             const SectionTable& rows, std::size_t i) {
  const double s = rows.at[i].s;
  auto k = surface.row_before(s);
  const bool first = i + 1 < rows.at.size() && rows.at[i + 1].s == s;
  if (first && k > 0 && table.at[k].s == s && table.at[k - 1].s == s) --k;
  return table.at[k].s == s ? surface.line(k, 0.0) : surface.line_at(k, s);
}

}  // namespace

TableSpec flush_spec(const TableSpec& spec) {
  auto out = spec;
  out.untilted = false;
  out.groove = NoGroove{};
  out.contact = Contact::automatic;
  out.root_surface = RootSurface::inner;
  out.kerf = 0.0;
  out.smoothing = NoSmoothing{};
  out.sampling.max_nodes *= 2;
  return out;
}

EdgeGaps edge_gaps(const SectionSetup& g, const TableSpec& spec, const SectionTable& table,
                   const SectionTable& rows) {
  const SectionSurface surface(g.wall, spec, table);
  EdgeGaps out;
  const auto nearest = [&](const Eigen::Vector3d& place) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& solid : g.solids) least = std::min(least, solid.distance(place));
    return least;
  };
  for (std::size_t i = 0; i < rows.at.size(); ++i) {
    const auto line = line_of(surface, table, rows, i);
    out.inner.push_back(nearest(SectionSurface::place(line, line.wall, line.inner)));
    out.outer.push_back(nearest(SectionSurface::place(line, 0.0, line.outer)));
  }
  return out;
}

void note_overhang(const SectionSetup& g, SectionTable& out) {
  for (const auto& [from, to] : g.outer.open) {
    double worst = 0.0;
    for (int k = 0; k <= kAcrossOpen; ++k) {
      const auto at = g.wall.outer().at(from + (to - from) * k / kAcrossOpen).point;
      double beside = std::numeric_limits<double>::infinity();
      for (const auto& solid : g.solids) beside = std::min(beside, solid.clearance(at.x(), at.y()));
      worst = std::max(worst, beside);
    }
    if (!(worst > joint::kSlightOverhang)) continue;
    out.warnings.push_back({.code = WarningCode::wall_overhangs,
                            .member = "target",
                            .detail = "girth " + brief(from) + " to " + brief(to) +
                                      " mm, its outer surface passes up to " + brief(worst) +
                                      " mm outside every partner"});
  }
}

}  // namespace tubecut::bevel::detail
