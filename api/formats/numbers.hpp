#pragma once

#include <string>
#include <string_view>

namespace tubecut::api {

// The one way in which files for people (drawings, work orders, texts of a DXF) write numbers, as
// the console does (web/src/units.ts): lengths to 0.01 mm, angles to 0.1 deg, times to a digit that
// means something, at most six significant digits, no -0. What is no 0 and would read as one is
// "< 0.001", or has one digit. Machine files and tables keep theirs.

enum class Unit { none, mm, mm2, deg, percent, s, ms, um, kg, mm_min, mm_s };

/// Of a field, by the end of its name; of units but mm, deg and s none.
[[nodiscard]] Unit unit_named(std::string_view field);

/// As it stands beside a number and in the label of an axis.
[[nodiscard]] std::string_view sign_of(Unit unit);

/// Without its unit, where a column or an axis has it.
[[nodiscard]] std::string number(double value, Unit unit = Unit::none);

/// With its unit: "12.5 mm", "30°".
[[nodiscard]] std::string measure(double value, Unit unit);

[[nodiscard]] inline std::string mm(double value) { return measure(value, Unit::mm); }

/// Of an angle in radians.
[[nodiscard]] std::string degrees(double radians);

/// "30 deg" for "30°", where a format is ASCII.
[[nodiscard]] std::string degrees_spelled(std::string text);

}  // namespace tubecut::api
