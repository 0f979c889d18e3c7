#pragma once

#include <optional>
#include <string>

#include "server/http/http.hpp"

namespace tubecut::server {

/// Whether a text can be a job's or a request's name: 1 to 128 printable ASCII characters without
/// spaces at its ends.
[[nodiscard]] bool sound_id(std::string_view id);

/// The names a request goes by. Nothing is stored under them: they are for answers and logs.
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
/// its ends. An unsound name is left out.
[[nodiscard]] Identity identify(const Headers& headers);

/// What is wrong with Job-Id or Idempotency-Key, if anything. These are refused rather than left
/// out: a job under another name than its sender's could not be found again. (An unsound
/// traceparent or X-Request-Id harms nobody.)
[[nodiscard]] std::optional<Refusal> job_name_fault(const Headers& headers);

/// 128 random bits from the kernel as 32 hex digits.
[[nodiscard]] std::string random_id();

}  // namespace tubecut::server
