#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "core/base/parallel_for.hpp"
#include "server/jobs/cpu_clock.hpp"

namespace tubecut::server {

/// Threads, in addition to those of the slots, that run parallel tasks of running jobs while slots
/// are free: as many at a time as there are free slots. They hold no slot: a new job gets its slot
/// at once, and the helper leaves after its current task.
class Helpers {
 public:
  /// Of one job at a time.
  static constexpr std::size_t kMost = 15;

  /// The work of a thread for one job. `within` calls it once, in the job's context.
  using Stint = std::function<void()>;
  using Within = std::function<void(const Stint&)>;

  /// Starts fewer threads if the system gives no more; each begins with `started`.
  Helpers(std::size_t threads, const std::function<void()>& started);
  ~Helpers() { join(); }
  Helpers(const Helpers&) = delete;
  Helpers& operator=(const Helpers&) = delete;

  /// Ends the threads; jobs do the rest of their tasks themselves.
  void join();

  /// Sets how many threads may help from now on. From any thread.
  void allow(int most);

  /// See tubecut::ParallelFor; runs in the job's thread, which does tasks too. Each helping thread
  /// does so `within`, which must not throw.
  void run_parallel(std::size_t count, const ParallelTask& task, const Within& within);

 private:
  struct Work {
    std::size_t count;
    const ParallelTask& task;
    const Within& within;
    std::size_t next = 0;
    std::size_t helped_by = 0;
    std::size_t failed = 0;  // index of the first task that threw
    std::exception_ptr failure = nullptr;
    std::condition_variable left = {};
  };
  void run();
  [[nodiscard]] Work* some_work();
  void run_tasks(Work& work, bool helps);

  std::mutex mutex_;
  std::condition_variable some_;
  std::vector<Work*> works_;
  std::atomic<int> working_ = 0;  // how many works there are
  std::atomic<int> most_ = 0;
  int helping_ = 0;
  bool ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace tubecut::server
