#pragma once

#include <memory>

#include "api/endpoints/parts.hpp"
#include "api/wire/json.hpp"
#include "core/frame/alike.hpp"

namespace tubecut::api {

/// Returns the content of a part's request to /v1/parts that must be identical for two parts to be
/// equal: all except the positions of its partners, holes and marks, and its length. `form` remains
/// to be set.
[[nodiscard]] frame::Shape shape_of(const Json& part);

/// Returns a part's request as /v1/parts understands it; nullptr if it is not valid. One that is
/// not round also has the target and marks of a round one of the same girth, by which parts are
/// compared.
[[nodiscard]] std::unique_ptr<const Parts::Spec> read_part(const Json& part);

}  // namespace tubecut::api
