#pragma once

#include <optional>

#include "core/bevel/table/table.hpp"

namespace tubecut::bevel {

/// The area that a refined envelope added, rad mm, and the lower bound by the table's multipliers;
/// computed from its own rows. Empty for every other smoothing.
struct SmoothedArea {
  double area, least, excess;  // excess: as `area_excess`
};
[[nodiscard]] std::optional<SmoothedArea> smoothed_area(const TableSpec& spec, const Table& table);

}  // namespace tubecut::bevel
