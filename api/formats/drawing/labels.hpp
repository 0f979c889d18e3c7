#pragma once

#include <vector>

namespace tubecut::api {

/// Returns positions for labels in a row with the desired positions `wanted`, in their order, with
/// at least `apart` between them and within [low, high]; closer if there is no room. Moves them as
/// little as possible: a group of labels that would overlap is spread about its middle.
[[nodiscard]] std::vector<double> spread(const std::vector<double>& wanted, double apart,
                                         double low, double high);

}  // namespace tubecut::api
