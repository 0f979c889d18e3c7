#pragma once

#include <string_view>

#include "api/run.hpp"

namespace tubecut::api {

// Members of an answer, both of a job and of a line of a batch.

/// `job` and `request`; `echo` is the answer's request, perhaps with reference and log.
void write_head(Writer& w, std::string_view endpoint, std::string_view job_id, const Answer& answer,
                const Json& echo);
/// `verification`, `verdict` and `warnings`.
void write_judgement(Writer& w, const Answer& answer, const Json& echo);

/// Returns the default name of a job.
[[nodiscard]] std::string own_job_id(const Answer& answer);

}  // namespace tubecut::api
