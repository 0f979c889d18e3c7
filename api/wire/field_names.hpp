#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tubecut::api {

/// Returns the candidate most similar to `name`; empty if no candidate is near.
[[nodiscard]] std::string nearest_name(std::string_view name,
                                       const std::vector<std::string>& candidates);

/// Returns the field most likely meant by `name`: a synonym (`od` for `outer_diameter_mm`), a field
/// that ends in `name`, or the nearest name.
[[nodiscard]] std::string nearest_field(std::string_view name,
                                        const std::vector<std::string>& fields);

/// Returns the field of which `name` is a typo; empty if there is no such field.
[[nodiscard]] std::string slip_of(std::string_view name, const std::vector<std::string>& fields);

/// Returns "a|b|c": the permitted values of a field, for limits and hints.
template <class All, class Name = std::identity>
[[nodiscard]] std::string one_of(const All& all, Name name = {}) {
  std::string out;
  for (const auto& one : all) {
    if (!out.empty()) out += '|';
    out += std::invoke(name, one);
  }
  return out;
}

/// "mm" for "offset_mm", "" for a pure number.
[[nodiscard]] std::string_view unit_of(std::string_view field);

}  // namespace tubecut::api
