#pragma once

#include "core/bevel/table/table.hpp"

namespace tubecut::bevel {

/// How the numbers of a column change if the tube is seen from its other end.
enum class ColumnKind {
  station,    // of the row around the cut: measured in reverse
  height,     // z: measured from the other end
  elevation,  // an angle towards +z: changes its sign
  rate,       // of a height by another quantity: changes its sign; kNoRate if undefined
  plain,      // unchanged
};

/// Calls `see(kind, column...)` with every numeric column that the tables of all tubes have, except
/// stations along the cut.
template <class F, class... T>
void each_common_column(const F& see, T&... t) {
  using enum ColumnKind;
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

/// Calls `see(kind, column...)` with every numeric column of a table, or of several tables in
/// parallel. If you add a column to `Table`, add a line here.
template <class F, class... T>
void each_column(const F& see, T&... t) {
  using enum ColumnKind;
  see(station, t.phi...);
  see(station, t.developed...);
  see(station, t.length...);
  see(elevation, t.tau...);
  see(rate, t.dz_branch...);
  see(rate, t.dz_chord...);
  each_common_column(see, t...);
}

}  // namespace tubecut::bevel
