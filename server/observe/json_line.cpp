#include "server/observe/json_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tubecut::server {
namespace {

constexpr std::size_t kText = 2048;  // bytes printed of one text
constexpr std::size_t kTexts =
    10240;  // of the line; two names and texts and the numbers come on top

}  // namespace

void JsonLine::separate() {
  if (x_.back() != '{' && x_.back() != '[') x_ += ',';
}

void JsonLine::key(std::string_view name) {
  separate();
  quote(name);
  x_ += ':';
}

namespace {

/// Length of the UTF-8 sequence of two to four bytes that `text` begins with; 0 when it begins with
/// none. Overlong forms and surrogates are left to the reader of the line: they harm no JSON
/// parser's framing.
std::size_t utf8_sequence(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  const std::size_t length = lead >= 0xf0 && lead < 0xf5 ? 4
                             : lead >= 0xe0              ? 3
                             : lead >= 0xc2              ? 2
                                                         : 0;
  if (lead >= 0xf5 || length == 0 || text.size() < length) return 0;
  for (const char c : text.substr(1, length - 1)) {
    if ((static_cast<unsigned char>(c) & 0xc0) != 0x80) return 0;
  }
  return length;
}

}  // namespace

/// No more texts then: the numbers that follow still have room.
bool JsonLine::full() {
  const bool full = x_.size() > kTexts;
  left_out_ += full ? 1 : 0;
  return full;
}

std::string JsonLine::done() {
  if (left_out_ > 0) integer("left_out", left_out_);
  return x_ + '}';
}

/// UTF-8 stays as it is; control characters and bytes that are no UTF-8 become \u00XX: whatever the
/// bytes are, the line stays one line of valid JSON that no terminal interprets.
void JsonLine::quote(std::string_view value) {
  x_ += '"';
  const auto most = x_.size() + kText;
  while (!value.empty()) {
    if (x_.size() >= most) {
      ++left_out_;
      break;
    }
    const auto byte = static_cast<unsigned char>(value.front());
    const std::size_t length = byte < 0x80 ? 1 : utf8_sequence(value);
    if (byte == '"' || byte == '\\') {
      x_ += '\\';
      x_ += value.front();
    } else if (byte < 0x20 || byte == 0x7f || length == 0) {
      fmt::format_to(std::back_inserter(x_), "\\u{:04x}", byte);
    } else {
      x_ += value.substr(0, length);
    }
    value.remove_prefix(std::max<std::size_t>(length, 1));
  }
  x_ += '"';
}

JsonLine& JsonLine::text(std::string_view name, std::string_view value) {
  if (full()) return *this;
  key(name);
  quote(value);
  return *this;
}

JsonLine& JsonLine::integer(std::string_view name, std::int64_t value) {
  key(name);
  x_ += std::to_string(value);
  return *this;
}

JsonLine& JsonLine::milliseconds(std::string_view name, double seconds) {
  key(name);
  const double ms = std::isfinite(seconds) ? 1e3 * seconds : 0.0;
  fmt::format_to(std::back_inserter(x_), "{:.3f}", ms);
  return *this;
}

JsonLine& JsonLine::open(std::string_view name, char bracket) {
  key(name);
  x_ += bracket;
  return *this;
}

JsonLine& JsonLine::item(std::string_view value) {
  if (full()) return *this;
  separate();
  quote(value);
  return *this;
}

JsonLine& JsonLine::close(char bracket) {
  x_ += bracket;
  return *this;
}

}  // namespace tubecut::server
