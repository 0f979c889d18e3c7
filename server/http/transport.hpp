#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "server/http/http.hpp"

namespace tubecut::server {

/// The functions that a transport requires of the application behind it. The slots' threads and the
/// port's own call `handle`; only the port's own calls the others.
struct Service {
  /// Answers one request: whole, or with the reason why it could not be read.
  std::function<Response(const Request&)> handle;
  /// Whether the body is worth reading. It is not read when this names a reason.
  std::function<std::optional<Refusal>(const Request& head)> screen;
  /// Largest body to read, in bytes.
  std::function<std::size_t(std::string_view target)> max_body;
  /// Whether a whole request may queue for a slot; empty: always.
  std::function<std::optional<Refusal>(const Request&)> admit = {};
  /// Returns whether the request's body is a batch, of which each line is a job that `line` answers
  /// as soon as it is done; empty: no batches.
  std::function<bool(const Request&)> is_batch = {};
  /// The head of a batch's answer: status and headers. Anything but 200 is its whole answer.
  std::function<Response(const Request&)> batch_head = {};
  /// Answers the line in `Request::body`, the `Request::line`-th of a batch.
  std::function<BatchReply(const Request&)> line = {};
  /// The last line of a batch's answer, as the body: the batch with that head is over.
  std::function<Response(const Request& head, const BatchCount&)> summary = {};
  /// Bytes of memory to reserve for a job before it begins; empty: those of its body.
  std::function<std::size_t(const Request&)> memory = {};
  /// The same of a line of a batch.
  std::function<std::size_t(std::string_view line)> line_memory = {};
  /// Returns the largest body whose job fits in the memory; empty: no limit.
  std::function<std::size_t(std::string_view target)> room = {};
  /// Returns the client of the request, for the fair queue. Empty: the address.
  std::function<std::string(const Request&)> client = {};
  /// Returns whether the job is short, so that it need not wait for long ones; empty: none is.
  std::function<bool(const Request&)> is_short = {};
  /// Returns whether many clients come from that address, a proxy's; empty: no shared address.
  std::function<bool(const std::string& peer)> is_shared = {};
  /// Time for the job; empty: no end.
  std::function<Budget(const Request&)> budget = {};
};

struct TransportOptions {
  std::string host = "127.0.0.1";
  int port = 0;            // 0: any free one
  int connections = 4096;  // open at a time; beyond, the longest idle one is closed
  int per_client = 0;      // of those, one client's at most; 0: half
  int slots = 1;           // jobs computed at a time, each by a thread
  std::size_t queue = 64;  // jobs that wait for a slot
  std::size_t memory = 0;  // bytes for bodies, jobs and answers together; 0: no bound
  std::size_t max_head_bytes = 16384;
  std::size_t max_fields = 64;
  std::chrono::milliseconds idle =
      std::chrono::seconds(15);  // a kept-alive connection without a request
  std::chrono::milliseconds head = std::chrono::seconds(3);    // from first byte to end of head
  std::chrono::milliseconds body = std::chrono::seconds(10);   // from end of head to end of body
  std::chrono::milliseconds write = std::chrono::seconds(10);  // the whole answer
};

/// Returns the bytes that jobs and answers share; the largest number if there is no bound.
[[nodiscard]] std::size_t memory_for_jobs(const TransportOptions& options);

/// How a port is doing, for the metrics. Counters since the start.
struct TransportStats {
  std::uint64_t connections = 0;
  std::uint64_t waiting = 0;
  std::uint64_t busy = 0;
  std::uint64_t slots = 0;
  std::uint64_t memory = 0;          // bytes set aside now
  std::uint64_t memory_bound = 0;    // bytes for bodies, jobs and answers; 0: no bound
  std::uint64_t refused_queue = 0;   // the queue was full
  std::uint64_t refused_wait = 0;    // no slot within half the budget
  std::uint64_t refused_memory = 0;  // the bound on memory
  std::uint64_t refused_connections = 0;
  std::uint64_t hung_up = 0;    // clients that left before their answer
  std::uint64_t over_time = 0;  // clients too slow to send or to take
};

/// A listening HTTP/1.1 port. The only thing the rest of the server knows of sockets; server/http
/// implements it.
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

  [[nodiscard]] TransportStats stats() const;

  /// From any thread: from here on each answer says `Connection: close`, so that clients go
  /// elsewhere before the port drains.
  void close_connections();

  /// From any thread: takes no new connection, closes idle ones, lets requests already begun be
  /// answered; those not read within `patience` are cut off.
  void drain(std::chrono::milliseconds patience);

  /// From any thread: stops the jobs that still run or wait.
  void cancel_jobs();

 private:
  struct Impl;
  explicit Transport(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> x_;
};

}  // namespace tubecut::server
