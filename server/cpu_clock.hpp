#pragma once

#include <chrono>
#include <ctime>

namespace tubecut::server {

/// CPU that one thread uses for one job. Any thread may read it while the job's thread lives.
class CpuClock {
 public:
  CpuClock() = default;
  /// Begins now, in the thread whose CPU counts.
  [[nodiscard]] static CpuClock of_this_thread();

  [[nodiscard]] std::chrono::nanoseconds used() const;
  /// What was used stands; the thread may end.
  void stop();

 private:
  [[nodiscard]] std::chrono::nanoseconds read() const;

  bool runs_ = false;
  clockid_t clock_{};
  std::chrono::nanoseconds begin_{0};
  std::chrono::nanoseconds used_{0};
};

}  // namespace tubecut::server
