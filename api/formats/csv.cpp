#include "api/formats/csv.hpp"

#include <algorithm>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"

namespace tubecut::api {
namespace {

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
  std::string out = "\"";
  for (const char c : cell) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

}  // namespace

Csv& Csv::cells_column(std::string name, std::vector<std::string> cells) {
  columns_.push_back({std::move(name), std::move(cells)});
  return *this;
}

Csv& Csv::column(std::string name, const std::vector<double>& values) {
  std::vector<std::string> cells;
  cells.reserve(values.size());
  for (const double v : values) cells.push_back(shown(v));
  return cells_column(std::move(name), std::move(cells));
}

Csv& Csv::degrees(std::string name, const std::vector<double>& radians) {
  std::vector<std::string> cells;
  cells.reserve(radians.size());
  for (const double v : radians) cells.push_back(shown(v * kDegPerRad));
  return cells_column(std::move(name), std::move(cells));
}

std::string Csv::print() const {
  std::string out;
  std::size_t rows = 0;
  for (const auto& column : columns_) {
    out += (out.empty() ? "" : ",") + quoted(column.name);
    rows = std::max(rows, column.cells.size());
  }
  out += "\r\n";
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      if (k > 0) out += ',';
      if (i < columns_[k].cells.size()) out += quoted(columns_[k].cells[i]);
    }
    out += "\r\n";
  }
  return out;
}

}  // namespace tubecut::api
