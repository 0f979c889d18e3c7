#pragma once

#include "core/bevel/table/table.hpp"

namespace tubecut::bevel::detail {

/// Checks that every stated joint has one gap, and that zones occur without flush rows.
/// Errors  joint_contradicts (root_gap), unsupported_combination (groove/rule).
[[nodiscard]] Result<void> check_stated(const TableSpec& spec);

}  // namespace tubecut::bevel::detail
