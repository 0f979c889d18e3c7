#include "server/http/request_reader.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tubecut::server {
namespace {

constexpr std::size_t kBody = 1'000'003;

RequestReader at_body(const std::string& framing) {
  RequestReader reader;
  const auto head = "POST /b HTTP/1.1\r\nHost: x\r\n" + framing + "\r\n\r\n";
  EXPECT_EQ(reader.take(head), head.size());
  reader.allow_body(2 * kBody);
  return reader;
}

// With any arrival pattern: never more than eight times the received bytes, and in the end only its
// length.
TEST(RequestReader, HoldsMemoryInProportionToTheReceivedBody) {
  const std::string body(kBody, 'x');
  for (const std::size_t piece : {std::size_t{1} << 20, std::size_t{65536}, std::size_t{1000}}) {
    auto reader = at_body("Content-Length: " + std::to_string(kBody));
    const auto head = reader.held();
    EXPECT_LT(head, 1000U);
    for (std::size_t at = 0; at < kBody; at += piece) {
      const auto part = std::string_view(body).substr(at, piece);
      ASSERT_EQ(reader.take(part), part.size());
      if (reader.state() == RequestReader::State::body) {
        EXPECT_LE(reader.held(), head + 8 * (at + part.size()) + 64) << at;
      }
    }
    ASSERT_EQ(reader.state(), RequestReader::State::whole);
    EXPECT_EQ(reader.request().body, body);
    EXPECT_LE(reader.request().body.capacity(), kBody + 4096) << piece;
  }
}

TEST(RequestReader, HoldsNoMemoryForAnAnnouncedBody) {
  auto reader = at_body("Content-Length: " + std::to_string(kBody));
  EXPECT_LT(reader.held(), 1000U);
  EXPECT_EQ(reader.take("x"), 1U);
  EXPECT_LT(reader.held(), 1000U);
  EXPECT_LT(reader.request().body.capacity(), 1000U);
}

}  // namespace
}  // namespace tubecut::server
