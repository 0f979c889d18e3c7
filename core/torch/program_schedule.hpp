#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/schedule/pulse_counter.hpp"
#include "core/motion/schedule/schedule.hpp"
#include "core/torch/torch_program.hpp"

namespace tubecut::torch {

/// A whole program to be scheduled. From `motion` it takes speed, tolerances, jerk and expert;
/// `setup` determines start and lead, and its cuts run as given.
struct ProgramSpec {
  std::vector<TorchCut> cuts = {};
  Setup setup = {};
  motion::Machine machine = {};
  motion::Motion motion = {};
  std::int64_t max_periods = 4'000'000;
};

/// A segment of the schedule: the path to a cut, its pierce, the cut from lead-in to lead-out; or
/// the path to a mark's stroke and the stroke.
struct Segment {
  enum class Kind : std::uint8_t { rapid, pierce, cut, mark };
  Kind kind = Kind::rapid;
  std::size_t cut = 0;    // in the program; for the last rapid, the cut that it leaves
  std::int64_t from = 0;  // periods before it
  std::int64_t to = 0;    // and at its end
  /// Only for a cut: its slow zones count from the start of the whole.
  std::optional<motion::Report> report = {};
  motion::AxisSums sums = {};
};

struct ProgramSchedule {
  motion::Schedule whole = {};  // `report`: of all cuts together, its times of all segments
  std::vector<Segment> segments = {};
  std::vector<ProgramCut> cuts = {};

  /// Returns the total time of this kind, s.
  [[nodiscard]] double time_of(Segment::Kind kind) const;
};

/// Computes the whole program as one schedule. Every count is rounded from its one start, so that
/// no error accumulates from cut to cut; every leg runs from rest to rest, so that limits hold
/// across them.
///
/// A machine with a height axis moves between cuts as in `Setup`; without one it moves level, and
/// its control lifts the torch. Every cut's phi continues by the nearest whole revolution.
///
/// Errors    those of program_cut, motion::schedule, each hint naming the cut;
///           unsupported_combination (a torch that leans across).
/// Accuracy  counts within half a pulse of the ideal at every period of the whole.
/// Cost      that of each cut's schedule; rapids a few operations a period.
/// Source    docs/theory/pulse-schedules.md, section 11.
[[nodiscard]] Result<ProgramSchedule> schedule(const ProgramSpec& spec);

/// The segments of these cuts, in order, without the last rapid of machines that lift.
struct Expected {
  Segment::Kind kind = Segment::Kind::rapid;
  std::size_t cut = 0;
};
[[nodiscard]] std::vector<Expected> expected_segments(const std::vector<ProgramCut>& cuts);

/// Returns one cut of the program as a job of its own, with its points; `turns`: as `windings`.
[[nodiscard]] motion::ScheduleSpec cut_job(const ProgramSpec& spec, const ProgramCut& cut,
                                           double turns);

/// Returns all of its cuts, with their points.
///
/// Errors  as `schedule`.
[[nodiscard]] Result<std::vector<ProgramCut>> program_cuts(const ProgramSpec& spec);

}  // namespace tubecut::torch
