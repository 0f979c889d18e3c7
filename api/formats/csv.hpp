#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/verdict.hpp"
#include "api/wire/columns.hpp"
#include "api/wire/format.hpp"

namespace tubecut::api {

/// Tables as text/csv: lines that begin with `#` and contain neither commas nor quotes, with the
/// verdict and notes on the columns; then RFC 4180, a header row of names with units, then rows;
/// numbers as in JSON, texts by csv_text, `true` and `false`.
class Csv {
 public:
  explicit Csv(const Caption& caption) : head_(verdict_lines(caption.verdict)) {}

  /// A line of the head.
  Csv& remark(std::string text) {
    head_.push_back(std::move(text));
    return *this;
  }
  /// Adds the table at the right of the existing columns; shorter columns end in empty cells.
  Csv& table(const Columns& columns);
  /// Adds tables one below the other, from the first row: the column `label` gives the table of a
  /// row, and a column that a table lacks is empty there.
  Csv& stacked(std::string_view label, const std::vector<std::pair<std::string, Columns>>& tables);

  [[nodiscard]] std::string print() const;

 private:
  struct RowRange {
    std::size_t from = 0;  // row
    Column::Values values;
  };
  struct Stack {
    std::string name;
    std::vector<RowRange> ranges;  // by their rows
  };
  std::vector<std::string> head_;
  std::vector<Stack> columns_;
};

}  // namespace tubecut::api
