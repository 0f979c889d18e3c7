#include "server/jobs/slots.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <latch>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace tubecut::server {
namespace {

using std::chrono::steady_clock;

std::shared_ptr<Job> job_of(bool is_short, std::string client = "somebody") {
  auto job = std::make_shared<Job>();
  job->is_short = is_short;
  job->claim.client = std::move(client);
  job->budget.cpu = std::chrono::seconds(2);
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
          const auto end = steady_clock::now() + std::chrono::microseconds(job->is_short ? 5 : 12);
          while (steady_clock::now() < end) continue;
        },
        [&](const std::shared_ptr<Job>&) { ++done; });
    std::mt19937 random(static_cast<unsigned>(count));
    const auto at_most = [&](int most) { return static_cast<int>(random() % (most + 1)); };
    int offered = 0;
    for (int burst = 0; burst < 3'000; ++burst) {
      for (int i = at_most(7); i >= 0; --i, ++offered) {
        ASSERT_TRUE(slots.offer(job_of(at_most(9) > 0)).taken);
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
      for (int i = 0; i < count; ++i) ASSERT_TRUE(slots.offer(job_of(false)).taken);
      const bool ended = comes([&] { return done == round * count; });
      if (!ended) together.count_down(count - done % count);
      ASSERT_TRUE(ended) << "round " << round << ", slots " << count;
    }
  }
}

/// Three clients that repeat as soon as they are answered, and one with a job of the other class.
void expect_service_among_endless_jobs(bool endless_are_short) {
  std::atomic<bool> begun = false, over = false;
  std::atomic<Slots*> slots = nullptr;
  std::atomic<int> answered = 0;
  const auto work = [&](const std::shared_ptr<Job>& job) {
    if (job->is_short != endless_are_short) begun = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  const auto done = [&](const std::shared_ptr<Job>& job) {
    if (job->is_short != endless_are_short || over) return;
    ++answered;
    EXPECT_TRUE(slots.load()->offer(job_of(job->is_short, job->claim.client)).taken);
  };
  Slots one(1, 64, work, done);
  slots = &one;
  for (const auto* client : {"a", "b", "c"})
    ASSERT_TRUE(one.offer(job_of(endless_are_short, client)).taken);
  ASSERT_TRUE(comes([&] { return answered > 50; }));
  const int before = answered;
  ASSERT_TRUE(one.offer(job_of(!endless_are_short, "another")).taken);
  EXPECT_TRUE(comes([&] { return begun || answered > before + 1'000; }));
  EXPECT_TRUE(begun) << answered - before << " jobs went before it";
  over = true;
}

TEST(Slots, LongJobsAreNotStarved) { expect_service_among_endless_jobs(true); }
TEST(Slots, ShortJobsAreNotStarved) { expect_service_among_endless_jobs(false); }

/// Long jobs hold every slot until the short ones are done.
TEST(Slots, ShortJobsDoNotWaitForLongOnes) {
  for (const int count : {1, 3}) {
    std::latch go(1);
    std::atomic<int> begun = 0, short_ones = 0;
    Slots slots(
        count, 64,
        [&](const std::shared_ptr<Job>& job) {
          if (job->is_short) return;
          ++begun;
          go.wait();
        },
        [&](const std::shared_ptr<Job>& job) { short_ones += job->is_short ? 1 : 0; });
    for (int i = 0; i < 4 * count; ++i) ASSERT_TRUE(slots.offer(job_of(false, "hog")).taken);
    EXPECT_TRUE(comes([&] { return begun == count; }));
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(slots.offer(job_of(true)).taken);
    EXPECT_TRUE(comes([&] { return short_ones == 50; })) << short_ones << ", slots " << count;
    EXPECT_EQ(begun, count);
    go.count_down();
  }
}

/// The slot is called for the short job, and takes the long one, because that is served next.
TEST(Slots, ShortJobsDoNotWaitForLongOnesThatComeWithThem) {
  for (int round = 0; round < 200; ++round) {
    std::atomic<int> short_ones = 0;
    std::latch go(1);
    Slots slots(
        1, 64,
        [&](const std::shared_ptr<Job>& job) {
          if (!job->is_short) go.wait();
        },
        [&](const std::shared_ptr<Job>& job) { short_ones += job->is_short ? 1 : 0; });
    for (int i = 1; i <= 2; ++i) {
      ASSERT_TRUE(slots.offer(job_of(true)).taken);
      if (i == 2) {
        ASSERT_TRUE(slots.offer(job_of(false, "hog")).taken);
      }
      const bool ended = comes([&] { return short_ones == i; });
      if (!ended) go.count_down();
      ASSERT_TRUE(ended) << "round " << round;
    }
    go.count_down();
  }
}

/// However many long jobs of a client wait, another's comes after the one that runs.
TEST(Slots, LongJobsAlternateByClient) {
  std::latch go(1);
  std::mutex mutex;
  std::vector<std::string> begun;
  std::atomic<int> done = 0;
  Slots slots(
      1, 64,
      [&](const std::shared_ptr<Job>& job) {
        {
          const std::lock_guard lock(mutex);
          begun.push_back(job->claim.client);
        }
        go.wait();
      },
      [&](const std::shared_ptr<Job>&) { ++done; });
  ASSERT_TRUE(slots.offer(job_of(false, "hog")).taken);
  EXPECT_TRUE(comes([&] { return slots.busy() == 1; }));
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(slots.offer(job_of(false, "hog")).taken);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(slots.offer(job_of(false, "modest")).taken);
  go.count_down();
  EXPECT_TRUE(comes([&] { return done == 24; }));
  for (const std::size_t i : {2, 4, 6}) EXPECT_EQ(begun.at(i), "modest") << i;
}

/// The queue of long jobs is full.
TEST(Slots, TakeShortJobsWhileLongOnesFillTheirQueue) {
  std::latch go(1);
  std::atomic<int> begun = 0;
  Slots slots(
      1, 2,
      [&](const std::shared_ptr<Job>& job) {
        if (job->is_short) return;
        ++begun;
        go.wait();
      },
      [](const std::shared_ptr<Job>&) {});
  ASSERT_TRUE(slots.offer(job_of(false)).taken);
  EXPECT_TRUE(comes([&] { return begun == 1; }));
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(slots.offer(job_of(false)).taken);
  EXPECT_FALSE(slots.offer(job_of(false)).taken);
  EXPECT_TRUE(slots.offer(job_of(true)).taken);
  EXPECT_NE(slots.offer(job_of(false, "another")).displaced, nullptr);
  go.count_down();
}

}  // namespace
}  // namespace tubecut::server
