#pragma once

#include <stop_token>
#include <string>
#include <string_view>

namespace tubecut::api {

/// sha256 in lower-case hex. Throws Stopped.
[[nodiscard]] std::string sha256(std::string_view bytes, const std::stop_token& stop = {});

}  // namespace tubecut::api
