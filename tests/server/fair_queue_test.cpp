#include "server/http/fair_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>

#include "server/http/connection_quota.hpp"
#include "server/jobs/slots.hpp"

namespace tubecut::server {
namespace {

std::shared_ptr<Job> job(std::string client, const void* flow = nullptr) {
  auto out = std::make_shared<Job>();
  out->claim = {.client = std::move(client), .flow = flow};
  return out;
}

TEST(FairQueue, IsFirstInFirstOutForOneFlow) {
  FairQueue queue;
  std::vector<std::shared_ptr<Job>> jobs;
  for (int i = 0; i < 5; ++i) queue.push(jobs.emplace_back(job("a")));
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
      queue.push(waiting.emplace_back(job(name, &flows.at((i * 83) % flows.size()))));
      if (i < 100) continue;
      const auto next = queue.pop();
      ASSERT_EQ(next, waiting[i - 100]) << i;
    }
  }
}

/// However many jobs one client has waiting, another's next job is at most one job away.
TEST(FairQueue, ClientsShareSlotsFairly) {
  FairQueue queue;
  for (int i = 0; i < 1000; ++i) queue.push(job("greedy"));
  for (int round = 0; round < 20; ++round) {
    ASSERT_NE(queue.pop(), nullptr);
    const auto mine = job("modest");
    queue.push(mine);
    auto next = queue.pop();
    if (next != mine) next = queue.pop();
    ASSERT_EQ(next, mine) << round;
  }
}

/// Clients with work at any time are served alternately, however much each of them has waiting.
TEST(FairQueue, ServesClientsAlternately) {
  FairQueue queue;
  for (const auto* client : {"a", "b", "c"})
    for (int i = 0; i < (*client == 'a' ? 300 : 100); ++i) queue.push(job(client));
  std::map<std::string, int> had;
  for (int i = 0; i < 300; ++i) {
    ++had[queue.pop()->claim.client];
    const auto [least, most] = std::minmax({had["a"], had["b"], had["c"]});
    ASSERT_LE(most - least, 1) << i;
  }
}

/// A batch and a connection of the same client share as two clients would.
TEST(FairQueue, ServesFlowsOfAClientAlternately) {
  FairQueue queue;
  const int batch = 0;
  const int single = 0;
  for (int i = 0; i < 100; ++i) queue.push(job("key", &batch));
  ASSERT_NE(queue.pop(), nullptr);
  const auto mine = job("key", &single);
  queue.push(mine);
  const auto second = queue.pop();
  EXPECT_TRUE(second == mine || queue.pop() == mine);
}

TEST(FairQueue, GivesThePlaceOfWhoHasMostToWhoHasLess) {
  FairQueue queue;
  std::vector<std::shared_ptr<Job>> greedy;
  for (int i = 0; i < 3; ++i) queue.push(greedy.emplace_back(job("greedy")));
  EXPECT_EQ(queue.give_way("greedy"), nullptr);
  EXPECT_EQ(queue.give_way("modest"), greedy[2]);
  queue.push(job("modest"));
  EXPECT_EQ(queue.give_way("modest"), nullptr);  // 2 against 1: no better turned round
}

TEST(FairQueue, KeepsEveryJobThatIsNeitherPoppedNorRemoved) {
  FairQueue queue;
  std::mt19937 random(3);
  std::vector<std::shared_ptr<Job>> waiting;
  const std::array<int, 4> flows{};
  for (int step = 0; step < 20000; ++step) {
    switch (random() % 4) {
      case 0:
      case 1:
        queue.push(waiting.emplace_back(
            job("c" + std::to_string(random() % 9), &flows.at(random() % flows.size()))));
        break;
      case 2:
        if (const auto next = queue.pop()) {
          ASSERT_EQ(std::erase(waiting, next), 1U);
          EXPECT_FALSE(queue.remove(next));
        }
        break;
      default:
        if (!waiting.empty()) {
          const auto at = waiting.begin() + static_cast<long>(random() % waiting.size());
          EXPECT_TRUE(queue.remove(*at));
          waiting.erase(at);
        }
    }
    ASSERT_EQ(queue.size(), waiting.size());
  }
  while (const auto next = queue.pop()) ASSERT_EQ(std::erase(waiting, next), 1U);
  EXPECT_TRUE(waiting.empty());
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

TEST(ConnectionQuota, IsBoundedByClientAndGivenBack) {
  ConnectionQuota quota(2);
  {
    const ConnectionPermit one(quota, "a");
    const ConnectionPermit two(quota, "a");
    EXPECT_TRUE(quota.full("a"));
    EXPECT_FALSE(quota.full("b"));
  }
  EXPECT_FALSE(quota.full("a"));
}

}  // namespace
}  // namespace tubecut::server
