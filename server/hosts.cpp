#include "server/hosts.hpp"

#include <algorithm>

#include "server/http/http.hpp"
#include "server/http/networks.hpp"

namespace tubecut::server {
namespace {

/// Host without its port, and an address without its brackets.
std::string_view name_of(std::string_view host) {
  if (host.starts_with('[')) return host.substr(1, host.find(']') - 1);
  return host.substr(0, host.find(':'));
}

}  // namespace

bool called_by(std::string_view host, const Hosts& hosts) {
  const auto name = name_of(host);
  return !hosts || name.empty() || equal_ignoring_case(name, "localhost") || is_loopback(name) ||
         std::ranges::any_of(*hosts,
                             [&](const auto& one) { return equal_ignoring_case(name, one); });
}

}  // namespace tubecut::server
