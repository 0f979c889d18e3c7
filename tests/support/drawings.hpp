#pragma once

#include <cstdlib>
#include <string_view>

namespace tubecut::testing {

/// Returns how many drawings a test makes: `few`, because every change waits for them, or `all`
/// with TUBECUT_DRAWINGS=all (`./dev soak drawn`).
inline int drawings(int few, int all) {
  const char* asked = std::getenv("TUBECUT_DRAWINGS");  // NOLINT(concurrency-mt-unsafe)
  return asked != nullptr && std::string_view(asked) == "all" ? all : few;
}

}  // namespace tubecut::testing
