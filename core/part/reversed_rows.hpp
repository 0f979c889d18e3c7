#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/bevel/table/table_columns.hpp"

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

/// A column seen from the tube's other end, `length` away. Stations are the caller's.
inline void mirror_column(bevel::ColumnKind kind, const std::vector<double>& from,
                          const std::vector<std::size_t>& order, double length,
                          std::vector<double>& to) {
  switch (kind) {
    case bevel::ColumnKind::station:
      return;
    case bevel::ColumnKind::height:
      to = mirrored(from, order, length);
      return;
    case bevel::ColumnKind::elevation:
    case bevel::ColumnKind::rate:
      to = mirrored(from, order);
      return;
    case bevel::ColumnKind::plain:
      to = picked(from, order);
      return;
  }
}

/// Abscissae along the cut, which run the other way too, from the datum line; `zeros` rows lie on
/// it.
[[nodiscard]] inline std::vector<double> run_back(const std::vector<double>& column, double total,
                                                  std::size_t zeros,
                                                  const std::vector<std::size_t>& order) {
  const double datum = zeros > 0 ? column[zeros - 1] : 0.0;
  std::vector<double> out;
  out.reserve(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    out.push_back((k < zeros ? datum : total + datum) - column[order[k]]);
  return out;
}

/// Moves all that a table states of z, except its columns, by `dz`.
template <class Table>
void shift_places(Table& table, double dz) {
  for (auto* events : {&table.inner_events, &table.outer_events})
    for (auto& e : *events) {
      e.z_from += dz;
      e.z_to += dz;
    }
  table.penetration.z += dz;
}

/// Moves a column by `dz` if it is a height.
inline void shift_column(bevel::ColumnKind kind, std::vector<double>& column, double dz) {
  if (kind != bevel::ColumnKind::height) return;
  for (auto& z : column) z += dz;
}

/// Mirrors the events of a cut: `other_way` gives a place counted from the other end. They are
/// sorted by it.
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
