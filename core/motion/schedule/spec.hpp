#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "core/motion/machine/machine.hpp"
#include "core/motion/path/cut_path.hpp"
#include "core/motion/path/lead.hpp"
#include "core/motion/timing/speed.hpp"

namespace tubecut::motion {

/// Axis values given directly, one column per axis of the machine, in the axis' unit: a mill path
/// or plain axes.
struct AxisColumns {
  std::vector<double> length =
      {};                   // s, mm: the length that the speed refers to; empty: a mill path
  double tip_radius = 0.0;  // rho3 of a mill path: C turns the tip on this radius, mm
  std::vector<std::vector<double>> columns = {};  // in the order of the machine's axes
  std::vector<bool> corner = {};
  bool closed = false;
};

using Cut = std::variant<CutPath, AxisColumns>;

struct Expert {
  double optimism = 3.0;              // 1: only proven rows
  std::optional<double> filter = {};  // s; empty: the best of the ladder
  bool sag_warning = true;
};

/// The parameters of a cut's motion.
struct Motion {
  Speed speed = 10.0;
  Surface speed_on = Surface::outer;
  double eps_tip = 0.1;  // mm
  Angle eps_b = Angle::deg(0.5);
  /// The largest lean of the torch's plane from the normal at the corners of a section: the angle
  /// of the normal is blended over its seams as far as it permits.
  Angle lean = Angle::deg(1.0);
  bool jerk = true;
  bool compare = false;
  Start start = {};
  Direction direction = Direction::as_given;
  std::optional<Lead> lead = {};
  std::optional<Sector> sector = {};
  Expert expert = {};
};

struct ScheduleSpec {
  Cut cut = CutPath{};
  Machine machine = {};
  Motion motion = {};
  /// For a cut path: its points from pierce to torch off, if they are already known. They also
  /// determine start, direction and lead; `motion` then only states whether there is a lead.
  std::optional<CutWithLead> way = {};
  std::int64_t max_periods = 4'000'000;
};

}  // namespace tubecut::motion
