#include "core/base/make_room.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace tubecut {
namespace {

TEST(MakeRoom, KeepsContentsOfAnyLength) {
  for (const std::size_t length : {0u, 1u, 8191u, 8192u, 8193u, 100'000u}) {
    std::vector<int> rows(length);
    std::iota(rows.begin(), rows.end(), 7);
    rows.shrink_to_fit();
    const std::vector<int> before = rows;
    make_room(rows, {});
    EXPECT_EQ(rows, before);
    if (length >= 8192) {
      EXPECT_GT(rows.capacity(), length);
    }
    const int* const there = rows.data();
    make_room(rows, {});
    EXPECT_EQ(rows.data(), there) << "moved twice for one more";
  }
}

TEST(MakeRoom, MovesNothingAfterAStop) {
  std::stop_source stop;
  std::vector<int> rows(100'000, 1);
  rows.shrink_to_fit();
  stop.request_stop();
  make_room(rows, stop.get_token());
  EXPECT_TRUE(rows.empty());
  EXPECT_GE(rows.capacity(), 100'000u);
}

}  // namespace
}  // namespace tubecut
