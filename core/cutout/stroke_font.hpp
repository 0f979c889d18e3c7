#pragma once

#include <vector>

#include "core/cutout/chain.hpp"

/// The project's own letters: open lines on a grid, for a tool that scribes or a torch that marks.
namespace tubecut::cutout {

/// A line of straight pieces, of at least two points.
using Stroke = std::vector<Flat>;

/// The grid on which letters lie, in units: x from 0 to 4, y from 0 to 7, in halves. A capital is
/// as high as the grid, and the next letter begins 6 units further.
inline constexpr double kGridWidth = 4.0, kGridHeight = 7.0, kAdvance = 6.0;

/// The printable ASCII characters, from the space to the tilde.
inline constexpr char kFirstLetter = ' ', kLastLetter = '~';
[[nodiscard]] constexpr bool has_letter(char c) { return c >= kFirstLetter && c <= kLastLetter; }

/// Returns the strokes of a letter on its grid: x to the right, y up. A space has none.
/// `c`: one of the font.
[[nodiscard]] std::vector<Stroke> letter(char c);

}  // namespace tubecut::cutout
