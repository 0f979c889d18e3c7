#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "api/endpoints/motion/motion_codec.hpp"
#include "api/wire/writer.hpp"
#include "core/torch/program_schedule.hpp"

namespace tubecut::api {

/// Figures of an axis' counts for a report.
struct AxisSums {
  std::string name = {};
  std::int64_t peak = 0;
  std::int64_t closure = 0;
};
[[nodiscard]] std::vector<AxisSums> sums_of(const motion::Schedule& schedule);

/// The member `report`.
void encode_report(const motion::Report& report, const std::vector<AxisSums>& sums, Writer& w);

/// The members `segments` and `times` of a whole part's schedule.
void encode_segments(const ScheduleJob& job, const torch::ProgramSchedule& schedule, Writer& w);

}  // namespace tubecut::api
