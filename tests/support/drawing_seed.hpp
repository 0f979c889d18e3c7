#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace tubecut {

/// Returns the seed of requests that a test draws: always 1, because a change is tested by the same
/// requests as the one before it, unless TUBECUT_SEED gives another (`./dev soak drawn` does).
inline std::uint64_t drawing_seed() {
  const char* given = std::getenv("TUBECUT_SEED");
  const auto seed = given ? std::strtoull(given, nullptr, 10) : 1;
  std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
  return seed;
}

}  // namespace tubecut
