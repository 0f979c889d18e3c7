#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/http/connection_quota.hpp"
#include "server/http/loop.hpp"
#include "server/http/memory_share.hpp"
#include "server/http/printer.hpp"
#include "server/http/request_reader.hpp"
#include "server/http/transport.hpp"
#include "server/jobs/job_memory.hpp"
#include "server/jobs/slots.hpp"

namespace tubecut::server {

class Session;

/// Monotonic seconds.
[[nodiscard]] double seconds(Clock::time_point time);

/// See TransportStats.
struct PortCounters {
  std::atomic<std::uint64_t> connections{0}, queue{0}, wait{0}, memory{0}, full{0}, hung_up{0},
      over_time{0};
};

/// The state that the connections of a port share. Only for its loop's thread, except as noted.
class Port {
 public:
  Port(const TransportOptions& options, Service service);
  ~Port();
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  /// Runs the loop until `end`, and then until all pending answers are sent.
  void run();
  /// From any thread: calls `what` in the loop's thread, soon.
  void tell(std::function<void()> what);

  /// Takes over an accepted socket.
  void open(Socket socket);
  void forget(Session& session);
  /// From here on each answer is its connection's last.
  void close_connections();
  void drain(std::chrono::milliseconds patience);
  /// No more sockets will be opened: `run` may return.
  void end() { ending_ = true; }
  void cancel_jobs();

  /// Returns the largest body of such a request that fits in the memory. A batch's lines are
  /// separate jobs.
  [[nodiscard]] std::size_t room_for_body(const Request& head) const;
  /// Memory to set aside for a job: all that it takes until it is answered, its answer too.
  [[nodiscard]] std::size_t memory_of(const Request& request) const;
  /// Of requests on their way, those that hold most make room for the others.
  void bound_arrivals();
  /// Returns whether this number of bytes is free; if necessary, first closes the clients that are
  /// slowest to take their answers.
  [[nodiscard]] bool make_memory(std::size_t bytes);
  /// Clients slowest to take their answers give way while little is free: running jobs may grow.
  void keep_memory_free();
  /// Queues the job; false when the queue is full.
  [[nodiscard]] bool offer(const std::shared_ptr<Job>& job);

  /// Sets the job's budget, which counts from now.
  void set_budget(Job& job) const;
  /// Of a job that a slot has begun: stops it when its budget is used up, else sets when that can
  /// be at the earliest.
  void hold_to_budget(Job& job) const;

  /// The answer to a request, printed; `close`: the connection ends with it. From any thread.
  [[nodiscard]] Printed answer(const Request& request, const std::atomic<bool>& close) const;

  /// From any thread.
  [[nodiscard]] TransportStats stats() const;

  const TransportOptions options;
  const Service service;
  const ReaderLimits limits;
  MemoryBound memory;     // for bodies, jobs and answers
  MemoryBound arriving;   // of it: requests not yet whole
  MemoryBound lines;      // of it: batches' lines not yet begun
  ConnectionQuota quota;  // of clients
  PortCounters counters;
  Loop loop;              // after what sessions hold shares of: it may keep the last of them
  bool stopping = false;  // soon to be drained
  bool draining = false;
  Clock::time_point drain_began;
  Clock::time_point drained_by = Clock::time_point::max();
  std::string scratch;  // the bytes that a session has just received

 private:
  void work(Job& job);
  void run_parallel(Job& job, std::size_t count, const ParallelTask& task);
  void answer(Job& job) const;
  [[nodiscard]] Response respond(const Request& request) const;
  [[nodiscard]] Printed printed(Response response, const Request& request,
                                const std::atomic<bool>& close) const;
  [[nodiscard]] JobMemory::Grant grow(Job& job, std::size_t bytes) const;
  void hand_over(std::shared_ptr<Job> job);
  void take_messages();
  [[nodiscard]] bool make_room(const std::string& of_peer);

  std::list<std::shared_ptr<Session>> sessions_;
  bool ending_ = false;

  std::mutex mutex_;  // guards the data that other threads leave for the loop
  std::shared_ptr<Job> finished_;
  std::vector<std::function<void()>> told_;

 public:
  Slots slots;  // last, because its threads use the members above
};

}  // namespace tubecut::server
