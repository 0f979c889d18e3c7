#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tubecut::server {

[[nodiscard]] bool is_address(const std::string& text);

/// Whether it is an address or a network: "10.0.0.0/8".
[[nodiscard]] bool is_network(const std::string& text);

/// Returns whether `peer` lies in one of the addresses or networks. Malformed texts match nothing.
[[nodiscard]] bool in_networks(const std::string& peer, const std::vector<std::string>& networks);

/// Whether an address to listen on is reached from this machine only.
[[nodiscard]] bool is_loopback(std::string_view host);

}  // namespace tubecut::server
