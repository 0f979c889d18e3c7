#pragma once

#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "api/wire/json.hpp"
#include "core/base/error.hpp"

namespace tubecut::api {

/// Values of a request, as understood, that look as if they were given in another unit: a diameter
/// that is a catalogue size in inches (25.4), a catalogue wall in inches on a diameter in mm, a
/// round angle in radians (57.3), a length or a member's ends in metres (1000), a metric design
/// wholly in inches (11.811, 0.63, 9.449). Each is a warning that names the field and what was
/// meant. Offsets may be of any size and are not suspected.
[[nodiscard]] std::vector<Warning> unit_suspicions(const Json& request,
                                                   const std::stop_token& stop = {});

/// What an out-of-range value would be were it given in another unit, when that is within
/// [min, max]: mm in metres, inches or micrometres (the one that makes it a size that is sold, else
/// each), deg in radians, rad in degrees; empty otherwise.
[[nodiscard]] std::string other_unit_hint(double value, std::string_view unit, double min,
                                          double max);

}  // namespace tubecut::api
