#include "api/wire/columns.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/angle.hpp"

namespace tubecut::api {

Columns& Columns::degrees(std::string_view name, std::vector<double> radians) {
  for (auto& v : radians) v *= kDegPerRad;
  return column(name, std::move(radians));
}

Columns& Columns::where_any(std::string_view name, const std::vector<double>& values) {
  std::vector<std::optional<double>> out;
  out.reserve(values.size());
  for (const double v : values) out.push_back(std::isnan(v) ? std::nullopt : std::optional(v));
  return add(name, std::move(out));
}

Columns& Columns::append(std::string_view prefix, const Columns& other) {
  for (const auto& c : other.all_) add(std::string(prefix) + c.name, c.values);
  return *this;
}

Columns& Columns::only(const std::vector<std::string>& names) {
  for (auto& column : all_)
    column.seen = names.empty() || std::ranges::find(names, column.name) != names.end();
  return *this;
}

namespace {

void write_column(const Column& column, Writer& w) {
  const auto& [name, values, seen] = column;
  if (const auto* flags = std::get_if<std::vector<bool>>(&values))
    w.flags(name, *flags);
  else if (const auto* numbers = std::get_if<std::vector<double>>(&values))
    w.column(name, *numbers);
  else if (const auto* integers = std::get_if<std::vector<std::int64_t>>(&values))
    w.column(name, *integers);
  else if (const auto* some = std::get_if<std::vector<std::optional<double>>>(&values))
    w.array(name, *some, [](Writer& cell, const std::optional<double>& v) {
      if (v)
        cell.value(*v);
      else
        cell.json(Json{});
    });
  else
    w.column(name, std::get<std::vector<std::string>>(values));
}

}  // namespace

void Columns::write(Writer& w) const {
  for (const auto& column : all_) {
    if (column.seen)
      write_column(column, w);
    else
      w.unseen([&column](Writer& whole) { write_column(column, whole); });
  }
}

}  // namespace tubecut::api
