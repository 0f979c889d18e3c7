#pragma once

#include <vector>

#include "core/bevel/hole/hole.hpp"
#include "core/joint/contour.hpp"

namespace tubecut::bevel {

/// Computes the curve in which the cylinder `rho` about the branch's axis meets a cylinder about
/// the chord's, over the branch's phase.
///
/// Errors  those of joint::trace, about the branch; open_profile if the two are tangent.
[[nodiscard]] Result<joint::Contour> joint_curve(const joint::TubeCutter& branch,
                                                 double chord_radius, double rho);

/// Computes the end of a set-on or set-in branch at these phases.
/// Errors  as joint_curve; torch_range if it cannot be cut flush on the chord.
[[nodiscard]] Result<BranchEnd> branch_end(const HoleSpec& spec, const joint::TubeCutter& branch,
                                           const std::vector<double>& phases);

/// Warns of a set-on branch whose bore is within the chord's sides, while its wall is not.
void note_overhang(const HoleSpec& spec, const joint::TubeCutter& branch,
                   std::vector<Warning>& out);

}  // namespace tubecut::bevel
