#pragma once

#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "core/motion/replay/reconstruction.hpp"
#include "core/motion/schedule/schedule.hpp"

namespace tubecut::motion {

/// A schedule as it came back from outside: counts may be anything.
struct ReplaySpec {
  ScheduleSpec job = {};                         // machine, contour and motion it claims to follow
  double period = 0.0;                           // s
  std::vector<std::vector<double>> counts = {};  // per axis of the machine; empty: the axis stands
  std::vector<double> start = {};                // per axis, in its unit
};

/// The counts as integers, and how far the worst was from one.
struct Received {
  double period = 0.0;
  std::size_t periods = 0;
  std::vector<std::vector<std::int32_t>> counts = {};
  std::vector<double> start = {};
  double worst = 0.0;

  [[nodiscard]] Counted counted() const;
};

/// Errors  wrong_count, bad_number, cancelled.
[[nodiscard]] Result<Received> received(const Machine& machine, double period,
                                        const std::vector<std::vector<double>>& counts,
                                        std::vector<double> start, const std::stop_token& stop);

/// The tool path that counts make, one more point than periods, and every invariant.
struct Replay {
  std::vector<double> phi = {};  // rad; contour cuts
  std::vector<double> z = {};    // mm
  std::vector<double> b = {};    // rad, as the machine counts it
  std::vector<Check> invariants = {};
  double deviation = 0.0;  // largest distance of the tip to the contour, mm
};

/// The path of a contour's counts; none of axis columns.
void rebuild(const ScheduleSpec& spec, const Counted& counted, Replay& out,
             const std::stop_token& stop);

/// Rebuilds the torch from integer counts and holds it against the contour: invariants I1 to I16,
/// each with its worst value, the limit there and the unit. Those that do not apply (no contour, no
/// jerk limit) are left out.
///
/// Errors  wrong_count, bad_number, and those of the job itself.
/// Cost    one pass over the periods; per period the contour points within about a millimetre.
/// Source  docs/theory/pulse-schedules.md, section 9.
[[nodiscard]] Result<Replay> replay(const ReplaySpec& spec, const std::stop_token& stop = {});

/// The same invariants on an own answer, and `lead_clears_part`. An answer that does not even fit
/// its request fails the check `replayable`.
[[nodiscard]] std::vector<Check> verify(const ScheduleSpec& spec, const Schedule& schedule,
                                        const std::stop_token& stop = {});

}  // namespace tubecut::motion
