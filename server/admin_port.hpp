#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "server/admin.hpp"
#include "server/http/transport.hpp"

namespace tubecut::server {

/// Connections that the admin port holds at a time. One address has half of them.
inline constexpr int kAdminConnections = 512;

/// Opens the port of the probes and metrics, for the operator's network: a transport of its own,
/// with a loop and a slot of its own, so that it answers whatever the load on the service's port
/// is. Half-sent heads cost a connection each and no thread; the oldest of them make room.
/// An error is text for the operator.
[[nodiscard]] tl::expected<Transport, std::string> open_admin_port(const std::string& host,
                                                                   int port, AdminSources sources);

/// The status that a GET of `path` answers; nothing if nobody does within `patience`.
[[nodiscard]] std::optional<int> probe(const std::string& host, int port, const std::string& path,
                                       std::chrono::milliseconds patience);

}  // namespace tubecut::server
