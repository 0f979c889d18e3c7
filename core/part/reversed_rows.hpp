#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

/// Rows of a table in the order of the tube's other end.
namespace tubecut::part {

/// Returns the rows in the order of descending places, the `zeros` first ones first.
[[nodiscard]] inline std::vector<std::size_t> reversed_rows(std::size_t count, std::size_t zeros) {
  std::vector<std::size_t> out;
  out.reserve(count);
  for (std::size_t i = zeros; i-- > 0;) out.push_back(i);
  for (std::size_t i = count; i-- > zeros;) out.push_back(i);
  return out;
}

template <class T>
[[nodiscard]] std::vector<T> picked(const std::vector<T>& column,
                                    const std::vector<std::size_t>& order) {
  std::vector<T> out;
  if (column.empty()) return out;
  out.reserve(order.size());
  for (const auto i : order) out.push_back(column[i]);
  return out;
}

[[nodiscard]] inline std::vector<double> mirrored(const std::vector<double>& column,
                                                  const std::vector<std::size_t>& order,
                                                  double about = 0.0) {
  auto out = picked(column, order);
  for (auto& v : out) v = about - v;
  return out;
}

/// Mirrors the events of a cut: `other_way` gives a place counted from the other end. They are not
/// sorted.
template <class Event, class OtherWay>
void mirror_events(std::vector<Event>& events, double length, double Event::*place,
                   const OtherWay& other_way) {
  for (auto& e : events) {
    e.*place = other_way(e.*place);
    std::swap(e.from, e.to);
    std::swap(e.z_from, e.z_to);
    e.z_from = length - e.z_from;
    e.z_to = length - e.z_to;
  }
  std::ranges::stable_sort(events, {}, place);
}

}  // namespace tubecut::part
