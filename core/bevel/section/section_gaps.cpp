#include "core/bevel/section/section_gaps.hpp"

#include <algorithm>
#include <limits>

#include "core/bevel/section/section_surface.hpp"

namespace tubecut::bevel::detail {

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
  for (const auto& at : rows.at) {
    const auto line = surface.line_at(surface.row_before(at.s), at.s);
    out.inner.push_back(nearest(SectionSurface::place(line, line.wall, line.inner)));
    out.outer.push_back(nearest(SectionSurface::place(line, 0.0, line.outer)));
  }
  return out;
}

}  // namespace tubecut::bevel::detail
