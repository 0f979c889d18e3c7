#include "api/cbor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace tubecut::api {
namespace {

enum class Major : std::uint8_t { natural, negative, bytes, text, array, map, tag };
constexpr std::uint8_t kInt16LittleEndian = 77;
constexpr std::uint8_t kInt32LittleEndian = 78;
constexpr double kExact = 9007199254740992.0;  // 2^53: every whole number up to it is a double

void big_endian(std::string& out, std::uint64_t bits, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) out += static_cast<char>((bits >> (8 * i)) & 0xFFU);
}

void head(std::string& out, Major major, std::uint64_t n) {
  const auto first = [&](std::uint64_t info) {
    out += static_cast<char>((static_cast<std::uint64_t>(major) << 5U) | info);
  };
  if (n < 24) return first(n);
  int bytes = 8, info = 27;
  if (n <= 0xFFU) {
    bytes = 1, info = 24;
  } else if (n <= 0xFFFFU) {
    bytes = 2, info = 25;
  } else if (n <= 0xFFFFFFFFU) {
    bytes = 4, info = 26;
  }
  first(static_cast<std::uint64_t>(info));
  big_endian(out, n, bytes);
}

void put_integer(std::string& out, std::int64_t v) {
  head(out, v < 0 ? Major::negative : Major::natural,
       static_cast<std::uint64_t>(v < 0 ? -1 - v : v));
}

template <class Small>
bool all_fit(const std::vector<std::int64_t>& values) {
  return std::ranges::all_of(values, [](std::int64_t v) {
    return v >= std::numeric_limits<Small>::min() && v <= std::numeric_limits<Small>::max();
  });
}

}  // namespace

std::string CborWriter::typed_array(const std::vector<std::int64_t>& values) {
  const bool small = all_fit<std::int16_t>(values);
  const std::size_t width = small ? 2 : 4;
  std::string out;
  out.reserve(values.size() * width + 16);
  head(out, Major::tag, small ? kInt16LittleEndian : kInt32LittleEndian);
  head(out, Major::bytes, values.size() * width);
  for (const auto v : values)
    for (std::size_t i = 0; i < width; ++i)
      out += static_cast<char>((static_cast<std::uint64_t>(v) >> (8 * i)) & 0xFFU);
  return out;
}

void CborWriter::give_up_column(Frame& frame) {
  frame.column = false;
  for (const auto v : frame.integers) put_integer(frame.bytes, v);
  frame.integers.clear();
}

void CborWriter::begin_item() {
  if (frames_.empty()) return;
  if (frames_.back().column) give_up_column(frames_.back());
  if (!frames_.back().object) ++frames_.back().items;
}

void CborWriter::null() {
  begin_item();
  here() += '\xF6';
}

void CborWriter::boolean(bool v) {
  begin_item();
  here() += v ? '\xF5' : '\xF4';
}

void CborWriter::integer(std::int64_t v) {
  if (!frames_.empty() && frames_.back().column) {
    ++frames_.back().items;
    frames_.back().integers.push_back(v);
    return;
  }
  begin_item();
  put_integer(here(), v);
}

void CborWriter::number(double v) {
  if (v == std::trunc(v) && std::abs(v) <= kExact) return integer(static_cast<std::int64_t>(v));
  begin_item();
  const auto narrow = static_cast<float>(v);
  const bool fits = static_cast<double>(narrow) == v;
  here() += fits ? '\xFA' : '\xFB';
  if (fits)
    big_endian(here(), std::bit_cast<std::uint32_t>(narrow), 4);
  else
    big_endian(here(), std::bit_cast<std::uint64_t>(v), 8);
}

void CborWriter::text(std::string_view v) {
  begin_item();
  head(here(), Major::text, v.size());
  here() += v;
}

void CborWriter::raw(std::string_view item) {
  begin_item();
  here() += item;
}

void CborWriter::key(std::string_view name) {
  auto& frame = frames_.back();
  ++frame.items;
  head(frame.bytes, Major::text, name.size());
  frame.bytes += name;
  key_ = name;
}

void CborWriter::open(bool object) {
  begin_item();
  const bool in_counts = !frames_.empty() && frames_.back().counts;
  const bool named = !frames_.empty() && frames_.back().object;
  frames_.push_back({.object = object,
                     .counts = object && named && key_ == "counts",
                     .column = !object && in_counts});
}

void CborWriter::close() {
  Frame done = std::move(frames_.back());
  frames_.pop_back();
  const bool typed = done.column && all_fit<std::int32_t>(done.integers);
  if (typed) {
    here() += typed_array(done.integers);
    return;
  }
  if (done.column) give_up_column(done);
  head(here(), done.object ? Major::map : Major::array, done.items);
  here() += done.bytes;
}

}  // namespace tubecut::api
