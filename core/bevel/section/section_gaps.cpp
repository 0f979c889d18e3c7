#include "core/bevel/section/section_gaps.hpp"

#include <algorithm>
#include <limits>

#include "core/bevel/table/root_opens.hpp"

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

/// Returns the distance of a place from the nearest partner.
double metal_distance(const SectionSetup& g, const Eigen::Vector3d& place) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& solid : g.solids) least = std::min(least, solid.distance(place));
  return least;
}

/// Closes openings that are narrower than they would have to be to count: no metal is missing
/// there.
void close_slivers(const SectionSurface& surface, std::vector<double>& open) {
  const auto n = open.size();
  const auto closed = std::ranges::find_if(open, [](double gap) { return !(gap > kOpen); });
  if (closed == open.end()) return;
  const auto first = static_cast<std::size_t>(closed - open.begin());
  double wide = 0.0;
  std::vector<std::size_t> run;
  for (std::size_t k = 0, i = first; k < n; ++k) {
    wide += surface.width(i);
    i = surface.next(i);
    if (open[i] > kOpen) {
      run.push_back(i);
      continue;
    }
    if (wide <= kOpen)
      for (const auto row : run) open[row] = 0.0;
    run.clear();
    wide = 0.0;
  }
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
  for (std::size_t i = 0; i < rows.at.size(); ++i) {
    const auto line = line_of(surface, table, rows, i);
    out.inner.push_back(metal_distance(g, SectionSurface::place(line, line.wall, line.inner)));
    out.outer.push_back(metal_distance(g, SectionSurface::place(line, 0.0, line.outer)));
  }
  return out;
}

std::vector<double> root_openings(const SectionSetup& g, const SectionSurface& surface,
                                  const SectionTable& table) {
  auto out = table.gap;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (!(out[i] > kOpen)) continue;
    const auto line = surface.line(i, 0.0);
    const double metal = metal_distance(g, SectionSurface::place(line, line.wall, line.inner));
    if (metal <= kOpen) out[i] = std::max(0.0, metal);
  }
  close_slivers(surface, out);
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
