#pragma once

#include <vector>

namespace tubecut::api {

/// Places for labels in a row that want to stand at `wanted`, in their order, `apart` from each
/// other and within [low, high]; nearer to each other where there is no room. The least moved
/// first: a group of labels that would lie on each other is spread about its middle.
[[nodiscard]] std::vector<double> spread(const std::vector<double>& wanted, double apart,
                                         double low, double high);

}  // namespace tubecut::api
