#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/bevel/table/table.hpp"

namespace tubecut::bevel {

inline constexpr double kOpen = 0.05;  // mm: less than a kerf varies

/// Returns the warning of the row where the root opens most, if it opens although the contact is to
/// close it; `place` names the place of a row.
[[nodiscard]] std::optional<Warning> root_opens(
    const TableSpec& spec, const std::vector<double>& gap,
    const std::function<std::string(std::size_t)>& place);

}  // namespace tubecut::bevel
