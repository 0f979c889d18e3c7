#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "server/http/http.hpp"

namespace tubecut::server {

/// A file of the console carried inside the binary: gzipped, or as it is.
struct StaticFile {
  std::string_view path;
  std::string_view content_type;
  std::string_view etag;
  bool immutable = false;  // its name changes with its content
  std::string_view plain;  // empty where it is gzipped
  std::string_view gzip;
  std::size_t bytes = 0;  // of what is gzipped, unpacked
};

/// The console as built into this binary; empty when it was built without.
[[nodiscard]] std::span<const StaticFile> static_files();

/// The answer to a GET or HEAD of a page or one of its files; nothing for every other request.
/// Without a built console `/` and `/docs` are one plain page that says so. For the few clients
/// that take no gzip a file is unpacked once and kept: of all that ask for it none has a copy.
/// Throws std::runtime_error where what is carried is not the gzip of `bytes` bytes.
[[nodiscard]] std::optional<Response> static_answer(const Request& request,
                                                    std::span<const StaticFile> files);

}  // namespace tubecut::server
