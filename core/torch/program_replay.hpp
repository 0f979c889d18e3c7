#pragma once

#include <stop_token>
#include <vector>

#include "core/motion/replay/replay.hpp"
#include "core/torch/program_schedule.hpp"

namespace tubecut::torch {

/// A program's schedule as it came back from outside.
struct ProgramReplaySpec {
  ProgramSpec job = {};
  double period = 0.0;                           // s
  std::vector<std::vector<double>> counts = {};  // per axis of the machine; empty: the axis stands
  std::vector<double> start = {};                // per axis, in its unit
  std::vector<Segment> segments = {};  // kind, from and to: their cuts follow from their order
  std::vector<motion::Event> events = {};
};

/// The whole rebuilt from its counts: of every cut the invariants that hold it to its contour, the
/// worst of them all; of all periods, borders of segments with them, those of limits; and of what
/// is between the cuts
///
///   segments_join     borders at which the list is not that of the program, or has gaps
///   torch_lit         periods lit in a rapid or a mark, or dark in a cut; the marking tool
///   likewise pierce_place      mm from where the pierce of the program is, its height with it
///   pierce_delay      s that a pierce stands still for less than asked
///   tab_width         mm by which a tab is narrower than asked, by the counts
///   rapid_clearance   mm by which the tip is lower than asked while anything else moves
///
/// Errors  wrong_count, bad_number, and those of the job itself.
/// Source  docs/theory/pulse-schedules.md, sections 9 and 11.
[[nodiscard]] Result<motion::Replay> replay(const ProgramReplaySpec& spec,
                                            const std::stop_token& stop = {});

/// The same on an own answer. One that does not even fit its request fails the check `replayable`.
[[nodiscard]] std::vector<Check> verify(const ProgramSpec& spec, const ProgramSchedule& schedule,
                                        const std::stop_token& stop = {});

}  // namespace tubecut::torch
