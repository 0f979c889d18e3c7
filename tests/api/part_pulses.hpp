#pragma once

#include <utility>

#include "tests/support/call.hpp"

namespace tubecut::testing {

/// Requests the pulse schedule of a part on the machine of an example.
inline Posted pulses_of(api::Json part) {
  return post("/v1/pulse-schedules",
              with(example("pulse-schedules/two-ends-and-four-holes-of-a-part.json"), "part",
                   std::move(part)));
}

}  // namespace tubecut::testing
