#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <stop_token>
#include <vector>

namespace tubecut {

/// Sorts in ascending order like std::ranges::sort and checks for cancellation at least every few
/// ms of work. If cancelled, the order is undefined.
template <class T, class Projection = std::identity>
void sort_unless_stopped(std::vector<T>& values, const std::stop_token& stop, Projection of = {}) {
  constexpr std::ptrdiff_t kBlock = 8192;
  const auto n = static_cast<std::ptrdiff_t>(values.size());
  const auto at = [&](std::ptrdiff_t i) { return values.begin() + std::min(i, n); };
  for (std::ptrdiff_t i = 0; i < n && !stop.stop_requested(); i += kBlock)
    std::ranges::sort(at(i), at(i + kBlock), {}, of);
  for (std::ptrdiff_t width = kBlock; width < n; width *= 2)
    for (std::ptrdiff_t i = 0; i + width < n && !stop.stop_requested(); i += 2 * width)
      std::ranges::inplace_merge(at(i), at(i + width), at(i + 2 * width), {}, of);
}

}  // namespace tubecut
