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

struct Context;

struct Page {
  std::string content_type;
  std::string body;
};

/// The answer to a GET of a catalogue (`/v1/errors`, `/openapi.yaml`, ...); nothing for other
/// paths. Of limits, those in force on this replica.
[[nodiscard]] std::optional<Page> catalogue(std::string_view path, const Context& context);

}  // namespace tubecut::api
