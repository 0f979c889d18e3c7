#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "server/admin.hpp"

namespace tubecut::server {

/// The port of the probes and metrics, for the operator's network: cpp-httplib's own server with
/// its own threads, so that it answers under any load on the service's port.
class AdminPort {
 public:
  /// At a time; more wait.
  static constexpr int kConnections = 64;

  /// Binds and listens. An error is text for the operator.
  [[nodiscard]] static tl::expected<AdminPort, std::string> open(const std::string& host, int port,
                                                                 AdminSources sources);
  AdminPort(AdminPort&&) noexcept;
  ~AdminPort();

  [[nodiscard]] int port() const;

  /// Serves until `stop`. False when listening broke down.
  bool serve();
  [[nodiscard]] bool serving() const;

  /// From any thread.
  void stop();

 private:
  struct Impl;
  explicit AdminPort(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> x_;
};

/// Returns the status that a GET of `path` answers, or nothing if no answer comes within
/// `patience`.
[[nodiscard]] std::optional<int> probe(const std::string& host, int port, const std::string& path,
                                       std::chrono::milliseconds patience);

}  // namespace tubecut::server
