#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "server/connection.hpp"
#include "server/slots.hpp"
#include "server/transport.hpp"

namespace tubecut::server {

/// An answer as bytes for the wire.
struct Printed {
  std::string bytes;
  std::function<void(bool)> sent;
};

/// A port's one thread for sockets: parks every connection in epoll, collects whole requests under
/// byte caps and absolute deadlines, hands them to the slots, and sends their answers. Nothing a
/// client does, or leaves undone, holds more than its connection's memory.
class EventLoop {
 public:
  /// Answers a request and prints the answer; `close`: the connection ends with it. From any
  /// thread.
  using Print = std::function<Printed(const Request&, const std::atomic<bool>& close)>;

  EventLoop(const TransportOptions& options, const Service& service, Print print);
  ~EventLoop();
  EventLoop(const EventLoop&) = delete;
  EventLoop& operator=(const EventLoop&) = delete;

  /// Takes over an accepted socket. From any thread.
  void adopt(int descriptor);

  /// Runs until `end`, and then until nothing is left to answer.
  void run();

  void drain(std::chrono::milliseconds patience);
  /// No more sockets will be adopted: `run` may end.
  void end();
  void cancel_jobs();
  [[nodiscard]] TransportStats stats() const;

 private:
  /// Requests on their way hold one part of so many of the memory at most, and lines of batches
  /// another: whatever clients begin, jobs find theirs.
  static constexpr std::size_t kWaiting = 2;

  struct Counters {
    std::atomic<std::uint64_t> connections{0}, memory{0}, queue{0}, wait{0}, bytes{0}, full{0},
        hung_up{0}, over_time{0};
  };

  void wake() const;
  void work(Job& job) const;
  void take_messages();
  void accept(int descriptor);
  [[nodiscard]] bool make_room();
  void on_event(Connection& c, unsigned events);

  void pump(Connection& c);
  void look_again(Connection& c);
  std::size_t digest(Connection& c, std::string_view bytes);
  void account(Connection& c);
  void bound_arrivals();
  void drop_pipelined(Connection& c);
  [[nodiscard]] bool has_memory(std::size_t bytes) const;
  [[nodiscard]] bool make_memory(std::size_t bytes);
  [[nodiscard]] std::size_t room_for_body(const Request& head) const;
  void on_head(Connection& c, bool more_there);
  void on_whole(Connection& c);
  void on_end(Connection& c);
  [[nodiscard]] std::optional<Refusal> head_refusal(Connection& c) const;
  [[nodiscard]] bool in_time(const Job& job) const;
  [[nodiscard]] std::optional<Refusal> offer(Connection& c, const std::shared_ptr<Job>& job);

  [[nodiscard]] std::optional<Refusal> batch_refusal(const Request& whole);
  void begin_batch(Connection& c, const std::shared_ptr<Job>& job);
  void feed(Connection& c);
  [[nodiscard]] bool feed_line(Connection& c, std::string_view line);
  [[nodiscard]] bool has_memory_in_time(Batch& batch, std::size_t bytes);
  [[nodiscard]] bool over_wait(const Batch& batch) const;
  void forget_begun(Batch& batch);
  void say(Connection& c, const std::string& bytes);
  void answer_line(Connection& c, std::string_view text, bool refused);
  void finish_line(Connection& c, Job& job);
  void send_batch(Connection& c);
  void end_batch(Connection& c);
  void expire_batch(Connection& c);
  void drop_batch(Connection& c);
  void set_batch_deadline(Connection& c);

  void refuse(Connection& c, Refusal refusal);
  void refuse_unread(Connection& c, Refusal refusal);
  void finish(Job& job);
  void release(Job& job);
  void write(Connection& c, Printed answer);
  void begin_writing(Connection& c);
  void send(Connection& c);
  void linger(Connection& c);
  void close(Connection& c);

  void set_deadline(Connection& c, Clock::time_point when);
  void set_deadline(Connection& c, std::chrono::milliseconds from_now) {
    set_deadline(c, Clock::now() + from_now);
  }
  void expire_all();
  void expire(Connection& c);
  void begin_drain();
  [[nodiscard]] int wait_ms() const;

  TransportOptions options_;
  std::size_t memory_;  // of options_.memory what bodies and answers share; 0: no bound
  ReaderLimits limits_;
  const Service& service_;
  Print print_;
  int epoll_;
  int wake_;
  std::string scratch_;
  std::unordered_map<Connection*, std::unique_ptr<Connection>> connections_;
  std::vector<std::unique_ptr<Connection>> buried_;  // ended in this round of events
  std::vector<Connection*> again_;                   // have more bytes than one turn
  Clock::time_point soonest_ = Clock::time_point::max();
  std::size_t arriving_ = 0;  // bytes of requests not yet handed on
  std::size_t lines_ = 0;     // bytes of batches' lines not yet begun
  double mean_s_ = 0.0;       // of a job in its slot
  bool draining_ = false;
  bool ending_ = false;
  Clock::time_point drained_by_ = Clock::time_point::max();
  mutable Counters counters_;

  std::mutex mutex_;  // what other threads leave for this one
  std::vector<int> adopted_;
  std::vector<std::shared_ptr<Job>> finished_;
  std::chrono::milliseconds patience_{0};
  bool drain_asked_ = false;
  bool end_asked_ = false;
  bool cancel_asked_ = false;

  std::unique_ptr<Slots> slots_;  // last: its threads use what is above
};

}  // namespace tubecut::server
