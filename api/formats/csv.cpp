#include "api/formats/csv.hpp"

#include <algorithm>

#include "api/formats/text.hpp"
#include "api/stop.hpp"
#include "api/wire/json.hpp"

namespace tubecut::api {
namespace {

constexpr std::size_t kRowBytes = 4096;  // more than a row of numbers has

/// Replaces separators, so that no spreadsheet reads a part of it as another cell.
std::string unseparated(std::string text) {
  for (auto& c : text)
    if (std::string_view(",;|\"\t\r\n").find(c) != std::string_view::npos) c = ' ';
  return text;
}

std::size_t size_of(const Column::Values& values) {
  return std::visit([](const auto& v) { return v.size(); }, values);
}

std::size_t rows_of(const Columns& table) {
  std::size_t rows = 0;
  for (const auto& column : table.all()) rows = std::max(rows, size_of(column.values));
  return rows;
}

void print_cell(const Column::Values& values, std::size_t i, std::string& out) {
  if (const auto* numbers = std::get_if<std::vector<double>>(&values))
    append_number(out, (*numbers)[i]);
  else if (const auto* integers = std::get_if<std::vector<std::int64_t>>(&values))
    out += std::to_string((*integers)[i]);
  else if (const auto* flags = std::get_if<std::vector<bool>>(&values))
    out += (*flags)[i] ? "true" : "false";
  else if (const auto* some = std::get_if<std::vector<std::optional<double>>>(&values)) {
    if (const auto& number = (*some)[i]) append_number(out, *number);
  } else
    out += csv_text(std::get<std::vector<std::string>>(values)[i]);
}

}  // namespace

Csv& Csv::table(const Columns& columns) {
  for (const auto& [name, values, seen] : columns.all()) {
    ask();
    if (seen) columns_.push_back({name, {{0, values}}});
  }
  return *this;
}

Csv& Csv::stacked(std::string_view label,
                  const std::vector<std::pair<std::string, Columns>>& tables) {
  Stack labels{std::string(label), {}};
  std::vector<Stack> stacks;
  std::size_t from = 0;
  for (const auto& [name, table] : tables) {
    const auto rows = rows_of(table);
    labels.ranges.push_back({from, std::vector<std::string>(rows, name)});
    for (const auto& column : table.all()) {
      ask();
      auto stack = std::ranges::find(stacks, column.name, &Stack::name);
      if (stack == stacks.end()) stack = stacks.insert(stacks.end(), Stack{column.name, {}});
      stack->ranges.push_back({from, column.values});
    }
    from += rows;
  }
  columns_.push_back(std::move(labels));
  std::ranges::move(stacks, std::back_inserter(columns_));
  return *this;
}

std::string Csv::print() const {
  std::string out;
  for (const auto& line : head_) out += "# " + unseparated(line) + "\r\n";
  std::size_t rows = 0;
  for (const auto& column : columns_) {
    out += (&column == columns_.data() ? "" : ",") + csv_text(column.name);
    for (const auto& range : column.ranges)
      rows = std::max(rows, range.from + size_of(range.values));
  }
  out += "\r\n";
  std::vector<std::size_t> at(columns_.size(), 0);  // the range that a column is in
  for (std::size_t i = 0; i < rows; ++i) {
    ask();
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      if (k > 0) out += ',';
      const auto& ranges = columns_[k].ranges;
      while (at[k] < ranges.size() && i >= ranges[at[k]].from + size_of(ranges[at[k]].values))
        ++at[k];
      if (at[k] < ranges.size() && i >= ranges[at[k]].from)
        print_cell(ranges[at[k]].values, i - ranges[at[k]].from, out);
    }
    out += "\r\n";
  }
  return out;
}

}  // namespace tubecut::api
