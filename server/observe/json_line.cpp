#include "server/observe/json_line.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

namespace tubecut::server {
namespace {

constexpr std::size_t kText = 2048;  // bytes printed of one text between its quotes
constexpr std::size_t kTexts =
    10240;  // of the line; two names and texts and the numbers come on top

/// Bytes that are no UTF-8 become U+FFFD: whatever the bytes are, the line stays one line of valid
/// JSON.
std::string quoted(std::string_view value) {
  using nlohmann::json;
  return json(value).dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

void JsonLine::separate() {
  if (x_.back() != '{' && x_.back() != '[') x_ += ',';
}

void JsonLine::key(std::string_view name) {
  separate();
  quote(name);
  x_ += ':';
}

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

void JsonLine::quote(std::string_view value) {
  auto some = value.substr(0, kText);
  auto text = quoted(some);
  while (text.size() > kText + 2) text = quoted(some = some.substr(0, some.size() / 2));
  left_out_ += some.size() < value.size() ? 1 : 0;
  x_ += text;
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
