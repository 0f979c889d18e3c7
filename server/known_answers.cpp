#include "server/selftest.hpp"

namespace tubecut::server {

std::span<const KnownAnswer> known_answers() {
  static constexpr KnownAnswer kKnown[] = {
#include "server/known_answers.inc"
  };
  return kKnown;
}

}  // namespace tubecut::server
