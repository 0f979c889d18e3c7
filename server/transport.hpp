#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "server/http.hpp"

namespace tubecut::server {

/// What a transport asks of the application behind it. Called from many threads.
struct Service {
  /// Answers one request: whole, or with the reason why it could not be read.
  std::function<Response(const Request&)> handle;
  /// Whether the body is worth reading. It is not read when this names a reason.
  std::function<std::optional<Refusal>(const Request& head)> screen;
  /// Largest body to read, in bytes.
  std::function<std::size_t(std::string_view target)> max_body;
};

struct TransportOptions {
  std::string host = "127.0.0.1";
  int port = 0;          // 0: any free one
  int connections = 64;  // served at a time, each by a thread; further ones wait
  std::size_t max_head_bytes = 16384;
  std::chrono::milliseconds idle =
      std::chrono::seconds(15);  // a kept-alive connection without a request
  std::chrono::milliseconds head = std::chrono::seconds(10);   // from first byte to end of head
  std::chrono::milliseconds body = std::chrono::seconds(30);   // from end of head to end of body
  std::chrono::milliseconds write = std::chrono::seconds(30);  // the whole answer
};

/// A listening HTTP/1.1 port. The only thing the rest of the server knows of sockets; one source
/// file implements it.
class Transport {
 public:
  /// Binds and listens: from here on connections queue in the kernel. An error is text for the
  /// operator.
  [[nodiscard]] static tl::expected<Transport, std::string> open(const TransportOptions& options,
                                                                 Service service);
  Transport(Transport&&) noexcept;
  ~Transport();

  [[nodiscard]] int port() const;

  /// Serves until `drain`, and returns when every accepted request is answered. False when
  /// listening broke down.
  bool serve();

  /// True once `serve` accepts connections.
  [[nodiscard]] bool serving() const;

  /// From any thread: takes no new connection, closes idle ones, lets requests already begun be
  /// answered; those not finished within `patience` are cut off.
  void drain(std::chrono::milliseconds patience);

 private:
  struct Impl;
  explicit Transport(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> x_;
};

/// The status that a GET of `path` answers; nothing when nobody does within `patience`.
[[nodiscard]] std::optional<int> probe(const std::string& host, int port, const std::string& path,
                                       std::chrono::milliseconds patience);

}  // namespace tubecut::server
