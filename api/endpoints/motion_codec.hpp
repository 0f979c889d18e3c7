#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <variant>
#include <vector>

#include "api/endpoints/bevel_table_codec.hpp"
#include "api/reader.hpp"
#include "core/groove/mill_path.hpp"
#include "core/motion/spec.hpp"

namespace tubecut::api {

/// Where a schedule's cut comes from: computed here (a bevel table, a mill path), or given.
using CutSource =
    std::variant<BevelTableRequest, groove::MillPathSpec, motion::CutPath, motion::AxisColumns>;

struct ScheduleRequest {
  CutSource cut;
  motion::Machine machine;
  motion::Motion motion;
  std::int64_t max_periods = 0;
};

/// The job with its cut computed; checks and warnings of that cut beside it.
struct ScheduleJob {
  motion::ScheduleSpec spec;
  std::vector<Check> checks;
  std::vector<Warning> warnings;
};

/// The fields `cut`, `contour`, `mill_path` or `axes`, `machine` and `motion`. `axes` and a mill
/// path take their columns in the order of the machine's axes.
[[nodiscard]] ScheduleRequest decode_schedule_request(Reader& in);

/// Errors  those of the nested request, their members under `cut` or `mill_path`;
///         unsupported_combination.
[[nodiscard]] Result<ScheduleJob> compute_schedule_job(const ScheduleRequest& request,
                                                       const std::stop_token& stop);

}  // namespace tubecut::api
