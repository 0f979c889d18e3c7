#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/names.hpp"

namespace tubecut::api {

/// Unit of a control's lengths: coordinates, heights and feeds.
enum class PostUnits { mm, inch };

/// Unit of a control's tube rotation. A girth is a length along the circumference.
enum class TurnUnit { deg, mm_girth, inch_girth, revolution };

inline constexpr double kMmPerInch = 25.4;

/// A word of a program that sets the control's units.
struct UnitWord {
  std::string word;  // "G20"
  PostUnits units = PostUnits::mm;
};

/// Finds the first word in a line that makes a control count in other units than `units`: G20, G70,
/// G700 (inch) and G21, G71, G710 (mm) in any spelling ("g 020", "N10G20"), and the end of
/// Heidenhain's BEGIN PGM. Comments, texts in quotes, names in <> and values in braces are not
/// words.
///
/// Example  other_units("G20 G40 G90", "(", ")", PostUnits::mm)->word is "G20".
[[nodiscard]] std::optional<UnitWord> other_units(std::string_view line,
                                                  std::string_view comment_begin,
                                                  std::string_view comment_end, PostUnits units);

}  // namespace tubecut::api

namespace tubecut {

template <>
inline constexpr std::array kNames<api::PostUnits>{
    Option<api::PostUnits>{"mm", api::PostUnits::mm},
    Option<api::PostUnits>{"inch", api::PostUnits::inch}};

template <>
inline constexpr std::array kNames<api::TurnUnit>{
    Option<api::TurnUnit>{"deg", api::TurnUnit::deg},
    Option<api::TurnUnit>{"mm_girth", api::TurnUnit::mm_girth},
    Option<api::TurnUnit>{"inch_girth", api::TurnUnit::inch_girth},
    Option<api::TurnUnit>{"revolution", api::TurnUnit::revolution}};

}  // namespace tubecut
