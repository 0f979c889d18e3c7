#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "server/http/http.hpp"

namespace tubecut::server {

/// Returns the reason why the length of a request is ambiguous (RFC 9112, 6.3) or its host
/// doubtful, as text for the client; empty if it is sound. If two programs read a length
/// differently, a second request can hide in the first. `minor` is the version: HTTP/1.minor.
[[nodiscard]] std::string_view framing_fault(const Headers& headers, int minor);

/// Returns the fault of a head's bytes before a parser sees them: folded lines, bare CR or LF, NUL
/// and other controls; empty if there is no fault. Checks the bytes of [from, to) together with
/// their neighbours.
[[nodiscard]] std::string_view byte_fault(std::string_view head, std::size_t from, std::size_t to);

/// Its Content-Length; 0 without one.
[[nodiscard]] std::uint64_t announced_length(const Headers& headers);

/// Whether a comma-separated list of all values under `name` holds `token` (any case).
[[nodiscard]] bool lists_token(const Headers& headers, std::string_view name,
                               std::string_view token);

/// The origin form of a target: scheme and authority of an absolute one are taken off. Empty when
/// it is neither (RFC 9112, 3.2), or holds a fragment.
[[nodiscard]] std::string origin_form(std::string_view target, std::string_view method);

}  // namespace tubecut::server
