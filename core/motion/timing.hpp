#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "core/motion/path_limits.hpp"

namespace tubecut::motion {

/// u(t) of a path: x = u_dot^2 at the knots, then a moving average of `filter` seconds over u(t).
struct Timing {
  std::vector<double> x = {};
  double filter = 0.0;  // s; 0: no jerk limit
  double time = 0.0;    // s, the filter included
};

/// A place of the path: `offset` mm behind knot `interval`.
struct Place {
  std::uint32_t interval = 0;
  double offset = 0.0;

  [[nodiscard]] double u(double d) const { return d * interval + offset; }
};

/// Periods of `period` seconds that a time of `time` seconds takes.
[[nodiscard]] double periods_of(double time, double period);

/// u at the ends of `periods` equal periods, 0 first and the path's end last, never decreasing.
///
/// Accuracy  times, integrals and their differences in long double, summed over the window alone.
/// Source    docs/theory/pulse-schedules.md, section 6.3.
[[nodiscard]] std::vector<Place> sampled(const Timing& timing, double d, std::int64_t periods,
                                         const std::stop_token& stop = {});

/// The widest optimism of the jerk rows on every interval; 1 is proven.
using Optimism = std::vector<double>;

/// Fastest profile whose rows still hold after a filter of `filter` seconds. With optimism 1
/// everywhere the filtered motion keeps every limit by proof.
///
/// Cost    `rounds` (1..4) times 16 sliding maxima and two passes.
/// Source  docs/theory/pulse-schedules.md, section 6.4 (with the proof).
[[nodiscard]] Timing filtered_profile(const PathLimits& limits,
                                      const std::vector<double>& without_jerk, double filter,
                                      const Optimism& optimism, int rounds,
                                      const std::stop_token& stop = {});

/// What the profile by signed rows starts from.
struct SignedRows {
  HalfPlanes acceleration = {};
  Profile without_jerk = {};
  std::vector<double> share = {};  // of a_max that each interval may use
};

/// The same with |q' u_ddot + q'' x| <= share a_max in place of the sum of magnitudes, so that
/// terms of opposite signs cancel. A mean over the filter's window leaves these rows by as much as
/// q' and q'' change within it: acceleration and jerk hold where the samples say so, speeds by
/// proof.
///
/// Cost    as `filtered_profile`, times about 4.
/// Source  docs/theory/pulse-schedules.md, section 6.3.
[[nodiscard]] Timing filtered_signed_profile(const PathLimits& limits, const SignedRows& rows,
                                             double filter, const Optimism& optimism, int rounds,
                                             const std::stop_token& stop = {});

}  // namespace tubecut::motion
