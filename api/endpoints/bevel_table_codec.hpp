#pragma once

#include "api/reader.hpp"
#include "core/bevel/table.hpp"

namespace tubecut::api {

/// A /v1/bevel-tables request, also where it is nested in another.
[[nodiscard]] bevel::TableSpec decode_bevel_table_request(Reader& in);

}  // namespace tubecut::api
