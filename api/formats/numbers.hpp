#pragma once

#include <string>
#include <string_view>

namespace tubecut::api {

// The common number format of files for people (drawings, work orders, texts of a DXF), the same as
// in the console (web/src/units.ts): lengths to 0.01 mm, angles to 0.1 deg, times to a significant
// digit, at most six significant digits, no -0. If a nonzero value would read as 0, it is "<
// 0.001", or has one digit. Machine files and tables have their own.

enum class Unit { none, mm, mm2, deg, percent, s, ms, um, kg, mm_min, mm_s };

/// Returns the unit of a field, by the end of its name; `none` for units other than mm, deg and s.
[[nodiscard]] Unit unit_named(std::string_view field);

/// Returns the sign next to a number and in the label of an axis.
[[nodiscard]] std::string_view sign_of(Unit unit);

/// Returns the number without its unit, for a column or an axis that has it.
[[nodiscard]] std::string number(double value, Unit unit = Unit::none);

/// With its unit: "12.5 mm", "30°".
[[nodiscard]] std::string measure(double value, Unit unit);

[[nodiscard]] inline std::string mm(double value) { return measure(value, Unit::mm); }

/// Of an angle in radians.
[[nodiscard]] std::string degrees(double radians);

/// Returns "30 deg" for "30°", for ASCII formats.
[[nodiscard]] std::string degrees_spelled(std::string text);

}  // namespace tubecut::api
