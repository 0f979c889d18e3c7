#include "server/http/printer.hpp"

#include <fmt/format.h>

#include <array>
#include <boost/beast/http/status.hpp>
#include <ctime>
#include <iterator>

namespace tubecut::server {
namespace {

/// If a body is larger than this, copying it behind its head costs more than sending it separately.
constexpr std::size_t kCopied = 4u << 10;

/// RFC 9110, 6.6.1. Printed once a second and thread.
std::string_view http_date() {
  static constexpr std::array kDays = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  static constexpr std::array kMonths = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                         "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  thread_local std::time_t printed = 0;
  thread_local std::string text;
  const std::time_t now = std::time(nullptr);
  if (now == printed) return text;
  std::tm utc{};
  gmtime_r(&now, &utc);
  text = fmt::format("{}, {:02} {} {} {:02}:{:02}:{:02} GMT",
                     kDays.at(static_cast<std::size_t>(utc.tm_wday)), utc.tm_mday,
                     kMonths.at(static_cast<std::size_t>(utc.tm_mon)), 1900 + utc.tm_year,
                     utc.tm_hour, utc.tm_min, utc.tm_sec);
  printed = now;
  return text;
}

std::string_view reason(int status) {
  namespace http = boost::beast::http;
  const auto text = http::obsolete_reason(http::int_to_status(static_cast<unsigned>(status)));
  return {text.data(), text.size()};
}

}  // namespace

std::string print_head(const Response& response, std::chrono::seconds idle,
                       std::string_view framing) {
  std::string out;
  out.reserve(512);
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "HTTP/1.1 {} {}\r\nDate: {}\r\n", response.status, reason(response.status),
                 http_date());
  if (!response.content_type.empty()) {
    fmt::format_to(to, "Content-Type: {}\r\n", response.content_type);
  }
  for (const auto& [name, value] : response.headers) {
    out.append(name).append(": ").append(value).append("\r\n");
  }
  if (idle.count() > 0) {
    fmt::format_to(to, "Keep-Alive: timeout={}\r\n", idle.count());
  } else {
    out += "Connection: close\r\n";
  }
  return out.append(framing).append("\r\n");
}

Printed print(Response response, std::string_view method, std::chrono::seconds idle) {
  const bool bare = response.status == 204 || response.status == 304;  // RFC 9110, 8.6
  const auto framing =
      bare ? std::string()
           : fmt::format("Content-Length: {}\r\n", response.body.size() + response.fixed.size());
  Printed out{.bytes = print_head(response, idle, framing), .sent = std::move(response.sent)};
  if (bare || method == "HEAD") return out;
  out.fixed = response.fixed;
  if (response.body.size() > kCopied) {
    out.rest = std::move(response.body);
    return out;
  }
  out.bytes.reserve(out.bytes.size() + response.body.size());
  out.bytes += response.body;
  return out;
}

std::string print_chunk(std::string_view text) {
  auto out = fmt::format("{:x}\r\n", text.size());
  out.reserve(out.size() + text.size() + 2);
  return out.append(text).append("\r\n");
}

}  // namespace tubecut::server
