#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/wire/json.hpp"

namespace tubecut::testing {

/// The text of a file of the project, by its path from the top. Fails the program when it is
/// missing or empty.
[[nodiscard]] std::string read_project_file(std::string_view path);

/// A file of tests/golden, parsed. Fails the program when it is missing: an absent corpus never
/// passes.
[[nodiscard]] api::Json golden(std::string_view file);

/// json["a"]["b"][3] as at(json, "a/b/3"); throws std::out_of_range naming the path.
[[nodiscard]] const api::Json& at(const api::Json& json, std::string_view path);
[[nodiscard]] double number(const api::Json& json, std::string_view path = "");
[[nodiscard]] std::string text(const api::Json& json, std::string_view path);
/// Numbers, or numbers written as strings with more digits than a double holds.
[[nodiscard]] std::vector<double> numbers(const api::Json& json, std::string_view path = "");

}  // namespace tubecut::testing
