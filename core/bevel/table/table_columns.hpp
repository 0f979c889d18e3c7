#pragma once

#include "core/bevel/table/table.hpp"

namespace tubecut::bevel {

/// What the numbers of a column are, by what they become when the tube is seen from its other end.
enum class ColumnKind {
  station,    // of the row round the cut: counted the other way
  height,     // z: counted from the other end
  elevation,  // an angle towards +z: of the other sign
  rate,       // of a height by something else: of the other sign; kNoRate where there is none
  plain,      // the same
};

/// Calls `see(kind, column...)` with every column of numbers of a table, or of several tables side
/// by side. A column added to `Table` is a line here.
template <class F, class... T>
void each_column(const F& see, T&... t) {
  using enum ColumnKind;
  see(station, t.phi...);
  see(station, t.developed...);
  see(station, t.length...);
  see(height, t.z_inner...);
  see(height, t.z_outer...);
  see(height, t.z_face...);
  see(elevation, t.b_face...);
  see(plain, t.dihedral...);
  see(plain, t.groove...);
  see(elevation, t.tau...);
  see(plain, t.gamma...);
  see(elevation, t.flush...);
  see(rate, t.dz_branch...);
  see(rate, t.dz_chord...);
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
