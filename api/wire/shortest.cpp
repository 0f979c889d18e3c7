#include "api/wire/shortest.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

namespace tubecut::api {
namespace {

__extension__ using Wide = unsigned __int128;
using Bits = std::uint64_t;

constexpr int kFraction = 52;                        // bits of a double below its first
constexpr int kMostHalvings = 66;                    // of a number that this handles: 2^-14 is the
                                                     // smallest
constexpr Bits kSeventeen = 10'000'000'000'000'000;  // the smallest with 17 digits
constexpr Bits kEight = 100'000'000;
constexpr Bits kZeros = 0x3030303030303030;  // "00000000"
constexpr Bits kDigits = 0x0f0f0f0f0f0f0f0f;
constexpr int kMostBefore = 8;  // digits before the point but for the first: one word of them

/// 10^n times the power of two that brings its first bit to the front.
struct PowerOfTen {
  Bits high = 0, low = 0;
  int exponent = 0;  // of its first bit
};

constexpr auto kPowers = [] {
  std::array<PowerOfTen, 21> out{};
  Wide power = 1;
  for (auto& one : out) {
    Wide front = power;
    int exponent = 127;
    for (; (front >> 127) == 0; --exponent) front <<= 1;
    one = {static_cast<Bits>(front >> 64), static_cast<Bits>(front), exponent};
    power *= 10;
  }
  return out;
}();

struct Decimal {
  Bits digits = 0;   // 16 or 17 of them, with trailing zeros if fewer are enough
  int exponent = 0;  // of the last
};

/// Returns the digits of c / 2^halvings, for 2^52 < c < 2^53. With the smallest n for which 10^n >=
/// 2^halvings the number is c 10^n / 2^halvings units of 10^-n, with a whole part of at most 17
/// digits, and half of the gap to the next double between 0.5 and 5 units. So at most one multiple
/// of ten units reads back, and has the fewest digits; else the nearest unit does. Returns nothing
/// if the two sides of a comparison are equal in 60 bits: std::to_chars handles ties.
std::optional<Decimal> shortest(Bits c, int halvings) {
  constexpr Bits kOne = Bits{1} << 60U;
  const int n = (halvings * 1233 + 4095) >> 12;  // ceil(halvings log10(2))
  const auto& power = kPowers[static_cast<std::size_t>(n)];
  const int up = power.exponent - halvings;  // 0 to 3
  const Bits shifted = c << (up + 1);
  const Wide low = Wide{shifted} * power.low;
  const Wide product = Wide{shifted} * power.high + static_cast<Bits>(low >> 64);
  const auto whole = static_cast<Bits>(product >> 64), part = static_cast<Bits>(product);
  const Bits tens = whole / 10 * 10;
  const Bits above = ((whole - tens) << 60U) | (part >> 4U);  // of the multiple below, in kOne
  const Bits below = 10 * kOne - above;                       // of the one above
  const Bits half_gap = power.high >> (4 - up);
  if (above + 1 < half_gap) return Decimal{tens, -n};
  if (below + 1 < half_gap) return Decimal{tens + 10, -n};
  const Bits middle = Bits{1} << 63U;
  if (above <= half_gap + 1 || below <= half_gap + 1 || part == middle) return std::nullopt;
  return Decimal{whole + (part >> 63U), -n};
}

/// Eight digits as characters, the first in the lowest byte: quarters, pairs and digits are parted
/// in all of the word at once.
Bits characters(Bits number) {
  const Bits quarters = number / 10'000 | (number % 10'000) << 32U;
  const Bits hundreds = (quarters * 10'486 >> 20U) & 0x7f'0000'007f;  // of each, by 100
  const Bits pairs = hundreds | (quarters - hundreds * 100) << 16U;
  const Bits tens = (pairs * 103 >> 10U) & 0x000f'000f'000f'000f;  // of each, by 10
  return (tens | (pairs - tens * 10) << 8U) | kZeros;
}

void put(char* to, Bits characters) {
  if constexpr (std::endian::native == std::endian::big) characters = __builtin_bswap64(characters);
  std::memcpy(to, &characters, sizeof characters);
}

char* by_library(char* to, double value) {
  return std::to_chars(to, to + kShortestBytes, value).ptr;
}

/// Seventeen digits: one, eight and eight.
struct DecimalPlaces {
  char first = '0';
  Bits middle = 0, last = 0;
  int count = 0;  // without the zeros at the end

  explicit DecimalPlaces(Bits digits) {
    const Bits top = digits / kEight;
    first = static_cast<char>('0' + top / kEight);
    middle = characters(top % kEight);
    last = characters(digits % kEight);
    const auto ends = [](Bits word) { return 8 - (std::countl_zero(word & kDigits) >> 3); };
    count = last != kZeros ? 9 + ends(last) : middle != kZeros ? 1 + ends(middle) : 1;
  }
};

/// Writes `places` with the point after `before` further digits. Returns nullptr if the scientific
/// notation is shorter.
char* print_fixed(char* to, const DecimalPlaces& places, int before) {
  if (before < 0) {
    if (before == -4 && places.count == 1) return nullptr;
    std::memcpy(to, "0.000000", 8);
    to += 1 - before;
    *to = places.first;
    put(to + 1, places.middle);
    put(to + 9, places.last);
    return to + places.count;
  }
  *to = places.first;
  put(to + 1, places.middle);
  if (places.count - 1 <= before) return before > places.count + 3 ? nullptr : to + before + 1;
  put(to + 2 + before, before < 8 ? places.middle >> (8 * static_cast<unsigned>(before)) : 0);
  put(to + 10, places.last);
  to[before + 1] = '.';
  return to + places.count + 1;
}

}  // namespace

char* print_shortest(char* to, double value) {
  const auto bits = std::bit_cast<Bits>(value);
  if (bits == 0) {
    *to = '0';
    return to + 1;
  }
  const Bits fraction = bits & ((Bits{1} << kFraction) - 1);
  const int halvings = 1023 + kFraction - static_cast<int>((bits >> kFraction) & 0x7ffU);
  // The gap below a power of two is half of that above.
  if (fraction == 0 || halvings < 0 || halvings > kMostHalvings) return by_library(to, value);
  const auto decimal = shortest(fraction | Bits{1} << kFraction, halvings);
  if (!decimal) return by_library(to, value);
  const bool sixteen = decimal->digits < kSeventeen;
  const int before = decimal->exponent + (sixteen ? 15 : 16);
  if (before > kMostBefore || before < -4) return by_library(to, value);
  const bool negative = bits >> 63U != 0;
  *to = '-';
  const DecimalPlaces places(sixteen ? decimal->digits * 10 : decimal->digits);
  char* const end = print_fixed(to + (negative ? 1 : 0), places, before);
  return end != nullptr ? end : by_library(to, value);
}

}  // namespace tubecut::api
