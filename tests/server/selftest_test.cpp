#include "server/selftest.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "api/api.hpp"

namespace tubecut::server {
namespace {

TEST(Selftest, CoversEveryEndpointButTheLongOne) {
  std::set<std::string_view> left;
  for (const auto& example : api::examples()) left.insert(example.endpoint);
  EXPECT_GE(left.size(), 10U);
  for (const auto& known : known_answers()) left.erase(known.endpoint);
  EXPECT_EQ(left, (std::set<std::string_view>{"mill-paths"}));
}

TEST(Selftest, SeesEachAnswerThatDiffers) {
  const auto known = known_answers();
  EXPECT_EQ(selftest_fault(), "");
  for (std::size_t i = 0; i < known.size(); ++i) {
    std::vector<KnownAnswer> changed(known.begin(), known.end());
    std::string other(changed[i].result_sha256);
    other.back() = other.back() == '0' ? '1' : '0';
    changed[i].result_sha256 = other;
    EXPECT_NE(selftest_fault(changed).find(changed[i].name), std::string::npos) << i;
  }
}

TEST(Selftest, FailsWithNothingToCompare) {
  EXPECT_NE(selftest_fault({}), "");
  const KnownAnswer nowhere[] = {{"nodes", "no such example", "00"}};
  EXPECT_NE(selftest_fault(nowhere).find("no such example"), std::string::npos);
}

}  // namespace
}  // namespace tubecut::server
