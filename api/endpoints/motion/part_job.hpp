#pragma once

#include <string>

#include "api/endpoints/motion/motion_codec.hpp"

namespace tubecut::api {

/// Warns of a cut with a land, because a schedule has one pass of every cut: of an end with a land
/// the bevel's.
void warn_of_land(std::string member, const std::string& of, double land, ScheduleJob& job);

/// Adds the cuts of a resolved part to the job, round or not, with the checks and warnings of the
/// part.
///
/// Errors  those of the part, with members under `part`.
[[nodiscard]] Result<void> add_part(const ScheduleRequest& request, const PartRequest& part,
                                    ScheduleJob& job);

}  // namespace tubecut::api
