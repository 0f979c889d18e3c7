#pragma once

#include "core/base/error_codes.hpp"

namespace tubecut::server {

/// Returns the HTTP status of a kind of error: the only place that connects the two.
[[nodiscard]] int status_of(ErrorKind kind);

/// Whether the same request may succeed later without a change: then the answer carries
/// Retry-After.
[[nodiscard]] bool retryable(int status);

}  // namespace tubecut::server
