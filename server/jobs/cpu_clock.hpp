#pragma once

#include <chrono>
#include <ctime>
#include <mutex>
#include <vector>

namespace tubecut::server {

/// CPU that one thread uses for one job. Any thread may read it while the job's thread lives.
class CpuClock {
 public:
  CpuClock() = default;
  /// Begins now, in the thread whose CPU counts.
  [[nodiscard]] static CpuClock of_this_thread();

  [[nodiscard]] std::chrono::nanoseconds used() const;
  /// What was used stands, as it was last read; the thread may end.
  void stop(std::chrono::nanoseconds used);

 private:
  [[nodiscard]] std::chrono::nanoseconds read() const;

  bool runs_ = false;
  clockid_t clock_{};
  std::chrono::nanoseconds begin_{0};
  std::chrono::nanoseconds used_{0};
};

/// CPU that threads other than its own use for one job. Any thread may read it.
class HelpersCpu {
 public:
  /// While it lives, this thread's CPU counts for the job.
  class Share {
   public:
    explicit Share(HelpersCpu& all);
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;
    ~Share();

   private:
    HelpersCpu& all_;
    CpuClock clock_ = CpuClock::of_this_thread();
  };

  [[nodiscard]] std::chrono::nanoseconds used() const;
  [[nodiscard]] int threads() const;

 private:
  mutable std::mutex mutex_;
  std::vector<const CpuClock*> running_ = {};
  std::chrono::nanoseconds done_{0};
};

}  // namespace tubecut::server
