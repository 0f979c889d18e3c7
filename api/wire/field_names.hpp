#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tubecut::api {

/// The candidate most like `name`, empty when none is near.
[[nodiscard]] std::string nearest_name(std::string_view name,
                                       const std::vector<std::string>& candidates);

/// The field most likely meant by `name`: one that says the same in other words (`od` for
/// `outer_diameter_mm`), one that `name` is the end of, or the nearest name.
[[nodiscard]] std::string nearest_field(std::string_view name,
                                        const std::vector<std::string>& fields);

/// The field that `name` is a slip of the pen from; empty when there is none.
[[nodiscard]] std::string slip_of(std::string_view name, const std::vector<std::string>& fields);

/// "a|b|c": what may stand in a field, as limits and hints tell it.
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
