#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>
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
      std::chrono::steady_clock::time_point::max();  // when the port has to look at it
  std::string_view kind = {};                        // jobs of a kind take about as long
  Claim claim = {};
  bool in_lane = false;                     // of the slots' mutex
  double began_s = 0.0;                     // of the slots' mutex; 0: it waits
  CpuClock cpu = {};                        // of the slots' mutex; its thread's while it runs
  HeldBytes held = {};                      // while it runs
  CpuBudget all_cpu{stop, &held};           // of all threads that work at it
  std::atomic<std::int64_t> helped_ns = 0;  // CPU that others than its thread have had for it
  std::atomic<int> helped_by = 0;
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

/// The threads that compute, and the bounded queue before them. Beside the slots there is a lane
/// for jobs that are expected to be quick: long ones never wait in front of them. A job that turns
/// out not to be makes room in the lane and counts among the long ones.
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

  /// Expected seconds until the job's turn, from what runs and waits now.
  [[nodiscard]] double expected_wait(Job& job) const;

  /// Whether it has not begun yet.
  [[nodiscard]] bool waits(const Job& job) const;

  struct Offer {
    bool taken = false;                   // false: the queue is full
    std::shared_ptr<Job> displaced = {};  // another's, which lost its place
  };
  [[nodiscard]] Offer offer(const std::shared_ptr<Job>& job);

  /// Takes back a job that no slot has begun; false when one has.
  [[nodiscard]] bool withdraw(const std::shared_ptr<Job>& job);

  /// To be called now and then while the job waits or runs: it takes the lane, or has outgrown it.
  void look(Job& job);

  /// See Helpers; of a job that a slot has begun, by threads that hold none.
  void take_turns(std::size_t count, const Turn& turn, const Helpers::Within& within) {
    helpers_.take_turns(count, turn, within);
  }

  /// CPU that the job has used since a slot began it. From any thread.
  [[nodiscard]] std::chrono::nanoseconds cpu(const Job& job) const;

  /// That compute, of so many slots.
  [[nodiscard]] static std::size_t threads(int slots);

  [[nodiscard]] std::size_t waiting() const { return waiting_; }
  [[nodiscard]] int busy() const { return busy_; }
  [[nodiscard]] int count() const { return count_; }

 private:
  void run(bool quick_only);
  [[nodiscard]] std::shared_ptr<Job> next(bool quick_only);
  [[nodiscard]] Sleepers* call_one(bool quick);
  [[nodiscard]] Sleepers* call_any(bool quick);
  void estimate(Job& job) const;
  void leave_lane(Job& job);
  [[nodiscard]] bool has_spare() const;
  void finish(Job& job, std::chrono::nanoseconds own);
  void tell_helpers();
  void learn(const Job& job, double took);
  [[nodiscard]] const double* mean_of(const Job& job) const;

  Step work_;
  Step done_;
  int count_;
  std::size_t most_;
  mutable std::mutex mutex_;
  Sleepers any_, quick_;  // the threads that do any job, and the one that does quick ones alone
  int back_ = 0;          // threads that are done with a job and have not looked for the next
  FairQueue queue_;
  using Means = std::map<std::string_view, double>;  // seconds, by kind
  Means means_;
  std::map<std::string, Means, std::less<>> of_clients_;
  std::vector<std::shared_ptr<Job>> running_;  // in slots and in the lane
  int in_slots_ = 0;
  int in_lane_ = 0;
  bool ending_ = false;
  std::atomic<std::size_t> waiting_ = 0;
  std::atomic<int> busy_ = 0;
  Helpers helpers_;
  std::vector<std::thread> threads_;
};

}  // namespace tubecut::server
