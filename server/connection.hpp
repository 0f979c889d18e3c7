#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace tubecut::server {

using Clock = std::chrono::steady_clock;

/// Tells every connection of a port that it shall end. One event descriptor wakes all who wait.
class Drain {
 public:
  Drain();
  ~Drain();
  Drain(const Drain&) = delete;
  Drain& operator=(const Drain&) = delete;

  void begin(std::chrono::milliseconds patience);
  [[nodiscard]] bool begun() const { return begun_; }
  /// When everything still unfinished is cut off; the end of time before `begin`.
  [[nodiscard]] Clock::time_point deadline() const { return Clock::time_point{deadline_.load()}; }
  /// Readable for ever once begun.
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
  std::atomic<bool> begun_ = false;
  std::atomic<Clock::duration> deadline_ = Clock::duration::max();
};

/// One accepted socket: buffered reading under a byte budget and an absolute deadline, so that no
/// client can hold a thread or memory for longer than configured, and one send per answer.
class Connection {
 public:
  /// Owns the descriptor from now on.
  Connection(int descriptor, const Drain& drain);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Waits for the first byte of a request. False when none comes, or the port drains and nothing
  /// is on its way.
  [[nodiscard]] bool wait(std::chrono::milliseconds patience);

  /// From now on at most so many bytes, until so long from now.
  void allow(std::size_t bytes, std::chrono::milliseconds time);

  /// Bytes read, 0 at the end of the stream, -1 when the budget, the time or the socket is spent.
  ssize_t read(char* out, std::size_t size);
  [[nodiscard]] bool readable() const { return next_ < filled_; }

  /// Collects bytes; `flush` sends them. A flush comes before any read that waits.
  void write(std::string_view bytes) { out_.append(bytes); }
  [[nodiscard]] bool flush();
  void allow_write(std::chrono::milliseconds time) { write_time_ = time; }

  /// After an answer to a request that was not read to its end: lets the client read the answer
  /// before the socket goes.
  void linger();

  [[nodiscard]] std::string peer() const;
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  [[nodiscard]] bool poll_for(short events, Clock::time_point until) const;

  int descriptor_;
  const Drain& drain_;
  bool first_ = true;
  std::vector<char> in_;
  std::size_t next_ = 0;
  std::size_t filled_ = 0;
  std::string out_;
  std::size_t budget_ = 0;
  Clock::time_point deadline_ = Clock::time_point::max();
  std::chrono::milliseconds write_time_{30000};
};

}  // namespace tubecut::server
