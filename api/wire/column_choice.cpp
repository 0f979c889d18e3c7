#include "api/wire/column_choice.hpp"

#include <algorithm>

namespace tubecut::api {

std::vector<std::string> decode_columns(Reader& in, const std::vector<std::string>& known,
                                        const std::vector<std::string>& there) {
  in.note("columns");
  if (!in.has("columns")) return {};
  const auto& offered = in.refused() ? known : there;
  const auto names = in.text_column("columns", {.min = 1, .max = known.size()});
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (name->empty()) continue;  // not a text: already reported
    const bool is_there = std::ranges::find(offered, *name) != offered.end();
    if (is_there && std::find(names.begin(), name, *name) == name) continue;
    const bool elsewhere = std::ranges::find(known, *name) != known.end();
    in.issue({.code = ErrorCode::bad_choice,
              .pointer = "columns/" + std::to_string(name - names.begin()),
              .got = Json{*name},
              .limit = Json{one_of(offered)},
              .hint = is_there    ? "named twice"
                      : elsewhere ? "not of this table"
                                  : ""});
  }
  return names;
}

}  // namespace tubecut::api
