#pragma once

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/motion/schedule/pulse_counter.hpp"
#include "core/motion/schedule/schedule.hpp"
#include "core/torch/torch_program.hpp"

namespace tubecut::torch {

/// A whole program to be scheduled. Of `motion`: speed, tolerances, jerk, expert; its start and
/// lead are `setup`'s, its cuts run as given.
struct ProgramSpec {
  std::vector<TorchCut> cuts = {};
  Setup setup = {};
  motion::Machine machine = {};
  motion::Motion motion = {};
  std::int64_t max_periods = 4'000'000;
};

/// A stretch of the schedule: the way to a cut, its pierce, the cut from lead-in to lead-out; or
/// the way to a mark's stroke and the stroke.
struct Segment {
  enum class Kind : std::uint8_t { rapid, pierce, cut, mark };
  Kind kind = Kind::rapid;
  std::size_t cut = 0;    // of the program; of the last rapid the one it leaves
  std::int64_t from = 0;  // periods done before it
  std::int64_t to = 0;    // and behind it
  /// Of a cut: its slow zones count from the start of the whole.
  std::optional<motion::Report> report = {};
  motion::AxisSums sums = {};
};

struct ProgramSchedule {
  motion::Schedule whole = {};  // `report`: of all cuts together, its times of all segments
  std::vector<Segment> segments = {};
  std::vector<ProgramCut> cuts = {};

  /// s
  [[nodiscard]] double time_of(Segment::Kind kind) const;
};

/// The whole program in one schedule: every count rounded from its one start, so that nothing
/// drifts from cut to cut; every leg from rest to rest, so that limits hold across them.
///
/// A machine with a height goes between cuts as `Setup` says; one without moves level, and its
/// control lifts the torch. Every cut's phi goes on by the nearest whole turn.
///
/// Errors    those of program_cut, motion::schedule, each hint naming the cut;
///           unsupported_combination (a torch that leans across).
/// Accuracy  counts within half a pulse of the ideal at every period of the whole.
/// Cost      that of each cut's schedule; rapids a few operations a period.
/// Source    docs/theory/pulse-schedules.md, section 11.
[[nodiscard]] Result<ProgramSchedule> schedule(const ProgramSpec& spec,
                                               const std::stop_token& stop = {});

/// What the segments of such cuts are, in order: the last rapid, of machines that lift, left out.
struct Expected {
  Segment::Kind kind = Segment::Kind::rapid;
  std::size_t cut = 0;
};
[[nodiscard]] std::vector<Expected> expected_segments(const std::vector<ProgramCut>& cuts);

/// One cut of the program as a job of its own, of the points it has; `turns`: as `windings`.
[[nodiscard]] motion::ScheduleSpec cut_job(const ProgramSpec& spec, const ProgramCut& cut,
                                           double turns);

/// All of its cuts, with their points.
///
/// Errors  as `schedule`.
[[nodiscard]] Result<std::vector<ProgramCut>> program_cuts(const ProgramSpec& spec,
                                                           const std::stop_token& stop);

}  // namespace tubecut::torch
