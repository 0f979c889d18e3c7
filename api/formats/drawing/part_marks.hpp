#pragma once

#include <string>

#include "core/part/part.hpp"

namespace tubecut::api {

struct Post;

/// A mark that a machine file leaves to a person: what, at which phi, from where to where off the
/// start's long point.
[[nodiscard]] std::string mark_by_hand(const part::Mark& mark, const Post& post);

}  // namespace tubecut::api
