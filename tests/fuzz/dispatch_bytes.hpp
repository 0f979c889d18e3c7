#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace tubecut::fuzz {

/// Longer inputs are passed over: an answer's cost grows with the request.
inline constexpr std::size_t kLongest = 8192;

/// Dispatches bytes as a request: the first picks endpoint (low half, its place in a list that only
/// grows) and format or query (high half: '@' to 'O' JSON, 'P' to
/// '_' CBOR, '`' to 'o' validate_only, others a text format), the rest is the body. Aborts when a
/// promise is broken: no exception, no failure of ours, an answer or a problem that reads back as
/// JSON.
void dispatch_bytes(std::span<const std::uint8_t> bytes);

/// Returns the id of the endpoint of an input; empty if it names no endpoint.
[[nodiscard]] std::string_view endpoint_of(std::span<const std::uint8_t> bytes);

}  // namespace tubecut::fuzz
