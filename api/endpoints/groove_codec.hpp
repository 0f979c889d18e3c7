#pragma once

#include "api/wire/reader.hpp"
#include "core/groove/groove.hpp"
#include "core/groove/mill_path.hpp"

namespace tubecut::api {

/// Decodes a /v1/grooves request, also if it is nested in another.
[[nodiscard]] groove::GrooveSpec decode_groove_request(Reader& in);
/// Decodes a /v1/mill-paths request, also if it is nested in another.
[[nodiscard]] groove::MillPathSpec decode_mill_path_request(Reader& in);

}  // namespace tubecut::api
