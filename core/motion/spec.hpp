#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/angle.hpp"
#include "core/motion/machine.hpp"

namespace tubecut::motion {

enum class Surface : std::uint8_t { outer, inner };
/// The side of the cut that falls away; the kept part is on the other.
enum class Scrap : std::uint8_t { minus_z, plus_z, inside };

/// The line the torch axis follows on one wall surface. Columns of one length, rad and mm.
/// Frame: z along the tube into the kept part, phi from x towards y, unwrapped.
/// `b` is the beam's angle to the radial direction in the axial plane *as the machine counts it*
/// (positive towards sigma * z): see `as_machine_counts`.
struct Contour {
  std::vector<double> phi = {};
  std::vector<double> z = {};
  std::vector<double> b = {};
  std::vector<bool> corner = {};  // empty, or one per point
  std::vector<double> beam = {};  // metal along the beam, mm; empty: wall / cos b
  double outer_radius = 0.0;
  double wall = 0.0;  // 0: the surface is all there is
  Surface surface = Surface::outer;
  bool closed = true;
  Scrap scrap = Scrap::minus_z;

  [[nodiscard]] double radius() const {
    return surface == Surface::outer ? outer_radius : outer_radius - wall;
  }
  [[nodiscard]] double inner_radius() const { return outer_radius - wall; }
};

/// The contour with `b` in the project's sign (B > 0: outer edge further into the part) turned into
/// the machine's.
[[nodiscard]] Contour as_machine_counts(Contour contour, BPositive b_positive);

/// Axis values given directly, one column per axis of the machine, in the axis' unit: a mill path
/// or plain axes.
struct AxisColumns {
  std::vector<double> length =
      {};                   // s, mm: what the speed is measured along; empty for a mill path
  double tip_radius = 0.0;  // rho3 of a mill path: C turns the tip on this radius, mm
  std::vector<std::vector<double>> columns = {};  // in the order of the machine's axes
  std::vector<bool> corner = {};
  bool closed = false;
};

/// Speed of the cut: one number, or by the metal the beam must cut.
struct SpeedTable {
  std::vector<std::pair<double, double>> pairs = {};  // beam mm, mm/s; beam ascending
};
using Speed = std::variant<double, SpeedTable>;  // mm/s

struct Start {
  enum class At : std::uint8_t { first_point, phi, automatic };
  At at = At::first_point;
  Angle phi = {};
};

enum class Direction : std::uint8_t { as_given, ccw, cw };

struct Lead {
  double radius = 5.0;
  Angle sweep = Angle::deg(60);
  double overcut = 5.0;                // mm of the contour cut again; closed contours only
  std::optional<Angle> pierce_b = {};  // largest |B| at the pierce; empty: the cut's own B
  double fan = 10.0;                   // mm over which B goes from the pierce's to the cut's
};

/// A stretch of a closed cut, to be cut again after a lost arc.
struct Sector {
  Angle from = {};
  Angle to = {};
  double back_up = 5.0;  // mm before `from`
};

struct Expert {
  double optimism = 3.0;              // 1: proven rows only
  std::optional<double> filter = {};  // s; empty: the best of the ladder
  bool sag_warning = true;
};

struct Motion {
  Speed speed = 10.0;
  Surface speed_on = Surface::outer;
  double eps_tip = 0.1;  // mm
  Angle eps_b = Angle::deg(0.5);
  bool jerk = true;
  bool compare = false;
  Start start = {};
  Direction direction = Direction::as_given;
  std::optional<Lead> lead = {};
  std::optional<Sector> sector = {};
  Expert expert = {};
};

using Cut = std::variant<Contour, AxisColumns>;

struct ScheduleSpec {
  Cut cut = Contour{};
  Machine machine = {};
  Motion motion = {};
  std::int64_t max_periods = 4'000'000;
};

}  // namespace tubecut::motion
