#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/section/section.hpp"

namespace tubecut::api {

/// A rectangular tube sold under a name. The name has the standard, because corners differ by it.
struct SectionSize {
  std::string name;  // "RHS 100x50x4 EN 10210"
  section::Section section;
  std::string_view standard;  // with its edition
};

/// Returns every size by name: common sizes of EN 10210-2, EN 10219-2 and ASTM A500, corners as the
/// standard calculates its properties.
[[nodiscard]] std::span<const SectionSize> section_sizes();

/// Returns the size with exactly that name, or nullptr.
[[nodiscard]] const SectionSize* find_section_size(std::string_view name);

/// Returns a hint for an unknown name: the sizes that begin with it, or the most similar one.
[[nodiscard]] std::string section_size_hint(std::string_view name);
/// Returns whether a name, known or not, is meant for a tube that is not round.
[[nodiscard]] bool is_section_size(std::string_view name);

}  // namespace tubecut::api
