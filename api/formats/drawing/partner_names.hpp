#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tubecut::api {

struct Json;
struct Caption;

/// Returns the names of the `count` partners of a cut: `ids` if the answer has them, else `id` in
/// its `cutters` with defaults applied, else "partner 1".
[[nodiscard]] std::vector<std::string> partner_names(const Json* cut,
                                                     const std::vector<std::string>& ids,
                                                     std::size_t count);

/// Returns "chord > brace" for a point at which the cut passes from one partner to another.
[[nodiscard]] std::string change_of_partner(const Caption& caption, std::size_t from,
                                            std::size_t to);

}  // namespace tubecut::api
