#pragma once

#include "core/bevel/section/section_table.hpp"
#include "core/bevel/table/table_columns.hpp"

namespace tubecut::bevel {

/// Calls `see(kind, column...)` with every numeric column of a section's table, as `each_column` of
/// a round tube's. Stations along the cut are not among them.
template <class F, class... T>
void each_section_column(const F& see, T&... t) {
  using enum ColumnKind;
  see(plain, t.wall...);
  see(height, t.z_inner...);
  see(height, t.z_outer...);
  see(height, t.z_face...);
  see(elevation, t.b_face...);
  see(plain, t.dihedral...);
  see(plain, t.groove...);
  see(plain, t.gamma...);
  see(elevation, t.flush...);
  see(elevation, t.b_raw...);
  see(elevation, t.b_required...);
  see(elevation, t.b...);
  see(plain, t.gap...);
  see(plain, t.gaps.square.inner...);
  see(plain, t.gaps.square.outer...);
  see(plain, t.gaps.bevelled.inner...);
  see(plain, t.gaps.bevelled.outer...);
  see(plain, t.beam...);
  see(height, t.torch_inner...);
  see(height, t.torch_outer...);
}

}  // namespace tubecut::bevel
