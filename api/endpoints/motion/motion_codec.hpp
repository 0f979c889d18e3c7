#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "api/endpoints/bevel_table_codec.hpp"
#include "api/endpoints/part_request.hpp"
#include "api/endpoints/section_bevel_table.hpp"
#include "api/wire/reader.hpp"
#include "core/groove/mill_path.hpp"
#include "core/motion/schedule/spec.hpp"
#include "core/torch/program_schedule.hpp"

namespace tubecut::api {

/// Source of a schedule's cut: computed here (a bevel table, a mill path, all cuts of a part), or
/// given.
using CutSource = std::variant<BevelTableRequest, groove::MillPathSpec, motion::CutPath,
                               motion::AxisColumns, PartRequest, SectionCutRequest>;

struct ScheduleRequest {
  CutSource cut;
  motion::Machine machine;
  motion::Motion motion;
  torch::Setup setup;  // of a part
  bool marks = false;  // its strokes before its cuts
  std::int64_t max_periods = 0;
};

/// The job with its computed cut, and the checks and warnings of that cut.
struct ScheduleJob {
  motion::ScheduleSpec spec;
  std::optional<torch::ProgramSpec> program;  // of a part, whose cuts are not in `spec`
  std::vector<Check> checks;
  std::vector<Warning> warnings;
};

/// The fields `cut`, `contour`, `mill_path`, `axes` or `part`, `machine` and `motion`. `axes` and a
/// mill path take their columns in the order of the machine's axes.
[[nodiscard]] ScheduleRequest decode_schedule_request(Reader& in);

/// A part with its members found.
///
/// Errors  those of the part, with members under `part`; unsupported_combination (a hole whose
///         torch tilts across).
[[nodiscard]] Result<ScheduleRequest> resolve(ScheduleRequest request);

/// Of a resolved request.
///
/// Errors  those of the nested request, their members under `cut`, `mill_path` or `part`;
///         unsupported_combination.
[[nodiscard]] Result<ScheduleJob> compute_schedule_job(const ScheduleRequest& request);

}  // namespace tubecut::api
