#include "server/admin_port.hpp"

#include <httplib.h>

namespace tubecut::server {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kBody = 1024;  // no path here takes one

}  // namespace

tl::expected<Transport, std::string> open_admin_port(const std::string& host, int port,
                                                     AdminSources sources) {
  return Transport::open({.host = host,
                          .port = port,
                          .connections = kAdminConnections,
                          .slots = 1,
                          .queue = kAdminConnections,
                          .idle = 5s,
                          .head = 2s,
                          .body = 2s,
                          .write = 5s},
                         {.handle = [sources = std::move(sources)](
                                        const Request& request) { return admin(request, sources); },
                          .screen = [](const Request&) { return std::optional<Refusal>(); },
                          .max_body = [](std::string_view) { return kBody; }});
}

std::optional<int> probe(const std::string& host, int port, const std::string& path,
                         std::chrono::milliseconds patience) {
  httplib::Client client(host, port);
  client.set_connection_timeout(patience);
  client.set_read_timeout(patience);
  const auto result = client.Get(path);
  return result ? std::optional<int>(result->status) : std::nullopt;
}

}  // namespace tubecut::server
