#pragma once

#include <vector>

#include "api/catalog/tube_sizes.hpp"

namespace tubecut::api {

/// Adds the circular hollow sections of EN 10210-2 and EN 10219-2 and the pipes of EN 10255; a size
/// of several standards once, by the first.
void add_hollow_sizes(std::vector<TubeSize>& sizes);

}  // namespace tubecut::api
