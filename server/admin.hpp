#pragma once

#include <functional>
#include <string>

#include "server/hosts.hpp"
#include "server/http/http.hpp"

namespace tubecut::server {

/// The sources of the admin port's pages.
struct AdminSources {
  std::function<bool()> ready;
  std::function<std::string()> metrics;
  Hosts hosts = {};
};

/// GET /livez: the process answers. GET /readyz: it takes work (503 while starting and stopping).
/// GET /metrics.
[[nodiscard]] Response admin(const Request& request, const AdminSources& sources);

}  // namespace tubecut::server
