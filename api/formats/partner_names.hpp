#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tubecut::api {

struct Json;

/// What the `count` partners of a cut are called: `ids` where the answer has those, else by `id` in
/// its `cutters` as understood, else "partner 1".
[[nodiscard]] std::vector<std::string> partner_names(const Json* cut,
                                                     const std::vector<std::string>& ids,
                                                     std::size_t count);

}  // namespace tubecut::api
