#pragma once

#include <string>

namespace tubecut::server {

/// Answers the known jobs and compares each result's hash with the one the release was made with.
/// Returns the first difference as text, or nothing. A replica that differs is never ready.
[[nodiscard]] std::string selftest_fault();

/// Prints one line per known job; with `all` one `{"endpoint", "name", "hash"},` per example, from
/// which known_answers.inc is made. 0: all as known.
[[nodiscard]] int selftest(bool all);

}  // namespace tubecut::server
