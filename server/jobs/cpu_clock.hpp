#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
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
  /// What was used stands, as it was last read; the thread may end.
  void stop(std::chrono::nanoseconds used);

 private:
  friend class CpuLimit;
  [[nodiscard]] std::chrono::nanoseconds read() const;

  bool runs_ = false;
  clockid_t clock_{};
  std::chrono::nanoseconds begin_{0};
  std::chrono::nanoseconds used_{0};
};

/// Bytes of memory that a job holds now.
struct HeldBytes {
  std::atomic<std::size_t> own = 0;      // taken by its thread
  std::atomic<std::size_t> helpers = 0;  // by those that help
};

/// CPU that the threads of one job may use together. Each that works at it is told by the kernel
/// itself, within a tick of its clock, when its share of what is left is used: then all clocks are
/// read, and what is left is shared again. Whoever looks from another thread has to be given a CPU
/// first, which on a crowded host takes tens of milliseconds. None where the kernel has no timer
/// left. A job is stopped so much before that it has given back by then what it holds.
class CpuBudget {
 public:
  /// That may work at one job at a time.
  static constexpr std::size_t kThreads = 16;

  /// `held`: nullptr: nobody counts it.
  explicit CpuBudget(std::stop_source& stop, const HeldBytes* held = nullptr)
      : stop_(stop), held_(held) {}

  /// Shares what is left, or stops the job: false. From a signal's handler too: a stop is a few
  /// atomic operations here, for no job has callbacks of its stop token.
  bool look();

  /// CPU that the job takes to give back what it holds, once it is stopped.
  [[nodiscard]] std::chrono::nanoseconds to_give_back() const;

 private:
  friend class CpuLimit;

  struct Part {
    std::atomic<bool> taken = false, runs = false;
    std::atomic<clockid_t> clock{};
    std::atomic<std::int64_t> begin_ns = 0;
    std::atomic<timer_t> timer{};

    [[nodiscard]] std::chrono::nanoseconds used() const;
  };
  Part* take_part();

  std::stop_source& stop_;
  const HeldBytes* held_;
  std::atomic<bool> shared_ = false;  // by several threads, now or before
  std::atomic<std::int64_t> most_ns_ = 0;
  std::atomic<std::int64_t> done_ns_ = 0;  // of those that no longer work at it
  std::array<Part, kThreads> parts_ = {};
};

/// This thread works at the job whose budget it is, which is so much in all; 0: it has none. Its
/// CPU counts from the beginning of `clock`, which is this thread's.
class CpuLimit {
 public:
  CpuLimit(CpuBudget& budget, std::chrono::nanoseconds most, const CpuClock& clock);
  CpuLimit(const CpuLimit&) = delete;
  CpuLimit& operator=(const CpuLimit&) = delete;
  ~CpuLimit() { end(); }

  /// The thread has done its part: what it used of the budget, by its clock.
  std::chrono::nanoseconds end();

 private:
  CpuBudget& budget_;
  CpuClock clock_;
  CpuBudget::Part* part_ = nullptr;
  bool ended_ = false;
};

}  // namespace tubecut::server
