#include "server/jobs/cpu_clock.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace tubecut::server {
namespace {

using namespace std::chrono_literals;

void work_for(std::chrono::nanoseconds cpu) {
  const auto clock = CpuClock::of_this_thread();
  while (clock.used() < cpu) {
  }
}

TEST(CpuClock, CountsTheWorkOfItsThreadButNotItsWaiting) {
  const auto clock = CpuClock::of_this_thread();
  std::this_thread::sleep_for(100ms);
  EXPECT_LT(clock.used(), 50ms);
  work_for(30ms);
  EXPECT_GE(clock.used(), 30ms);
}

TEST(HelpersCpu, IsThatOfAllThreadsWhetherTheyRunOrHaveEnded) {
  HelpersCpu all;
  const auto helps = [&all](std::chrono::milliseconds cpu) {
    const HelpersCpu::Share share(all);
    work_for(cpu);
  };
  { const std::jthread first(helps, 20ms), second(helps, 40ms); }
  EXPECT_EQ(all.threads(), 0);
  EXPECT_GE(all.used(), 60ms);
  const HelpersCpu::Share share(all);
  const auto before = all.used();
  work_for(10ms);
  EXPECT_EQ(all.threads(), 1);
  EXPECT_GE(all.used() - before, 10ms);
}

}  // namespace
}  // namespace tubecut::server
