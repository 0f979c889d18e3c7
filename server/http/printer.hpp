#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>

#include "server/http/http.hpp"

namespace tubecut::server {

/// An answer as bytes for the wire.
struct Printed {
  std::string bytes = {};
  std::string rest = {};                // to be sent after them: a large body, which is not copied
  std::string_view fixed = {};          // used instead of `body`: bytes that live as long as the
                                        // program
  std::function<void(bool)> sent = {};  // see Response
};

/// Status line and headers, up to the empty line. `idle`: how long the connection is kept; 0: it
/// ends with the answer. No Content-Length: the caller frames the body.
[[nodiscard]] std::string print_head(const Response& response, std::chrono::seconds idle,
                                     std::string_view framing);

/// The whole answer to a request of that method.
[[nodiscard]] Printed print(Response response, std::string_view method, std::chrono::seconds idle);

/// One piece of a body sent in chunks (RFC 9112, 7.1), and the end of such a body.
[[nodiscard]] std::string print_chunk(std::string_view text);
inline constexpr std::string_view kLastChunk = "0\r\n\r\n";

}  // namespace tubecut::server
