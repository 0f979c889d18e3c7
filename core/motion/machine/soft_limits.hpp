#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "core/motion/machine/kinematics.hpp"
#include "core/motion/machine/machine.hpp"
#include "core/motion/path/path.hpp"

namespace tubecut::motion {

/// Checks the travel of every axis at every knot of the path against its soft limits, including the
/// swing axis. `has_phi`: the path's first coordinate is an angle around the tube, which errors
/// state.
///
/// Errors  soft_limit of machine/axes/i/soft_min or soft_max: the farthest place outside each, in
///         the axis' unit.
[[nodiscard]] Result<void> check_soft_limits(const Path& path,
                                             const std::vector<AxisFunction>& axes,
                                             const Machine& machine, bool has_phi);

}  // namespace tubecut::motion
