#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/request_reader.hpp"
#include "server/slots.hpp"

namespace tubecut::server {

using Clock = std::chrono::steady_clock;

/// A batch on its way: its lines become jobs, a few at a time.
struct Batch {
  Request head;                                  // what every line's request has in common
  std::string lines;                             // the body
  std::size_t at = 0;                            // of the next line
  std::size_t line = 0;                          // lines begun
  bool stopped = false;                          // no further line begins
  std::optional<Clock::time_point> waits_since;  // for memory
  bool chunked = true;  // the answer; else the connection's end ends it (HTTP/1.0)
  BatchCount count;
  std::vector<std::shared_ptr<Job>> running;
  bool paid = true;      // its key's rate has let the next line in; the first came with the batch
  std::size_t owed = 0;  // bytes the client has to take until `stalled`
  Clock::time_point stalled = Clock::time_point::max();  // when a client too slow is cut off
  Clock::time_point again = Clock::time_point::max();    // when a full queue is asked again
};

/// One accepted socket as the port sees it: owned and touched by the port's thread alone.
class Connection {
 public:
  enum class State {
    idle,      // between requests
    head,      // a request's head is on its way
    body,      // its body
    working,   // a job waits for a slot or runs
    batching,  // the lines of a batch are worked on and answered
    writing,   // the answer is on its way
    lingering  // nothing more is answered; lets the client read what was
  };

  /// Owns the descriptor from now on and makes it non-blocking.
  Connection(int descriptor, const ReaderLimits& limits);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  [[nodiscard]] bool reading() const {
    return state == State::idle || state == State::head || state == State::body;
  }

  /// Bytes from the socket; 0 at its end, -1 when there are none now, -2 when it broke.
  ssize_t receive(char* out, std::size_t size) const;

  /// Sends what it can of `out`. True when nothing is left; nothing when the socket broke.
  [[nodiscard]] std::optional<bool> send();

  /// Sends a few bytes that fit any socket's buffer.
  void send_now(std::string_view bytes) const;

  /// Says that no more is sent.
  void finish_sending() const;

  /// Calls `sent`, once.
  void report(bool whole) {
    if (auto tell = std::exchange(sent, nullptr)) tell(whole);
  }

  /// Back to waiting for a request.
  void restart(const ReaderLimits& limits);

  int descriptor;
  std::string peer;  // numeric address
  State state = State::idle;
  bool fresh = true;     // no request yet
  bool readable = true;  // the socket may hold bytes
  bool half_closed = false;
  bool closing = false;  // ends with the answer being made or sent
  bool unread = false;   // bytes of the last request may still come
  bool queued_again = false;
  bool has_more = false;  // whole requests left for another turn
  RequestReader reader;
  std::string in;  // received, not yet taken by the reader
  std::string out;
  std::size_t out_at = 0;
  std::size_t lingered = 0;
  std::size_t held = 0;  // bytes that came in, as the bound on memory counts them
  std::shared_ptr<Job> job;
  std::unique_ptr<Batch> batch;
  std::function<void(bool)> sent;
  Clock::time_point received;
  Clock::time_point deadline = Clock::time_point::max();
  Clock::time_point gone_by = Clock::time_point::max();  // half-closed: taken for gone
  Clock::time_point ends_by = Clock::time_point::max();  // lingering
  Clock::time_point begun;                               // writing
};

}  // namespace tubecut::server
