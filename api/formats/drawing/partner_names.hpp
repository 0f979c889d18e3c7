#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tubecut::api {

struct Json;
struct Caption;

/// What the `count` partners of a cut are called: `ids` where the answer has those, else by `id` in
/// its `cutters` as understood, else "partner 1".
[[nodiscard]] std::vector<std::string> partner_names(const Json* cut,
                                                     const std::vector<std::string>& ids,
                                                     std::size_t count);

/// "chord > brace": where the cut goes on from one partner to another.
[[nodiscard]] std::string change_of_partner(const Caption& caption, std::size_t from,
                                            std::size_t to);

}  // namespace tubecut::api
