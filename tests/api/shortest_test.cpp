#include "api/wire/shortest.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>

namespace tubecut::api {
namespace {

std::string printed(double value) {
  char text[kShortestBytes];
  return {text, print_shortest(text, value)};
}

std::string by_library(double value) {
  char text[kShortestBytes];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// Of every size that answers have, and of every kind of last digits.
double any(std::mt19937_64& draw) {
  const auto bits = draw();
  switch (bits % 6) {
    case 0:
      return std::ldexp(static_cast<double>(draw() >> 11U), -44 - static_cast<int>(draw() % 4));
    case 1:
      return -std::ldexp(static_cast<double>(draw() >> 11U), -static_cast<int>(draw() % 140));
    case 2:
      return std::round(static_cast<double>(draw() % 1'000'000'000)) / 1'000.0;
    case 3:  // a few bits: whole numbers, halves, quarters
      return static_cast<double>(draw() >> (11 + draw() % 50)) /
             static_cast<double>(1 << (draw() % 8));
    case 4:
      return static_cast<double>(draw() % 1'000'000) *
             std::pow(10.0, static_cast<int>(draw() % 20) - 15);
    default:
      return std::bit_cast<double>((bits >> 1U) % std::bit_cast<std::uint64_t>(9007199254740992.0));
  }
}

TEST(Shortest, EqualsTheLibrarysOutput) {
  std::mt19937_64 draw(18);
  for (int i = 0; i < 600'000; ++i) {
    const double value = any(draw);
    ASSERT_EQ(printed(value), by_library(value)) << i;
  }
  for (int power = -1074; power <= 53; ++power)
    for (const double near : {std::nextafter(std::ldexp(1.0, power), 0.0), std::ldexp(1.0, power),
                              std::nextafter(std::ldexp(1.0, power), 1e300)})
      if (near <= 9007199254740992.0) {
        ASSERT_EQ(printed(near), by_library(near)) << power;
      }
}

/// Without the library of the same purpose: it reads back, and a digit fewer does not.
TEST(Shortest, ReadsBackAndHasNoDigitTooMany) {
  std::mt19937_64 draw(4);
  std::uniform_real_distribution<double> table(-1'000.0, 1'000.0);
  for (int i = 0; i < 50'000; ++i) {
    const double value = i % 2 == 0 ? table(draw) : std::round(table(draw) * 1e6) / 1e6;
    const auto text = printed(value);
    ASSERT_EQ(std::stod(text), value) << text;
    int digits = 0;
    for (const char c : text.substr(text.find_first_of("123456789")))
      digits += c >= '0' && c <= '9' ? 1 : 0;
    if (digits < 2 || text.find('.') == std::string::npos) continue;
    char fewer[40];
    std::snprintf(fewer, sizeof fewer, "%.*e", digits - 2, value);
    ASSERT_NE(std::stod(fewer), value) << text << " could be " << fewer;
  }
}

}  // namespace
}  // namespace tubecut::api
