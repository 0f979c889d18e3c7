#pragma once

#include "api/endpoints/part_request.hpp"
#include "api/wire/reader.hpp"
#include "core/bevel/table/table.hpp"

namespace tubecut::api {

/// Decodes `ends` of a part given directly: cutters with their joints and cut, or a square end.
/// `once`: the values that a part has once.
void decode_ends(Reader& in, const bevel::TableSpec& once, PartRequest& out);

}  // namespace tubecut::api
