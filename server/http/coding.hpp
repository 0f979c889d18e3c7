#pragma once

#include "server/http/http.hpp"

namespace tubecut::server {

/// Returns whether the client accepts a body in gzip.
[[nodiscard]] bool takes_gzip(const Request& request);

/// Gives the answer of a GET its ETag. If the client has that body already (If-None-Match), the
/// answer becomes 304 without a body.
void revalidate(const Request& request, Response& response);

/// Compresses a body above 4 kB with gzip if the client accepts it and the format is not compressed
/// by itself.
void compress(const Request& request, Response& response);

}  // namespace tubecut::server
