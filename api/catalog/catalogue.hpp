#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace tubecut::api {

/// A file of the project carried inside the binary.
struct Embedded {
  std::string_view name;
  std::string_view text;
};

/// openapi.yaml, openapi.json and every file under examples/ and posts/, by its path.
[[nodiscard]] std::span<const Embedded> embedded_files();
/// One that is there.
[[nodiscard]] std::string embedded(std::string_view name);

struct Context;

/// A catalogue that a GET returns (`/v1/errors`, `/openapi.yaml`, ...).
struct Page {
  std::string_view path;
  std::string_view content_type;
  std::string (*print)(const Context& context);  // of limits, those in force on this replica
};
/// nullptr for other paths.
[[nodiscard]] const Page* find_page(std::string_view path);

}  // namespace tubecut::api
