#pragma once

#include <string_view>

#include "api/run.hpp"

namespace tubecut::api {

// Members of an answer, of a job of its own and of one within another alike.

/// `job` and `request`; `echo` is the answer's request, perhaps with reference and log.
void write_head(Writer& w, std::string_view endpoint, std::string_view job_id, const Answer& answer,
                const Json& echo);
/// `verification`, `verdict` and `warnings`.
void write_judgement(Writer& w, const Answer& answer, const Json& echo);

/// What a job is called where nobody gives it a name.
[[nodiscard]] std::string own_job_id(const Answer& answer);

}  // namespace tubecut::api
