#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tubecut::api {

/// A tube sold under a name. Lengths in mm, as the standard prints them.
struct TubeSize {
  std::string name;  // "NPS 4 SCH 40", "CHS 114.3x6.3"
  double outer_diameter = 0.0;
  double wall = 0.0;
  std::string_view standard;  // with its edition
};

/// Every size by name: wall thicknesses of ASME B36.10M, the circular hollow sections of EN 10210-2
/// and EN 10219-2 (the common part of their annexes B), and the pipes of EN 10255. Of a standard
/// only rows that are certain are here.
[[nodiscard]] std::span<const TubeSize> tube_sizes();

/// The size of that very name, or nullptr.
[[nodiscard]] const TubeSize* find_tube_size(std::string_view name);

/// Returns a hint for an unknown name: the sizes that begin with it, or the most similar one, with
/// a DN or inches read as their NPS; else the list of all names.
[[nodiscard]] std::string tube_size_hint(std::string_view name);

}  // namespace tubecut::api
