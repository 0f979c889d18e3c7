#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tubecut::api {

/// Columns as text/csv (RFC 4180): a header row of names that carry their units, then rows; numbers
/// shortest-round-trip.
class Csv {
 public:
  Csv& column(std::string name, const std::vector<double>& values);
  /// Radians inside, degrees in the file.
  Csv& degrees(std::string name, const std::vector<double>& radians);
  template <class T>
  Csv& integers(std::string name, const std::vector<T>& values) {
    std::vector<std::string> cells;
    cells.reserve(values.size());
    for (const auto v : values) cells.push_back(std::to_string(v));
    return cells_column(std::move(name), std::move(cells));
  }
  /// Text cells; quoted where they need it.
  Csv& cells_column(std::string name, std::vector<std::string> cells);

  /// Shorter columns end in empty cells.
  [[nodiscard]] std::string print() const;

 private:
  struct Column {
    std::string name;
    std::vector<std::string> cells;
  };
  std::vector<Column> columns_;
};

}  // namespace tubecut::api
