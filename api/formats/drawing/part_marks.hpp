#pragma once

#include <string>

#include "core/part/part.hpp"

namespace tubecut::api {

struct Post;

/// Returns the instruction for a mark that a machine file leaves to a person: the mark, its phi,
/// and its range from the start's long point.
[[nodiscard]] std::string mark_by_hand(const part::Mark& mark, const Post& post);

}  // namespace tubecut::api
