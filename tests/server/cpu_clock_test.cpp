#include "server/cpu_clock.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace tubecut::server {
namespace {

using namespace std::chrono_literals;

/// Works until it is asked to stop, and tells what that took of its CPU.
std::chrono::nanoseconds worked(const std::stop_token& stop) {
  const auto cpu = CpuClock::of_this_thread();
  while (!stop.stop_requested() && cpu.used() < 5s) {
  }
  return cpu.used();
}

TEST(CpuLimit, StopsAThreadByItsOwnTimeWhoeverElseLooks) {
  std::jthread([] {
    for (const auto most : {20ms, 50ms}) {
      std::stop_source stop;
      const CpuLimit limit(stop, most);
      const auto used = worked(stop.get_token());
      EXPECT_GE(used, most);
      EXPECT_LT(used, 1s);
    }
  }).join();
}

TEST(CpuLimit, DoesNotCountWhatAThreadWaits) {
  std::stop_source stop;
  const CpuLimit limit(stop, 200ms);
  std::this_thread::sleep_for(300ms);
  EXPECT_FALSE(stop.stop_requested());
}

TEST(CpuLimit, EndsWithItsJob) {
  std::stop_source first;
  { const CpuLimit limit(first, 20ms); }
  std::stop_source none;
  const CpuLimit limit(none, 0ms);  // no budget
  const auto cpu = CpuClock::of_this_thread();
  while (cpu.used() < 60ms) {
  }
  EXPECT_FALSE(first.stop_requested());
  EXPECT_FALSE(none.stop_requested());
}

}  // namespace
}  // namespace tubecut::server
