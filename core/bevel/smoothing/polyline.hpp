#pragma once

#include <cstddef>
#include <utility>
#include <vector>

/// Polylines.
namespace tubecut::bevel {

using Points = std::vector<std::pair<double, double>>;

/// Appends the indices at which the line must bend to follow the points within the tolerance.
void bends(const Points& p, std::size_t from, std::size_t to, double tolerance,
           std::vector<std::size_t>& out);

/// Raises the ends of a straight segment until it is at least `value` at u: the lower end first.
void raise(double& a, double& b, double u, double value);

}  // namespace tubecut::bevel
