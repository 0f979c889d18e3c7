#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "server/http.hpp"

namespace tubecut::server {

/// A whole request on its way to an answer.
struct Job {
  Request request = {};
  std::stop_source stop = {};
  std::atomic<bool> close = false;  // the connection ends after the answer
  std::size_t memory = 0;           // bytes set aside for it
  void* owner = nullptr;            // the connection it came from; nullptr once that is gone
  std::chrono::steady_clock::time_point end =
      std::chrono::steady_clock::time_point::max();  // of its budget
  std::string answer = {};
  std::function<void(bool)> sent = {};
  bool refused = false;  // of a batch's line: its answer is a problem
};

/// Bytes to set aside for a job by those of its body.
[[nodiscard]] std::size_t memory_of(std::size_t body);

/// The threads that compute, and the bounded queue before them.
class Slots {
 public:
  using Step = std::function<void(std::shared_ptr<Job>)>;

  /// `work`, then `done` run in a slot's thread and shall not throw; at `done` the slot is free.
  Slots(int count, std::size_t queue, Step work, Step done);
  ~Slots() { join(); }
  Slots(const Slots&) = delete;
  Slots& operator=(const Slots&) = delete;

  /// Ends the threads once the jobs that have begun are done; queued ones are dropped.
  void join();

  /// Queues a job; false when the queue is full.
  [[nodiscard]] bool offer(std::shared_ptr<Job> job);

  /// Takes back a job that no slot has begun; false when one has.
  [[nodiscard]] bool withdraw(const std::shared_ptr<Job>& job);

  [[nodiscard]] std::size_t waiting() const { return waiting_; }
  [[nodiscard]] int busy() const { return busy_; }
  [[nodiscard]] int count() const { return static_cast<int>(threads_.size()); }

 private:
  void run();

  Step work_;
  Step done_;
  std::size_t most_;
  std::mutex mutex_;
  std::condition_variable some_;
  std::deque<std::shared_ptr<Job>> queue_;
  bool ending_ = false;
  std::atomic<std::size_t> waiting_ = 0;
  std::atomic<int> busy_ = 0;
  std::vector<std::thread> threads_;
};

}  // namespace tubecut::server
