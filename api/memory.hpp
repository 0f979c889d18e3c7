#pragma once

#include <cstddef>
#include <string_view>

namespace tubecut::api {

/// The most memory that a job takes while it is answered, its body aside: so many bytes, for each
/// byte of its body, and for each item that it asks for.
struct JobBytes {
  std::size_t fixed = 0;
  std::size_t per_byte = 0;
  std::size_t per_item = 0;
};

/// Of a job at that endpoint in a format ("json", "cbor", or the format's own name), by its id.
/// Items are what makes its answer long: see memory.cpp. Nothing is known of others: 0.
[[nodiscard]] JobBytes job_bytes(std::string_view endpoint, std::string_view format);

/// Of all endpoints the most for each byte of a body.
[[nodiscard]] std::size_t most_per_byte();

}  // namespace tubecut::api
