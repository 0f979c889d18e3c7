#include "server/identity.hpp"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <system_error>

namespace tubecut::server {
namespace {

bool printable(char c) { return c >= 0x20 && c <= 0x7e; }
bool lower_hex(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); }

bool all_zero(std::string_view digits) { return digits.find_first_not_of('0') == digits.npos; }

/// version-traceid-parentid-flags of W3C Trace Context, version 00.
bool sound_traceparent(std::string_view text) {
  if (text.size() != 55 || text.substr(0, 3) != "00-" || text[35] != '-' || text[52] != '-') {
    return false;
  }
  const auto trace = text.substr(3, 32);
  const auto parent = text.substr(36, 16);
  const auto flags = text.substr(53, 2);
  const auto hex = [](std::string_view digits) { return std::ranges::all_of(digits, lower_hex); };
  return hex(trace) && hex(parent) && hex(flags) && !all_zero(trace) && !all_zero(parent);
}

/// Returns the only valid value sent under `name`, or an empty text.
std::string sole_id(const Headers& headers, std::string_view name) {
  const auto values = header_values(headers, name);
  return values.size() == 1 && sound_id(values.front()) ? std::string(values.front())
                                                        : std::string{};
}

}  // namespace

bool sound_id(std::string_view id) {
  return !id.empty() && id.size() <= kLongestId && std::ranges::all_of(id, printable) &&
         id.front() != ' ' && id.back() != ' ';
}

std::string random_id() {
  std::array<std::uint64_t, 2> bits{};
  if (getrandom(bits.data(), sizeof bits, 0) != static_cast<ssize_t>(sizeof bits)) {
    throw std::system_error(errno, std::generic_category(), "getrandom");
  }
  return fmt::format("{:016x}{:016x}", bits[0], bits[1]);
}

Identity identify(const Headers& headers) {
  Identity id;
  id.request_id = sole_id(headers, "X-Request-Id");
  if (id.request_id.empty()) id.request_id = random_id();
  const auto trace = header(headers, "traceparent");
  if (sound_traceparent(trace)) id.traceparent = trace;
  id.idempotency_key = sole_id(headers, "Idempotency-Key");
  id.job_id_header = sole_id(headers, "Job-Id");
  id.job_id = id.job_id_header.empty() ? id.idempotency_key : id.job_id_header;
  return id;
}

std::optional<Refusal> job_name_fault(const Headers& headers) {
  for (const auto* name : {"Job-Id", "Idempotency-Key"}) {
    if (header_values(headers, name).empty() || !sole_id(headers, name).empty()) continue;
    return Refusal{ErrorCode::bad_request,
                   fmt::format("The header {} must be sent once and hold 1 to {} printable ASCII "
                               "characters without spaces at its ends.",
                               name, kLongestId)};
  }
  return std::nullopt;
}

}  // namespace tubecut::server
