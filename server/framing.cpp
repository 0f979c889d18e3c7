#include "server/framing.hpp"

#include <algorithm>
#include <charconv>

namespace tubecut::server {
namespace {

/// Digits only, and few enough for 64 bits.
bool whole_number(std::string_view text) {
  return !text.empty() && text.size() < 19 &&
         std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::string_view framing_fault(const Headers& headers) {
  const auto lengths = header_values(headers, "Content-Length");
  const auto codings = header_values(headers, "Transfer-Encoding");
  if (lengths.size() > 1) return "Content-Length is sent more than once.";
  if (codings.size() > 1) return "Transfer-Encoding is sent more than once.";
  if (!lengths.empty() && !codings.empty()) {
    return "Content-Length and Transfer-Encoding are both sent.";
  }
  if (!lengths.empty() && !whole_number(lengths.front())) {
    return "Content-Length is not a whole number.";
  }
  if (!codings.empty() && !equal_ignoring_case(codings.front(), "chunked")) {
    return "Transfer-Encoding is not chunked.";
  }
  if (header_values(headers, "Host").size() > 1) return "Host is sent more than once.";
  return {};
}

bool announces_body(const Headers& headers) {
  return announced_length(headers) > 0 || !header_values(headers, "Transfer-Encoding").empty();
}

std::uint64_t announced_length(const Headers& headers) {
  const auto text = header(headers, "Content-Length");
  std::uint64_t length = 0;
  std::from_chars(text.data(), text.data() + text.size(), length);
  return length;
}

}  // namespace tubecut::server
