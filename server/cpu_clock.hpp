#pragma once

#include <chrono>
#include <ctime>
#include <stop_token>

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

/// Asks for a stop as soon as this thread has used so much more CPU: the kernel tells the thread
/// itself, within a tick of its clock. Whoever looks from another thread has to be given a CPU
/// first, which on a crowded host takes tens of milliseconds. None where the kernel has no timer
/// left.
class CpuLimit {
 public:
  CpuLimit(std::stop_source& stop, std::chrono::nanoseconds most);
  CpuLimit(const CpuLimit&) = delete;
  CpuLimit& operator=(const CpuLimit&) = delete;
  ~CpuLimit();
};

}  // namespace tubecut::server
