#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tubecut::server {

/// Names that a port accepts in addition to those of its own machine; nullopt: any name.
using Hosts = std::optional<std::vector<std::string>>;

/// Answer to a request that names another host.
inline constexpr std::string_view kForeignHost = "Host names another service; --hosts adds names.";

/// Returns whether a request may name that `Host`. A page whose owner made a foreign name resolve
/// to this machine must not. Browsers always send a Host.
[[nodiscard]] bool called_by(std::string_view host, const Hosts& hosts);

}  // namespace tubecut::server
