#pragma once

#include "core/base/error_codes.hpp"

namespace tubecut::server {

/// The HTTP status of a kind of error: the only place where the two meet.
[[nodiscard]] int status_of(ErrorKind kind);

/// Whether the same request may succeed later without a change: then the answer carries
/// Retry-After.
[[nodiscard]] bool retryable(int status);

}  // namespace tubecut::server
