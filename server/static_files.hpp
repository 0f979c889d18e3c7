#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "server/http.hpp"

namespace tubecut::server {

/// A file of the console carried inside the binary, as it is and gzipped.
struct StaticFile {
  std::string_view path;
  std::string_view content_type;
  std::string_view etag;
  bool immutable = false;  // its name changes with its content
  std::string_view body;
  std::string_view gzip;
};

/// The console as built into this binary; empty when it was built without.
[[nodiscard]] std::span<const StaticFile> static_files();

/// The answer to a GET or HEAD of a page or one of its files; nothing for every other request.
/// Without a built console `/` and `/docs` are one plain page that says so.
[[nodiscard]] std::optional<Response> static_answer(const Request& request,
                                                    std::span<const StaticFile> files);

}  // namespace tubecut::server
