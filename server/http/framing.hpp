#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "server/http/http.hpp"

namespace tubecut::server {

/// What makes the length of a request ambiguous (RFC 9112, 6.3) or its host doubtful, as text for
/// the client; empty when nothing does. Where two programs may read a length differently, a second
/// request can hide in the first. `minor` is the version: HTTP/1.minor.
[[nodiscard]] std::string_view framing_fault(const Headers& headers, int minor);

/// What is wrong with a head's bytes before any parser sees them: folded lines, bare CR or LF, NUL
/// and other controls. Empty when nothing is. Judges the bytes of [from, to) by their neighbours.
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
