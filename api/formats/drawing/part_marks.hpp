#pragma once

#include <string>

#include "core/part/part.hpp"
#include "core/part/section/section_part.hpp"

namespace tubecut::api {

struct Post;

/// Returns the instruction for a mark that a machine file leaves to a person: the mark, its phi,
/// and its range from the start's long point. On a section, its girth.
[[nodiscard]] std::string mark_by_hand(const part::Mark& mark, const Post& post);
[[nodiscard]] std::string mark_by_hand(const part::SectionMark& mark, const Post& post);

/// Returns "text A1, 7 mm high, turned 30°": a text without its place.
[[nodiscard]] std::string text_in_words(const cutout::Lettering& text);

}  // namespace tubecut::api
