#include "server/http/framing.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "api/wire/header_list.hpp"

namespace tubecut::server {
namespace {

/// Digits only, and few enough for 64 bits.
bool whole_number(std::string_view text) {
  return !text.empty() && text.size() < 19 &&
         std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

/// host [":" port], without what could be taken for another authority, a list or a path. The host
/// is not empty, and the port is a number.
bool sound_host(std::string_view host) {
  const bool clean = std::ranges::none_of(host, [](char c) {
    return c <= ' ' || c == 0x7f ||
           std::string_view("@/\\?#,\"<>").find(c) != std::string_view::npos;
  });
  const auto name = host.starts_with('[') ? host.find(']') + 1 : host.find(':');
  if (name == 0) return false;  // no name, or a bracket that is not closed
  const auto port = name < host.size() ? host.substr(name) : std::string_view(":");
  return clean && !host.empty() && port.starts_with(':') && port.size() <= 6 &&
         port.find_first_not_of("0123456789", 1) == port.npos;
}

std::string_view length_fault(const Headers& headers) {
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
  return {};
}

bool starts_with_ignoring_case(std::string_view text, std::string_view prefix) {
  return equal_ignoring_case(text.substr(0, prefix.size()), prefix);
}

}  // namespace

std::string_view framing_fault(const Headers& headers, int minor) {
  if (const auto fault = length_fault(headers); !fault.empty()) return fault;
  if (minor == 0 && !header_values(headers, "Transfer-Encoding").empty()) {
    return "Transfer-Encoding is not part of HTTP/1.0.";
  }
  const auto hosts = header_values(headers, "Host");
  if (hosts.size() > 1) return "Host is sent more than once.";
  if (hosts.empty() && minor > 0) return "Host is missing.";
  if (!hosts.empty() && !sound_host(hosts.front())) return "Host is not a host.";
  return {};
}

std::string_view byte_fault(std::string_view head, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < to; ++i) {
    const auto c = static_cast<unsigned char>(head[i]);
    const char next = i + 1 < head.size() ? head[i + 1] : '\0';
    if (c == '\r' && next == '\n') continue;
    if (c == '\n' && i > 0 && head[i - 1] == '\r') {
      if (next == ' ' || next == '\t') return "A header line is folded.";
      continue;
    }
    if (c == '\r' || c == '\n') return "A line of the head does not end with CR LF.";
    if ((c < 0x20 && c != '\t') || c == 0x7f) return "The head holds a control character.";
  }
  return {};
}

std::uint64_t announced_length(const Headers& headers) {
  const auto text = header(headers, "Content-Length");
  std::uint64_t length = 0;
  std::from_chars(text.data(), text.data() + text.size(), length);
  return length;
}

bool lists_token(const Headers& headers, std::string_view name, std::string_view token) {
  return std::ranges::any_of(header_values(headers, name), [&](std::string_view value) {
    return std::ranges::any_of(api::header_list(value), [&](const auto& element) {
      return equal_ignoring_case(element.name, token);
    });
  });
}

std::string origin_form(std::string_view target, std::string_view method) {
  const auto visible = [](char c) { return c > ' ' && c < 0x7f && c != '#'; };
  if (!std::ranges::all_of(target, visible)) return {};
  if (target.starts_with('/')) return std::string(target);
  if (target == "*" && method == "OPTIONS") return "*";
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (!starts_with_ignoring_case(target, scheme)) continue;
    target.remove_prefix(scheme.size());
    const auto end = std::min(target.find_first_of("/?"), target.size());
    if (end == 0 || !sound_host(target.substr(0, end))) return {};
    target.remove_prefix(end);
    return target.starts_with('/') ? std::string(target) : "/" + std::string(target);
  }
  return {};
}

}  // namespace tubecut::server
