#include "server/http/networks.hpp"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/network_v4.hpp>
#include <boost/asio/ip/network_v6.hpp>
#include <optional>

namespace tubecut::server {
namespace {

namespace ip = boost::asio::ip;
using Error = boost::system::error_code;

constexpr int kMapped = 96;  // bits before an address of IPv4 that is mapped into IPv6

ip::address_v6 mapped(const ip::address_v4& address) {
  return ip::make_address_v6(ip::v4_mapped, address);
}

std::optional<ip::address_v6> parse_address(const std::string& text) {
  Error error;
  const auto address = ip::make_address(text, error);
  if (error) return std::nullopt;
  return address.is_v6() ? address.to_v6() : mapped(address.to_v4());
}

std::optional<ip::network_v6> parse_network(const std::string& text) {
  if (const auto address = parse_address(text)) return ip::network_v6(*address, 128);
  // Boost reads the length by atoi, which takes what does not fit for another number.
  if (const auto slash = text.rfind('/'); slash == text.npos || text.size() - slash > 4)
    return std::nullopt;
  Error error;
  const auto four = ip::make_network_v4(text, error);
  if (!error)
    return ip::network_v6(mapped(four.address()),
                          static_cast<unsigned short>(kMapped + four.prefix_length()));
  const auto six = ip::make_network_v6(text, error);
  return error ? std::nullopt : std::optional(six);
}

}  // namespace

bool is_address(const std::string& text) { return parse_address(text).has_value(); }

bool is_network(const std::string& text) { return parse_network(text).has_value(); }

bool in_networks(const std::string& peer, const std::vector<std::string>& networks) {
  const auto address = parse_address(peer);
  return address && std::ranges::any_of(networks, [&](const std::string& text) {
           const auto network = parse_network(text);
           return network && ip::network_v6(*address, network->prefix_length()).network() ==
                                 network->network();
         });
}

bool is_loopback(std::string_view host) {
  return host == "localhost" || in_networks(std::string(host), {"127.0.0.0/8", "::1"});
}

}  // namespace tubecut::server
