#include "core/base/sort.hpp"

#include <gtest/gtest.h>

#include <random>

namespace tubecut {
namespace {

/// Below a block, at its borders, and of several that do not come out even.
TEST(SortUnlessStopped, IsInOrder) {
  std::mt19937_64 random(20261126);
  for (const std::size_t n : {0U, 1U, 8191U, 8192U, 8193U, 16384U, 70001U}) {
    std::vector<std::pair<double, std::size_t>> values;
    for (std::size_t i = 0; i < n; ++i)
      values.emplace_back(static_cast<double>(random() % 5000), i);
    auto expected = values;
    std::ranges::sort(expected);
    sort_unless_stopped(values, {});
    EXPECT_EQ(values, expected) << n;
    sort_unless_stopped(values, {}, [](const auto& value) { return -value.first; });
    EXPECT_TRUE(std::ranges::is_sorted(values, std::ranges::greater{},
                                       &std::pair<double, std::size_t>::first))
        << n;
  }
}

/// A cancelled sort keeps all elements.
TEST(SortUnlessStopped, LosesNothingWhenStopped) {
  std::vector<int> values(50000);
  for (int i = 0; i < 50000; ++i) values[static_cast<std::size_t>(i)] = 50000 - i;
  const auto before = values;
  std::stop_source stop;
  stop.request_stop();
  sort_unless_stopped(values, stop.get_token());
  EXPECT_EQ(values, before);
}

}  // namespace
}  // namespace tubecut
