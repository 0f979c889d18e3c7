#include "server/jobs/slots.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <latch>
#include <memory>
#include <random>
#include <thread>
#include <vector>

namespace tubecut::server {
namespace {

using std::chrono::steady_clock;

std::shared_ptr<Job> job_of(std::string_view kind) {
  auto job = std::make_shared<Job>();
  job->kind = kind;
  job->claim.client = "somebody";
  job->budget.cpu = std::chrono::seconds(2);
  return job;
}

/// A batch's line: never taken for quick.
std::shared_ptr<Job> long_job() {
  auto job = job_of("of some time");
  job->request.line = 1;
  return job;
}

/// Waits at most ten seconds.
template <class Condition>
bool comes(const Condition& true_now) {
  const auto end = steady_clock::now() + std::chrono::seconds(10);
  while (!true_now()) {
    if (steady_clock::now() > end) return false;
    std::this_thread::yield();
  }
  return true;
}

/// Jobs that come together while threads fall asleep, are on the way back and are called: whoever
/// is called or comes back takes them all.
TEST(Slots, RunEveryJobInAnyStateOfTheirThreads) {
  for (const int count : {1, 2, 3}) {
    std::atomic<int> done = 0;
    Slots slots(
        count, 4096,
        [](const std::shared_ptr<Job>& job) {
          const auto end = steady_clock::now() + std::chrono::microseconds(job->kind.size());
          while (steady_clock::now() < end) continue;
        },
        [&](const std::shared_ptr<Job>&) { ++done; });
    std::mt19937 random(static_cast<unsigned>(count));
    const auto at_most = [&](int most) { return static_cast<int>(random() % (most + 1)); };
    int offered = 0;
    for (int burst = 0; burst < 3'000; ++burst) {
      for (int i = at_most(7); i >= 0; --i, ++offered) {
        ASSERT_TRUE(slots.offer(at_most(9) == 0 ? long_job() : job_of("short")).taken);
      }
      if (at_most(3) == 0) std::this_thread::sleep_for(std::chrono::microseconds(at_most(100)));
      if (at_most(1) == 0) continue;
      ASSERT_TRUE(comes([&] { return done == offered; }))
          << offered - done << " of a burst wait, slots " << count;
    }
    EXPECT_TRUE(comes([&] { return done == offered; }));
  }
}

/// As many jobs as there are slots, each of which ends when all have begun.
TEST(Slots, AreAllTakenByJobsThatComeTogether) {
  for (const int count : {2, 3}) {
    std::atomic<std::latch*> all = nullptr;
    std::atomic<int> done = 0;
    Slots slots(
        count, 4096, [&](const std::shared_ptr<Job>&) { all.load()->arrive_and_wait(); },
        [&](const std::shared_ptr<Job>&) { ++done; });
    for (int round = 1; round <= 2'000; ++round) {
      std::latch together(count);
      all = &together;
      for (int i = 0; i < count; ++i) ASSERT_TRUE(slots.offer(job_of("short")).taken);
      const bool ended = comes([&] { return done == round * count; });
      if (!ended) together.count_down(count - done % count);
      ASSERT_TRUE(ended) << "round " << round << ", slots " << count;
    }
  }
}

/// Three clients that repeat as soon as they are answered, and one with a long job: it gets its
/// turn.
TEST(Slots, LongJobsAreNotStarved) {
  std::atomic<bool> begun = false, over = false;
  std::atomic<Slots*> slots = nullptr;
  std::atomic<int> quick = 0;
  const auto work = [&](const std::shared_ptr<Job>& job) {
    if (job->request.line > 0) begun = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  const auto done = [&](const std::shared_ptr<Job>& job) {
    if (job->request.line > 0 || over) return;
    ++quick;
    EXPECT_TRUE(slots.load()->offer(job_of("short")).taken);
  };
  Slots one(1, 64, work, done);
  slots = &one;
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(one.offer(job_of("short")).taken);
  ASSERT_TRUE(comes([&] { return quick > 50; }));
  const auto asked = long_job();
  asked->claim.client = "another";
  const int before = quick;
  ASSERT_TRUE(one.offer(asked).taken);
  EXPECT_TRUE(comes([&] { return begun || quick > before + 1'000; }));
  EXPECT_TRUE(begun) << quick - before << " quick jobs went before it";
  over = true;
}

}  // namespace
}  // namespace tubecut::server
