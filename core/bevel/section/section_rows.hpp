#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/bevel/section/section_table.hpp"
#include "core/bevel/table/angles.hpp"
#include "core/joint/section/section_sampling.hpp"
#include "core/joint/solid.hpp"

/// The rows of `section_table` before smoothing, for its own sources only.
namespace tubecut::bevel::detail {

/// What is needed at every row, computed once.
struct SectionSetup {
  const TableSpec& spec;
  section::Wall wall;
  std::vector<joint::Cutter> cutters;  // grown
  std::vector<joint::Solid> solids;    // the same
  joint::SectionContour inner, outer;
  Rule rule;
  Rule flush;  // where the target is set into its partner

  [[nodiscard]] bool root_outside() const { return spec.root_surface == RootSurface::outer; }
  [[nodiscard]] const joint::SectionContour& root() const { return root_outside() ? outer : inner; }
  /// The place of the root's own outline that belongs to a place outside.
  [[nodiscard]] section::Station root_station(const section::Station& outside) const {
    return root_outside() ? outside : wall.across(outside).bore;
  }
};
[[nodiscard]] Result<SectionSetup> set_up(const section::Section& section, const TableSpec& spec);

/// The angles of one row, rad.
struct SectionPoint {
  Angles angles;
  double raw = 0.0, required = 0.0, input = 0.0, face = 0.0;
};
struct SectionRow {
  section::Station at;  // outside
  section::Across across;
  double z = 0.0;       // of the root's contour
  double bore_z = 0.0;  // of the contour on the bore
  std::size_t before = 0, after = 0, cutter = 0;
  bool jump = false, corner = false;
  double side = 0.0;      // of a jump's first row -1, of its second 1
  std::size_t other = 0;  // at a jump, the partner of its other row
  double length = 0.0;
  SectionPoint point;
};
struct SectionRows {
  std::vector<SectionRow> rows;
  double true_length = 0.0;
  /// Is row i the first of a jump's two?
  [[nodiscard]] bool jump_pair(std::size_t i) const {
    return i + 1 < rows.size() && rows[i].jump && rows[i + 1].jump &&
           rows[i].at.s == rows[i + 1].at.s;
  }
};
/// Fills in a row's angles, from its place, height and partners.
void fill_row(const SectionSetup& g, SectionRow& row);
/// Rows at the places `also` (s outside) besides those of the sampling.
[[nodiscard]] Result<SectionRows> section_rows(const SectionSetup& g, std::span<const double> also);

/// The cutters as a round target of radius `radius` sees them that touches the outside at a place:
/// its half plane there is the section's.
struct LocalView {
  std::vector<joint::PreparedCutter> cutters;
  joint::Wall wall;
  joint::Generator inner;
};
[[nodiscard]] LocalView local_view(const SectionSetup& g, const section::Station& at, double wall);

}  // namespace tubecut::bevel::detail
