#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/wire/writer.hpp"
#include "core/base/variant.hpp"

namespace tubecut::api {

/// One column of an answer's table, under the name the wire gives it.
struct Column {
  using Values = Variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::string>,
                         std::vector<bool>, std::vector<std::optional<double>>>;
  std::string name;
  Values values;
  bool seen = true;  // whether it is printed; it is always hashed
};

/// A table of an answer, defined once: JSON and CBOR print it as members of an object, CSV as
/// columns.
class Columns {
 public:
  Columns& column(std::string_view name, std::vector<double> values) {
    return add(name, std::move(values));
  }
  /// Radians inside, degrees on the wire.
  Columns& degrees(std::string_view name, std::vector<double> radians);
  template <std::integral T>
  requires(!std::same_as<T, bool>) Columns& integers(std::string_view name,
                                                     const std::vector<T>& values) {
    return add(name, std::vector<std::int64_t>(values.begin(), values.end()));
  }
  Columns& texts(std::string_view name, std::vector<std::string> values) {
    return add(name, std::move(values));
  }
  /// Adds numbers that may be missing in a row: NaN becomes null, in CSV an empty cell.
  Columns& where_any(std::string_view name, const std::vector<double>& values);
  Columns& flags(std::string_view name, std::vector<bool> values) {
    return add(name, std::move(values));
  }
  /// Of all these only those of these names are seen, in the order they have; no names: all.
  Columns& only(const std::vector<std::string>& names);
  /// The columns of another table, each name with `prefix` before it.
  Columns& append(std::string_view prefix, const Columns& other);

  [[nodiscard]] const std::vector<Column>& all() const { return all_; }
  /// Members of the object that is being written.
  void write(Writer& w) const;

 private:
  Columns& add(std::string_view name, Column::Values values) {
    all_.push_back({std::string(name), std::move(values)});
    return *this;
  }

  std::vector<Column> all_;
};

}  // namespace tubecut::api
