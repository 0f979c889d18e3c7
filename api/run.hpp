#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/verdict.hpp"
#include "api/wire/format.hpp"
#include "api/wire/problem.hpp"
#include "api/wire/writer.hpp"
#include "core/base/error.hpp"
#include "core/base/parallel_for.hpp"

namespace tubecut::api {

/// A request with defaults applied and its answer; or the problem.
struct Answer {
  Json request = {};                                  // echo without reference and log
  std::string result = {};                            // as JSON or CBOR, if `text` is empty
  std::string input_sha256 = {}, result_sha256 = {};  // of these two as JSON
  std::vector<Check> checks = {};
  std::vector<Warning> warnings = {};
  std::vector<Measure> measures = {};
  Verdict verdict = {};
  std::string text = {};                     // in another format, if one is requested
  std::string lines = {};                    // the remaining requests, as lines of a batch
  std::function<void(Writer&)> beside = {};  // members next to `result`, not covered by its hash
};
using Reply = std::variant<Answer, Problem>;

/// The context of the pipeline.
struct Run {
  Encoding encoding = Encoding::json;
  const FormatName* format = nullptr;  // instead, unless nullptr
  Caption caption = {};
  std::vector<Measure> accepted = {};                     // the request's `accept`
  std::function<void(std::string_view)> stage = {};       // called when a stage ends
  std::function<void(std::string_view)> understood = {};  // called with the input's sha256
  std::function<void(const Answer&)> judged = {};         // called when the verdict is known
  std::function<void()> forget_body = [] {};              // called when all of it is read
  ParallelFor parallel_for = run_in_order;                // runs independent tasks
};

}  // namespace tubecut::api
