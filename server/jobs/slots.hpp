#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "server/http/fair_queue.hpp"
#include "server/http/http.hpp"
#include "server/http/memory_share.hpp"
#include "server/http/printer.hpp"
#include "server/http/sleepers.hpp"
#include "server/jobs/cpu_clock.hpp"
#include "server/jobs/helpers.hpp"

namespace tubecut::server {

class Strand;

/// A whole request on its way to an answer.
struct Job {
  Request request = {};
  std::stop_source stop = {};
  std::atomic<bool> close = false;  // the connection ends after the answer
  MemoryShare memory = {};
  std::mutex growing = {};           // of memory, while several threads work at it
  std::weak_ptr<Strand> owner = {};  // whom its end wakes; none once nobody waits for it
  Budget budget = {};
  std::chrono::steady_clock::time_point end =
      std::chrono::steady_clock::time_point::max();  // of its budget by the wall's clock
  std::chrono::steady_clock::time_point due =
      std::chrono::steady_clock::time_point::max();  // when the port has to check it
  Claim claim = {};
  bool is_short = false;   // its class
  bool begun = false;      // of the slots' mutex
  CpuClock cpu = {};       // of the slots' mutex; its thread's while it runs
  HelpersCpu helped = {};  // by threads other than its own
  bool displaced = false;  // known to the port: it lost its place in the queue
  Printed answer = {};
  std::optional<Response> begins = {};  // instead: an answer that its lines' answers follow
  bool refused = false;                 // of a batch's line: its answer is a problem
  bool malformed = false;               // of a batch's line: it is no job
  bool ahead = false;                   // of a batch's line: begun before its time
  bool finished = false;                // known to the port
  std::shared_ptr<Job> next = {};       // handed over to the port after this one
};

/// CPU of all threads for a job that a slot has begun. In its thread, or with the slots' mutex.
[[nodiscard]] std::chrono::nanoseconds used(const Job& job);

/// The threads that compute, and the bounded queues before them, one for short jobs and one for
/// long ones. A slot takes from both alternately, so neither class waits for ever. In addition, one
/// thread takes only short jobs, so these never wait until a long one ends.
class Slots {
 public:
  using Step = std::function<void(std::shared_ptr<Job>)>;

  /// `work`, then `done` run in a slot's thread and must not throw; at `done` the slot is free.
  Slots(int count, std::size_t queue, Step work, Step done);
  ~Slots() { join(); }
  Slots(const Slots&) = delete;
  Slots& operator=(const Slots&) = delete;

  /// Ends the threads once the jobs that have begun are done; queued ones are dropped.
  void join();

  /// Whether it has not begun yet.
  [[nodiscard]] bool waits(const Job& job) const;

  struct Offer {
    bool taken = false;                   // false: the queue of its class is full
    std::shared_ptr<Job> displaced = {};  // another's, which lost its place
  };
  [[nodiscard]] Offer offer(const std::shared_ptr<Job>& job);

  /// Takes back a job that no slot has begun; false when one has.
  [[nodiscard]] bool withdraw(const std::shared_ptr<Job>& job);

  /// See Helpers; of a job that a slot has begun, by threads that hold none.
  void run_parallel(std::size_t count, const ParallelTask& task, const Helpers::Within& within) {
    helpers_.run_parallel(count, task, within);
  }

  /// CPU that the job has used since a slot began it. From any thread.
  [[nodiscard]] std::chrono::nanoseconds cpu(const Job& job) const;

  /// That compute, of so many slots.
  [[nodiscard]] static std::size_t threads(int slots);

  [[nodiscard]] std::size_t waiting() const { return waiting_; }
  [[nodiscard]] int busy() const { return busy_; }
  [[nodiscard]] int count() const { return count_; }

 private:
  void run(bool in_slot);
  [[nodiscard]] FairQueue& queue_of(const Job& job) { return job.is_short ? short_ : long_; }
  [[nodiscard]] std::shared_ptr<Job> pop(bool in_slot);
  [[nodiscard]] std::shared_ptr<Job> next(bool in_slot);
  [[nodiscard]] Sleepers* call_one(bool is_short);
  void finish(Job& job, bool in_slot, std::chrono::nanoseconds own);
  void count_waiting();

  Step work_;
  Step done_;
  int count_;
  std::size_t queue_;  // the most jobs of a class that wait
  mutable std::mutex mutex_;
  Sleepers slots_, extra_;  // the slots' threads, and the one for short jobs only
  int back_ = 0;            // slots' threads that are done with a job and look for the next
  FairQueue short_, long_;
  bool long_next_ = false;  // whether a slot takes a long job next
  int in_slots_ = 0;
  int in_extra_ = 0;
  bool ending_ = false;
  std::atomic<std::size_t> waiting_ = 0;
  std::atomic<int> busy_ = 0;
  Helpers helpers_;
  std::vector<std::thread> threads_;
};

}  // namespace tubecut::server
