#pragma once

#include <algorithm>
#include <cstddef>
#include <stop_token>
#include <utility>
#include <vector>

namespace tubecut {

/// Reserves space for one more row behind `rows`. If rows must move for it, they move in parts. If
/// cancelled, `rows` is empty.
template <class T>
void make_room(std::vector<T>& rows, const std::stop_token& stop) {
  constexpr std::size_t kAtOnce = 8192;  // copied in far less than a millisecond
  if (rows.size() < rows.capacity() || rows.size() < kAtOnce) return;
  std::vector<T> larger;
  larger.reserve(2 * rows.size());
  for (std::size_t i = 0; i < rows.size(); i += kAtOnce) {
    if (stop.stop_requested()) return rows.clear();
    const auto first = rows.begin() + static_cast<std::ptrdiff_t>(i);
    larger.insert(larger.end(), first,
                  first + static_cast<std::ptrdiff_t>(std::min(kAtOnce, rows.size() - i)));
  }
  rows = std::move(larger);
}

}  // namespace tubecut
