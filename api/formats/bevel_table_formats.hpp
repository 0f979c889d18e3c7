#pragma once

#include <string>

#include "api/endpoint.hpp"
#include "core/bevel/table.hpp"

namespace tubecut::api {

/// Every column of the table.
[[nodiscard]] std::string bevel_table_csv(const bevel::TableSpec& spec, const bevel::Table& table,
                                          const Caption& caption);

/// B before and after smoothing over the developed length, with the junctions, the mutations and
/// the stretches where the torch's range binds; below it the finished edges over phi.
[[nodiscard]] std::string bevel_table_svg(const bevel::TableSpec& spec, const bevel::Table& table,
                                          const Caption& caption);

}  // namespace tubecut::api
