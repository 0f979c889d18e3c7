#pragma once

#include "api/wire/json.hpp"
#include "core/frame/alike.hpp"

namespace tubecut::api {

/// What of a part's request to /v1/parts must be another's to the letter for the two to be alike:
/// all but where its partners, holes and marks are, and how long it is. `form` is left to set.
[[nodiscard]] frame::Shape shape_of(const Json& part);

}  // namespace tubecut::api
