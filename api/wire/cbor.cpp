#include "api/wire/cbor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

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

/// Its bytes, little endian.
void little_endian(std::string& out, std::span<const std::int32_t> values, std::size_t width) {
  Pace pace;
  for (const auto v : values) {
    pace.tick();
    char bytes[4];
    for (std::size_t i = 0; i < width; ++i)
      bytes[i] = static_cast<char>((static_cast<std::uint32_t>(v) >> (8 * i)) & 0xFFU);
    out.append(bytes, width);
  }
}

}  // namespace

void CborWriter::typed_array(std::span<const std::int32_t> values) {
  begin_item();
  Pace pace;
  const bool small = std::ranges::all_of(values, [&pace](std::int32_t v) {
    pace.tick();
    return v == static_cast<std::int16_t>(v);
  });
  const std::size_t width = small ? 2 : 4;
  head(out_, Major::tag, small ? kInt16LittleEndian : kInt32LittleEndian);
  head(out_, Major::bytes, values.size() * width);
  little_endian(out_, values, width);
}

void CborWriter::null() {
  begin_item();
  out_ += '\xF6';
}

void CborWriter::boolean(bool v) {
  begin_item();
  out_ += v ? '\xF5' : '\xF4';
}

void CborWriter::integer(std::int64_t v) {
  begin_item();
  put_integer(out_, v);
}

void CborWriter::number(double v) {
  if (v == std::trunc(v) && std::abs(v) <= kExact) return integer(static_cast<std::int64_t>(v));
  begin_item();
  const auto narrow = static_cast<float>(v);
  const bool fits = static_cast<double>(narrow) == v;
  out_ += fits ? '\xFA' : '\xFB';
  if (fits)
    big_endian(out_, std::bit_cast<std::uint32_t>(narrow), 4);
  else
    big_endian(out_, std::bit_cast<std::uint64_t>(v), 8);
}

void CborWriter::text(std::string_view v) {
  begin_item();
  head(out_, Major::text, v.size());
  out_ += v;
}

void CborWriter::raw(std::string_view item) {
  begin_item();
  out_ += item;
}

void CborWriter::key(std::string_view name) {
  ++frames_.back().items;
  head(out_, Major::text, name.size());
  out_ += name;
  key_ = name;
}

void CborWriter::open(bool object) {
  begin_item();
  const bool named = !frames_.empty() && frames_.back().object;
  frames_.push_back(
      {.object = object, .counts = object && named && key_ == "counts", .at = out_.size()});
  out_ += '\0';
}

void CborWriter::close() {
  const Frame done = frames_.back();
  frames_.pop_back();
  std::string full;
  head(full, done.object ? Major::map : Major::array, done.items);
  out_[done.at] = full.front();
  if (full.size() > 1) rests_.push_back({done.at + 1, full.substr(1)});
}

std::string CborWriter::take() {
  if (rests_.empty()) return std::move(out_);
  std::ranges::sort(rests_, {}, &Rest::at);
  std::string whole;
  whole.reserve(out_.size() + 8 * rests_.size());
  std::size_t at = 0;
  for (const auto& rest : rests_) {
    whole += std::string_view(out_).substr(at, rest.at - at);
    whole += rest.bytes;
    at = rest.at;
  }
  whole += std::string_view(out_).substr(at);
  return whole;
}

}  // namespace tubecut::api
