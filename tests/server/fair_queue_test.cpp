#include "server/http/fair_queue.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>

#include "server/http/places.hpp"
#include "server/jobs/slots.hpp"

namespace tubecut::server {
namespace {

std::shared_ptr<Job> job(std::string client, double expected_s, const void* flow = nullptr) {
  auto out = std::make_shared<Job>();
  out->claim = {.client = std::move(client), .flow = flow, .expected_s = expected_s};
  out->claim.quick = expected_s < 0.01;
  return out;
}

TEST(FairQueue, IsFirstInFirstOutForOneFlow) {
  FairQueue queue;
  std::vector<std::shared_ptr<Job>> jobs;
  for (int i = 0; i < 5; ++i) queue.push(jobs.emplace_back(job("a", 1.0)));
  for (const auto& expected : jobs) EXPECT_EQ(queue.pop(), expected);
  EXPECT_EQ(queue.pop(), nullptr);
}

/// Connections with one job each, and clients too, are served in the order in which they came.
TEST(FairQueue, IsFirstInFirstOutForNewcomers) {
  for (const bool clients : {false, true}) {
    FairQueue queue;
    std::array<int, 200> flows{};
    std::vector<std::shared_ptr<Job>> waiting;
    for (std::size_t i = 0; i < flows.size(); ++i) {
      const auto name = clients ? std::to_string((i * 37) % 200) : std::string("one");
      queue.push(waiting.emplace_back(job(name, 1.0, &flows.at((i * 83) % flows.size()))));
      if (i < 100) continue;
      const auto next = queue.pop();
      ASSERT_EQ(next, waiting[i - 100]) << i;
      queue.done(next->claim, 1.0);
    }
  }
}

/// However many jobs one client has waiting, another's next job is at most one turn away.
TEST(FairQueue, ClientsShareSlotsFairly) {
  FairQueue queue;
  for (int i = 0; i < 1000; ++i) queue.push(job("greedy", 1.0));
  for (int round = 0; round < 20; ++round) {
    const auto first = queue.pop();
    queue.done(first->claim, 1.0);
    const auto mine = job("modest", 1.0);
    queue.push(mine);
    auto next = queue.pop();
    if (next != mine) {
      queue.done(next->claim, 1.0);
      next = queue.pop();
    }
    ASSERT_EQ(next, mine) << round;
    queue.done(next->claim, 1.0);
  }
}

/// Two clients who always have work share the time evenly, not the jobs, although the expected time
/// of a job is wrong: neither is ahead of the other by more than the two longest jobs.
TEST(FairQueue, SharesTimeNotJobs) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(0.2, 5.0);
  for (int trial = 0; trial < 50; ++trial) {
    FairQueue queue;
    std::map<std::string, double> takes = {{"short", 0.1 * off(random)}, {"long", off(random)}};
    std::map<std::string, double> had;
    for (const auto& [name, seconds] : takes) {
      for (int i = 0; i < 400; ++i) queue.push(job(name, seconds * off(random)));
    }
    double most = 0.0;
    for (int i = 0; i < 300; ++i) {
      const auto next = queue.pop();
      const double took = takes.at(next->claim.client);
      queue.done(next->claim, took);
      had[next->claim.client] += took;
      most = std::max(most, std::abs(had["short"] - had["long"]));
    }
    EXPECT_LE(most, 2.0 * 5.0 * takes["long"]) << trial;
  }
}

/// A batch and a connection of the same client share as two clients would.
TEST(FairQueue, LetsFlowsOfAClientTakeTurns) {
  FairQueue queue;
  const int batch = 0;
  const int single = 0;
  for (int i = 0; i < 100; ++i) queue.push(job("key", 1.0, &batch));
  const auto first = queue.pop();
  const auto mine = job("key", 1.0, &single);
  queue.push(mine);
  const auto second = queue.pop();
  EXPECT_TRUE(second == mine || queue.pop() == mine);
  queue.done(first->claim, 1.0);
}

TEST(FairQueue, FindsTheQuickBehindTheLong) {
  FairQueue queue;
  const int other = 0;
  queue.push(job("a", 1.0));
  EXPECT_EQ(queue.pop_quick(1.0), nullptr);
  const auto quick = job("a", 0.001, &other);
  queue.push(quick);
  EXPECT_EQ(queue.pop_quick(1.0), quick);
  EXPECT_EQ(queue.size(), 1U);
  const auto later = job("a", 0.001, &other);
  later->claim.since = 2.0;
  queue.push(later);
  EXPECT_EQ(queue.pop_quick(1.0), nullptr);
}

TEST(FairQueue, DelaysTrialsIfTheyCouldBlockKnownJobs) {
  FairQueue queue;
  const auto trial = job("new", 0.001), known = job("old", 0.001);
  trial->claim.trial = true;
  queue.push(trial);
  queue.push(known);
  EXPECT_EQ(queue.pop_quick(1.0, false), known);
  EXPECT_EQ(queue.pop_quick(1.0, false), nullptr);
  EXPECT_EQ(queue.pop_quick(1.0), trial);
}

TEST(FairQueue, GivesThePlaceOfWhoHasMostToWhoHasLess) {
  FairQueue queue;
  std::vector<std::shared_ptr<Job>> greedy;
  for (int i = 0; i < 3; ++i) queue.push(greedy.emplace_back(job("greedy", 1.0)));
  EXPECT_EQ(queue.give_way({.client = "greedy"}), nullptr);
  EXPECT_EQ(queue.give_way({.client = "modest"}), greedy[2]);
  queue.push(job("modest", 1.0));
  EXPECT_EQ(queue.give_way({.client = "modest"}), nullptr);  // 2 against 1: no better turned round
}

TEST(FairQueue, ForetellsTheWaitOfEachClient) {
  FairQueue queue;
  for (int i = 0; i < 50; ++i) queue.push(job("greedy", 2.0));
  EXPECT_DOUBLE_EQ(queue.before({.client = "greedy", .expected_s = 1.0}, false), 100.0);
  EXPECT_LE(queue.before({.client = "modest", .expected_s = 0.1}, false), 0.1);
  EXPECT_DOUBLE_EQ(queue.before({.client = "modest", .expected_s = 0.1}, true), 0.0);
}

TEST(FairQueue, ForgetsClientsWithoutJobs) {
  FairQueue queue;
  std::mt19937 random(3);
  std::vector<std::shared_ptr<Job>> waiting;
  std::vector<std::shared_ptr<Job>> running;
  for (int step = 0; step < 20000; ++step) {
    switch (random() % 4) {
      case 0:
      case 1:
        queue.push(waiting.emplace_back(job("c" + std::to_string(random() % 9), 0.1)));
        break;
      case 2:
        if (auto next = queue.pop()) {
          std::erase(waiting, next);
          running.push_back(std::move(next));
        }
        break;
      default:
        if (!waiting.empty() && random() % 3 == 0) {
          const auto at = waiting.begin() + static_cast<long>(random() % waiting.size());
          EXPECT_TRUE(queue.remove(*at));
          waiting.erase(at);
        } else if (!running.empty()) {
          queue.done(running.back()->claim, 0.2);
          running.pop_back();
        }
    }
    ASSERT_EQ(queue.size(), waiting.size());
  }
  for (const auto& one : waiting) EXPECT_TRUE(queue.remove(one));
  for (const auto& one : running) queue.done(one->claim, 0.1);
  EXPECT_EQ(queue.size(), 0U);
  EXPECT_DOUBLE_EQ(queue.before({.client = "c1", .expected_s = 1.0}, false), 0.0);
}

TEST(MemoryShare, IsAlwaysReleased) {
  MemoryBound whole(100);
  MemoryBound part(50, &whole);
  {
    MemoryShare one(whole, 60);
    MemoryShare two(part, 30);
    EXPECT_EQ(whole.used(), 90U);
    EXPECT_EQ(part.used(), 30U);
    EXPECT_TRUE(whole.has(10));
    EXPECT_FALSE(whole.has(11));
    MemoryShare moved = std::move(one);
    moved.resize(10);
    EXPECT_EQ(whole.used(), 40U);
    two = std::move(moved);
    EXPECT_EQ(two.bytes(), 10U);
  }
  EXPECT_EQ(whole.used(), 0U);
  EXPECT_EQ(part.used(), 0U);
}

TEST(Places, AreBoundedByClientAndGivenBack) {
  Places places(2);
  {
    const Place one(places, "a");
    const Place two(places, "a");
    EXPECT_TRUE(places.full("a"));
    EXPECT_FALSE(places.full("b"));
  }
  EXPECT_FALSE(places.full("a"));
}

}  // namespace
}  // namespace tubecut::server
