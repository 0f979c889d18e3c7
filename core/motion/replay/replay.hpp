#pragma once

// Rebuilds the torch from the pulses of a schedule and checks it against the contour.
//
// Idea: forward kinematics by formulas that the planner does not use. Every invariant (limits,
// sums, tip and bevel on the path) has a worst value and a limit, so any schedule can be checked.
//
// Example: a square cut around a tube of 100 mm.
//     motion::CutPath ring;
//     ring.outer_radius = 50;
//     ring.phi = {0, 2, 4};
//     ring.z = ring.b = {0, 0, 0};
//     motion::ScheduleSpec job;
//     job.cut = ring;
//     job.machine = motion::catalogue().front().machine;
//     const auto checks = motion::verify(job, motion::schedule(job).value());
//     const bool passed = std::ranges::all_of(checks, &Check::passed);

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/motion/replay/reconstruction.hpp"
#include "core/motion/schedule/schedule.hpp"

namespace tubecut::motion {

/// A schedule from outside: its counts may have any value.
struct ReplaySpec {
  ScheduleSpec job = {};  // the machine, contour and motion that it claims to follow
  double period = 0.0;    // s
  std::vector<std::vector<double>> counts =
      {};                          // per axis of the machine; empty: the axis is at rest
  std::vector<double> start = {};  // per axis, in its unit
};

/// The counts as integers, and the largest distance to an integer.
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
                                        std::vector<double> start);

/// The tool path of the counts, one more point than periods, and every invariant.
struct Replay {
  std::vector<double> phi = {};  // rad; contour cuts; of a section the angle of the torch's plane
  std::vector<double> z = {};    // mm
  std::vector<double> b = {};    // rad, as the machine counts it
  std::vector<double> x = {}, y = {};  // mm across the tube; only of a section
  std::vector<Check> invariants = {};
  double deviation = 0.0;  // largest distance of the tip to the contour, mm
};

/// Rebuilds the path of a contour's counts; empty for axis columns.
void rebuild(const ScheduleSpec& spec, const Counted& counted, Replay& out);

/// Rebuilds the torch from integer counts and compares it with the contour: invariants I1 to I16,
/// each with its worst value, the limit there and the unit. Invariants that do not apply (no
/// contour, no jerk limit) are omitted.
///
/// Errors  wrong_count, bad_number, and those of the job itself.
/// Cost    one pass over the periods; per period the contour points within about a millimetre.
/// Source  docs/theory/pulse-schedules.md, section 9.
[[nodiscard]] Result<Replay> replay(const ReplaySpec& spec);

/// Checks the same invariants on our own answer, and `lead_clears_part`. If an answer does not fit
/// its request, it fails the check `replayable`.
[[nodiscard]] std::vector<Check> verify(const ScheduleSpec& spec, const Schedule& schedule);

}  // namespace tubecut::motion
