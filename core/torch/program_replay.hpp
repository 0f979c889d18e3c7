#pragma once

#include <vector>

#include "core/motion/replay/replay.hpp"
#include "core/torch/program_schedule.hpp"

namespace tubecut::torch {

/// A program's schedule from outside.
struct ProgramReplaySpec {
  ProgramSpec job = {};
  double period = 0.0;  // s
  std::vector<std::vector<double>> counts =
      {};                              // per axis of the machine; empty: the axis is at rest
  std::vector<double> start = {};      // per axis, in its unit
  std::vector<Segment> segments = {};  // kind, from and to: their cuts follow from their order
  std::vector<motion::Event> events = {};
};

/// Rebuilds the whole program from its counts. It checks the invariants of every cut against its
/// contour (the worst of all cuts), the limits over all periods including borders of segments, and
/// the motion between the cuts:
///
///   segments_join     borders at which the list differs from the program, or has gaps
///   torch_lit         periods lit in a rapid or a mark, or dark in a cut; also the marking tool
///   pierce_place      mm from the pierce of the program, including its height
///   pierce_delay      s by which a pierce is shorter than requested
///   tab_width         mm by which a tab is narrower than requested, from the counts
///   rapid_clearance   mm by which the tip is too low while anything else moves
///
/// Errors  wrong_count, bad_number, and those of the job itself.
/// Source  docs/theory/pulse-schedules.md, sections 9 and 11.
[[nodiscard]] Result<motion::Replay> replay(const ProgramReplaySpec& spec);

/// Checks the same on our own answer. If it does not fit its request, it fails the check
/// `replayable`.
[[nodiscard]] std::vector<Check> verify(const ProgramSpec& spec, const ProgramSchedule& schedule);

}  // namespace tubecut::torch
