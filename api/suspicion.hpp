#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/wire/json.hpp"
#include "core/base/error.hpp"

namespace tubecut::api {

/// Returns warnings for values of a request, with defaults applied, that may be in another unit: a
/// diameter that is a catalogue size in inches (25.4), a catalogue wall in inches on a diameter in
/// mm, a round angle in radians (57.3), a length or a member's ends in metres (1000), a metric
/// design wholly in inches (11.811, 0.63, 9.449). Each names the field and the probable meaning.
/// Offsets may be of any size and are not suspected.
[[nodiscard]] std::vector<Warning> unit_suspicions(const Json& request);

/// Returns the meaning of an out-of-range value in another unit, if that is within [min, max]: mm
/// in metres, inches or micrometres (the one that makes it a catalogue size, else each), deg in
/// radians, rad in degrees; empty otherwise.
[[nodiscard]] std::string other_unit_hint(double value, std::string_view unit, double min,
                                          double max);

}  // namespace tubecut::api
