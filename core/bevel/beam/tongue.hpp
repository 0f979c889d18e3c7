#pragma once

#include <optional>

#include "core/bevel/table/table.hpp"

namespace tubecut::bevel {

/// A place where the kept wall narrows to a tip between two parts of the cut.
struct Tongue {
  double width = 0.0;         // along the circumference, one wall thickness behind its tip, mm
  double phi = 0.0, z = 0.0;  // its tip
  double radius = 0.0;        // of the edge on which it is narrowest
};

/// Finds the narrowest tongue of a cut end, over both edges; empty when no tip is longer than the
/// wall is thick. The kept part lies towards +z; `towards_plus_z`: the tongues point there, as
/// those of a part's finish do.
[[nodiscard]] std::optional<Tongue> narrowest_tongue(const joint::Target& target,
                                                     const Table& table, bool towards_plus_z);

/// Returns the travel of the head along the tube in this cut, mm.
[[nodiscard]] double reach(const Table& table);
[[nodiscard]] double reach(const std::vector<double>& torch_inner,
                           const std::vector<double>& torch_outer);

}  // namespace tubecut::bevel
