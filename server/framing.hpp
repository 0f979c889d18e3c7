#pragma once

#include <cstdint>
#include <string_view>

#include "server/http.hpp"

namespace tubecut::server {

/// What makes the length of a request ambiguous (RFC 9112, 6.3) or its host doubtful, as text for
/// the client; empty when nothing does. Where two programs may read a length differently, a second
/// request can hide in the first.
[[nodiscard]] std::string_view framing_fault(const Headers& headers);

/// Whether a body follows a head without fault.
[[nodiscard]] bool announces_body(const Headers& headers);

/// Its Content-Length; 0 without one.
[[nodiscard]] std::uint64_t announced_length(const Headers& headers);

}  // namespace tubecut::server
