#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tubecut::server {

/// An example the service carries and the hash its result had when the release was made.
struct KnownAnswer {
  std::string_view endpoint;
  std::string_view name;
  std::string_view result_sha256;
};

/// Quick jobs of every endpoint except mill-paths, whose shortest job takes longer than a whole
/// start may: they run before each start. If one changes, raise `numerics`. In a separate source,
/// so that a test can link others.
[[nodiscard]] std::span<const KnownAnswer> known_answers();

/// Answers the known jobs and compares each result's hash with the known one. Returns the first
/// difference as text, or an empty text. A replica that differs never becomes ready.
[[nodiscard]] std::string selftest_fault(std::span<const KnownAnswer> known = known_answers());

/// Prints one line per known job; with `all` one `{"endpoint", "name", "hash"},` per example, from
/// which known_answers.inc is made. 0: all as known.
[[nodiscard]] int selftest(bool all);

}  // namespace tubecut::server
