#pragma once

#include "api/wire/json.hpp"
#include "core/frame/alike.hpp"

namespace tubecut::api {

/// Returns the content of a part's request to /v1/parts that must be identical for two parts to be
/// equal: all except the positions of its partners, holes and marks, and its length. `form` remains
/// to be set.
[[nodiscard]] frame::Shape shape_of(const Json& part);

}  // namespace tubecut::api
