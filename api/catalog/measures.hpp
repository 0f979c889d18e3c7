#pragma once

#include <string_view>
#include <vector>

namespace tubecut::api {

/// Returns the numbers of a size's name before its standard: {60, 40, 3} of "RHS 60x40x3 EN 10219".
[[nodiscard]] std::vector<double> measures_in(std::string_view name);

/// Returns true if two measures are meant to be the same: 60 and 60.3.
[[nodiscard]] bool same_measure(double a, double b);

}  // namespace tubecut::api
