#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tubecut::server {

/// The names a port answers to beside those of its own machine; none: to any.
using Hosts = std::optional<std::vector<std::string>>;

/// What is told to whom names another.
inline constexpr std::string_view kForeignHost = "Host names another service; --hosts adds names.";

/// Whether a request may name that `Host`: a page under a foreign name, which its owner made to
/// lead here, may not. Without one no browser asks.
[[nodiscard]] bool called_by(std::string_view host, const Hosts& hosts);

}  // namespace tubecut::server
