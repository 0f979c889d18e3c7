#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tubecut::api {

/// A file of the project carried inside the binary.
struct Embedded {
  std::string_view name;
  std::string_view text;
};

/// openapi.yaml, openapi.json and every file under examples/, by its path.
[[nodiscard]] std::span<const Embedded> embedded_files();

struct Page {
  std::string content_type;
  std::string body;
};

/// The answer to a GET of a catalogue (`/v1/errors`, `/openapi.yaml`, ...); nothing for other
/// paths. `max_body` bytes of body are what this replica takes.
[[nodiscard]] std::optional<Page> catalogue(std::string_view path, std::size_t max_body);

}  // namespace tubecut::api
