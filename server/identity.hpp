#pragma once

#include <optional>
#include <string>

#include "server/http/http.hpp"

namespace tubecut::server {

/// Whether a text can be a job's or a request's name: 1 to 128 printable ASCII characters without
/// spaces at its ends.
[[nodiscard]] bool sound_id(std::string_view id);

/// The names of a request. They are only for answers and logs; nothing is stored under them.
struct Identity {
  std::string request_id;       // the client's X-Request-Id when it is sound, else 128 random bits
  std::string job_id;           // Job-Id, else Idempotency-Key, else empty
  std::string job_id_header;    // as sent, to be echoed
  std::string idempotency_key;  // as sent, to be echoed
  std::string traceparent;      // W3C trace context, when sound
};

/// Longest Job-Id, Idempotency-Key or X-Request-Id, in characters.
inline constexpr std::size_t kLongestId = 128;

/// Reads the names from the headers. An id is 1 to 128 printable ASCII characters without spaces at
/// its ends. If a name is not valid, it is omitted.
[[nodiscard]] Identity identify(const Headers& headers);

/// Returns the fault of Job-Id or Idempotency-Key, if there is one. These are refused rather than
/// omitted, because a job under another name could not be found again. (A malformed traceparent or
/// X-Request-Id does no harm.)
[[nodiscard]] std::optional<Refusal> job_name_fault(const Headers& headers);

/// 128 random bits from the kernel as 32 hex digits.
[[nodiscard]] std::string random_id();

}  // namespace tubecut::server
