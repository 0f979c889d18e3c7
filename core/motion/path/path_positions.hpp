#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/motion/timing/timing.hpp"

namespace tubecut::motion {

/// A position on the path: `offset` mm after knot `interval`.
struct PathPosition {
  std::uint32_t interval = 0;
  double offset = 0.0;

  [[nodiscard]] double u(double d) const { return d * interval + offset; }
};

/// Returns the number of periods of `period` seconds in `time` seconds.
[[nodiscard]] double periods_of(double time, double period);

/// Returns the error of a schedule with more periods than `most`.
[[nodiscard]] tl::unexpected<Error> too_many_periods(double periods, std::int64_t most);

/// Computes u at the ends of `periods` equal periods, 0 first and the path's end last, never
/// decreasing.
///
/// Accuracy  times in units of 4e-19 of the whole; sums, over the window only, within 4e-16 of the
///           distance that the window spans.
/// Cost      one pass over knots and periods, for any filter.
/// Source    docs/theory/pulse-schedules.md, section 6.3.
[[nodiscard]] std::vector<PathPosition> sampled(const Timing& timing, double d,
                                                std::int64_t periods);

}  // namespace tubecut::motion
