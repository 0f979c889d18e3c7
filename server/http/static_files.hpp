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
  std::string_view plain;  // empty if it is gzipped
  std::string_view gzip;
  std::size_t bytes = 0;  // unpacked size of the gzipped bytes
};

/// The console as built into this binary; empty when it was built without.
[[nodiscard]] std::span<const StaticFile> static_files();

/// Returns the answer to a GET or HEAD of a page or one of its files; nothing for every other
/// request. If the console was not built, `/` and `/docs` are one plain page that reports it. If a
/// client takes no gzip, a file is unpacked once and kept, so that no request has its own copy.
/// Throws std::runtime_error if the stored bytes are not the gzip of `bytes` bytes.
[[nodiscard]] std::optional<Response> static_answer(const Request& request,
                                                    std::span<const StaticFile> files);

}  // namespace tubecut::server
