#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "server/request_reader.hpp"
#include "server/slots.hpp"

namespace tubecut::server {

using Clock = std::chrono::steady_clock;

/// One accepted socket as the port sees it: owned and touched by the port's thread alone.
class Connection {
 public:
  enum class State {
    idle,      // between requests
    head,      // a request's head is on its way
    body,      // its body
    working,   // a job waits for a slot or runs
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
  RequestReader reader;
  std::string in;  // received, not yet taken by the reader
  std::string out;
  std::size_t out_at = 0;
  std::size_t lingered = 0;
  std::shared_ptr<Job> job;
  std::function<void(bool)> sent;
  Clock::time_point received;
  Clock::time_point deadline = Clock::time_point::max();
};

}  // namespace tubecut::server
