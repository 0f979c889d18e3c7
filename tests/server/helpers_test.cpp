#include "server/jobs/helpers.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace tubecut::server {
namespace {

void within(const Helpers::Stint& stint) { stint(); }

TEST(Helpers, RunEveryTaskOnce) {
  for (const int most : {0, 1, 3}) {
    Helpers helpers(3, [] {});
    helpers.allow(most);
    std::vector<std::atomic<int>> done(1'000);
    helpers.run_parallel(
        done.size(), [&](std::size_t i) { ++done[i]; }, within);
    for (const auto& runs : done) EXPECT_EQ(runs, 1);
  }
}

/// Two tasks that wait for each other: ends only where somebody helps.
TEST(Helpers, HelpAsManyAsMay) {
  Helpers helpers(3, [] {});
  helpers.allow(2);
  std::latch three(3);
  std::mutex mutex;
  std::set<std::thread::id> who;
  helpers.run_parallel(
      3,
      [&](std::size_t) {
        three.arrive_and_wait();
        const std::lock_guard lock(mutex);
        who.insert(std::this_thread::get_id());
      },
      within);
  EXPECT_EQ(who.size(), 3U);
}

TEST(Helpers, LeaveAfterTheCurrentTaskWhenASlotIsWanted) {
  Helpers helpers(1, [] {});
  helpers.allow(1);
  const auto own = std::this_thread::get_id();
  std::latch both(2), told(1);
  std::atomic<int> by_others = 0;
  helpers.run_parallel(
      100,
      [&](std::size_t i) {
        if (i < 2) both.arrive_and_wait();
        if (std::this_thread::get_id() != own) {
          ++by_others;
          told.wait();
        } else if (i < 2) {
          helpers.allow(0);
          told.count_down();
        }
      },
      within);
  EXPECT_EQ(by_others, 1);
}

TEST(Helpers, BeginOnlyIfASlotIsFree) {
  Helpers helpers(2, [] {});
  const auto own = std::this_thread::get_id();
  helpers.run_parallel(
      50, [&](std::size_t) { EXPECT_EQ(std::this_thread::get_id(), own); }, within);
}

/// As a loop would: whoever throws first.
TEST(Helpers, RethrowExceptionOfFirstFailedTask) {
  Helpers helpers(1, [] {});
  helpers.allow(1);
  std::latch both(2);
  std::atomic<int> begun = 0;
  try {
    helpers.run_parallel(
        1'000,
        [&](std::size_t i) {
          ++begun;
          if (i < 2) {
            both.arrive_and_wait();
            throw std::runtime_error(i == 0 ? "first" : "second");
          }
        },
        within);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "first");
  }
  EXPECT_LT(begun, 1'000);
  std::atomic<int> after = 0;
  helpers.run_parallel(
      10, [&](std::size_t) { ++after; }, within);
  EXPECT_EQ(after, 10);
}

}  // namespace
}  // namespace tubecut::server
