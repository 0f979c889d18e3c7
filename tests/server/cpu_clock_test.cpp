#include "server/jobs/cpu_clock.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace tubecut::server {
namespace {

using namespace std::chrono_literals;

/// Works until a stop is requested, and returns the used CPU.
std::chrono::nanoseconds worked(const std::stop_token& stop) {
  const auto cpu = CpuClock::of_this_thread();
  while (!stop.stop_requested() && cpu.used() < 5s) {
  }
  return cpu.used();
}

TEST(CpuLimit, StopsAThreadByItsOwnTime) {
  std::jthread([] {
    for (const auto most : {20ms, 50ms}) {
      std::stop_source stop;
      CpuBudget budget(stop);
      const CpuLimit limit(budget, most, CpuClock::of_this_thread());
      const auto used = worked(stop.get_token());
      EXPECT_GE(used, most);
      EXPECT_LT(used, 1s);
    }
  }).join();
}

TEST(CpuLimit, DoesNotCountWaiting) {
  std::stop_source stop;
  CpuBudget budget(stop);
  const CpuLimit limit(budget, 200ms, CpuClock::of_this_thread());
  std::this_thread::sleep_for(300ms);
  EXPECT_FALSE(stop.stop_requested());
}

TEST(CpuLimit, EndsWithItsJob) {
  std::stop_source first;
  CpuBudget of_first(first);
  { const CpuLimit limit(of_first, 20ms, CpuClock::of_this_thread()); }
  std::stop_source none;
  CpuBudget of_none(none);
  const auto cpu = CpuClock::of_this_thread();
  const CpuLimit limit(of_none, 0ms, cpu);  // no budget
  while (cpu.used() < 60ms) {
  }
  EXPECT_FALSE(first.stop_requested());
  EXPECT_FALSE(none.stop_requested());
}

// The timer stays set from one job to the next: as it was for a longer one, a shorter one, one
// that had all its time.
TEST(CpuLimit, IsIndependentOfThePreviousJob) {
  using std::chrono::nanoseconds;
  nanoseconds latest{0};
  const auto in_turn = [&latest] {
    latest = nanoseconds(0);
    const auto stopped_after = [](nanoseconds most, nanoseconds part) {
      std::stop_source stop;
      CpuBudget budget(stop);
      const auto cpu = CpuClock::of_this_thread();
      CpuLimit limit(budget, most, cpu);
      while (!stop.stop_requested() && cpu.used() < part) {
      }
      EXPECT_EQ(stop.stop_requested(), part > most);
      return limit.end();
    };
    for (int i = 0; i < 1000; ++i) stopped_after(2s, 0s);
    for (const auto most : {100ms, 30ms, 200ms, 30ms}) {
      const auto used = stopped_after(most, 5s);
      EXPECT_GE(used, most);
      latest = std::max(latest, used - most);
      stopped_after(300ms, 250ms);  // its timer would end the next one late, the last one's early
    }
  };
  // A virtual machine pauses at times, and its clocks go on, so one late run proves nothing.
  for (int tries = 0; tries < 3 && (tries == 0 || latest >= 50ms); ++tries)
    std::jthread(in_turn).join();
  EXPECT_LT(latest, 50ms);
}

// Whenever they begin and end: a thread that joins late, one that has done its part, one that
// waits.
TEST(CpuLimit, IsOfAllThreadsOfAJobTogether) {
  constexpr auto kMost = 200ms;
  for (const auto late : {0ms, 30ms}) {
    std::stop_source stop;
    CpuBudget budget(stop);
    std::atomic<std::int64_t> used = 0;
    const auto work = [&](std::chrono::milliseconds waits, std::chrono::nanoseconds part) {
      std::this_thread::sleep_for(waits);
      const auto cpu = CpuClock::of_this_thread();
      const CpuLimit limit(budget, kMost, cpu);
      while (!stop.stop_requested() && cpu.used() < part) {
      }
      used += cpu.used().count();
    };
    {
      std::vector<std::jthread> threads;
      threads.emplace_back(work, 0ms, 5s);
      threads.emplace_back(work, late, 5s);
      threads.emplace_back(work, late, 20ms);
    }
    EXPECT_TRUE(stop.stop_requested());
    EXPECT_GE(std::chrono::nanoseconds(used), kMost - 1ms);
    EXPECT_LT(std::chrono::nanoseconds(used), kMost + 100ms);  // each would have had all of it
  }
}

// It may come to hold much once it has run for long: from then on it is stopped sooner.
TEST(CpuLimit, StopsInTimeToFreeTheJobsMemory) {
  constexpr auto kMost = 400ms;
  std::chrono::nanoseconds used{0};
  const auto job = [&used, kMost] {
    std::stop_source stop;
    HeldBytes held;
    CpuBudget budget(stop, &held);
    const auto cpu = CpuClock::of_this_thread();
    const CpuLimit limit(budget, kMost, cpu);
    while (!stop.stop_requested() && cpu.used() < 300ms) {
    }
    ASSERT_FALSE(stop.stop_requested());
    held.own = std::size_t{192} << 20;
    held.helpers = std::size_t{64} << 20;
    worked(stop.get_token());
    used = cpu.used();
    EXPECT_GE(budget.to_give_back(), 40ms);  // 0.16 ms per MiB were measured and more
    EXPECT_GE(used, kMost - budget.to_give_back());
  };
  for (int tries = 0; tries < 3 && (tries == 0 || used >= kMost); ++tries)  // as above
    std::jthread(job).join();
  EXPECT_LT(used, kMost);
}

TEST(CpuLimit, LeavesTheWholeBudgetToAJobWithoutMemory) {
  constexpr auto kMost = 200ms;
  std::stop_source stop;
  HeldBytes held{.own = std::size_t{256} << 20};
  CpuBudget budget(stop, &held);
  const auto cpu = CpuClock::of_this_thread();
  const CpuLimit limit(budget, kMost, cpu);
  while (!stop.stop_requested() && cpu.used() < 110ms) {
  }
  held.own = 0;
  worked(stop.get_token());
  EXPECT_GE(cpu.used(), kMost);
}

// Who has left a job works at the next: the shares of those who stay are not its own.
TEST(CpuLimit, OfAJobThatAThreadHasLeftIsNotTheNextOnes) {
  std::stop_source first, next;
  CpuBudget of_first(first), of_next(next);
  std::jthread stays([&] {
    const CpuLimit limit(of_first, 60ms, CpuClock::of_this_thread());
    worked(first.get_token());
  });
  { const CpuLimit limit(of_first, 60ms, CpuClock::of_this_thread()); }
  const auto cpu = CpuClock::of_this_thread();
  const CpuLimit limit(of_next, 5s, cpu);
  while (!first.stop_requested() || cpu.used() < 60ms) {
  }
  EXPECT_FALSE(next.stop_requested());
}

}  // namespace
}  // namespace tubecut::server
