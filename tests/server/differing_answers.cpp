#include "server/selftest.hpp"

namespace tubecut::server {

/// In place of server/known_answers.cpp: the true ones, and last one that no job gives.
std::span<const KnownAnswer> known_answers() {
  static constexpr KnownAnswer kKnown[] = {
#include "server/known_answers.inc"
      {"bevel-tables", "mitre", "0000000000000000000000000000000000000000000000000000000000000000"},
  };
  return kKnown;
}

}  // namespace tubecut::server
