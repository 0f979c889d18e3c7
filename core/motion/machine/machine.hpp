#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/names.hpp"

namespace tubecut::motion {

/// An axis counts in its own unit, which its record states; nothing else in core is in degrees.
enum class AxisUnit : std::uint8_t { deg, mm };

/// One driven axis. Limits per second in the axis' unit; exactly one of the two pulse counts is
/// set.
struct Axis {
  std::string name = {};
  AxisUnit unit = AxisUnit::mm;
  double pulses_per_unit = 0.0;
  std::int64_t pulses_per_turn =
      0;  // rotary axes: an integer, so that a closed cut returns exactly
  double v_max = 0.0;
  double a_max = 0.0;
  std::optional<double> j_max = {};        // empty: this axis has no jerk limit
  std::optional<std::int64_t> n_max = {};  // maximum pulses per period of the controller
  std::optional<double> soft_min = {};
  std::optional<double> soft_max = {};

  [[nodiscard]] double pulses_per_axis_unit() const {
    return pulses_per_turn > 0 ? static_cast<double>(pulses_per_turn) / 360.0 : pulses_per_unit;
  }
};

/// Source 000: rotating pipe C, carriage Y, height Z1, optional fine height Z2, swinging torch B.
struct FiveAxisCutter {
  static constexpr std::string_view kName = "five_axis_cutter";
  double pivot_length = 0.0;  // pivot to torch tip, mm
  double standoff = 0.0;      // tip to wall, mm
  double z2_share = 0.0;      // fraction of the height given to Z2; 0: left to the height control
};

/// A table that turns the tube (A) under a torch that moves across it (X), along it (Y) and up and
/// down (Z), and swings along it if there is an axis B. The wall's normal at the torch is kept up,
/// so the table cuts tubes that are not round as well.
///
/// Frame  (X, Y, Z) is right-handed, Y along the tube into the kept part, Z up, zero on the tube's
///        axis. A turns about +Y; A = 0 has phi = 0 (of a section the middle of face 1) up, so
///        A = -phi brings the place at phi up.
struct TubeTable {
  static constexpr std::string_view kName = "tube_table";
  double pivot_length = 0.0;  // pivot to torch tip, mm; Y and Z are the pivot's
  double standoff = 0.0;      // tip to wall, mm
};

enum class SwingCenter : std::uint8_t { remote, pivot };

/// Source 002: a carriage that crawls around the pipe (S), a cross slide (E) and the swing (B).
struct Crawler {
  static constexpr std::string_view kName = "crawler";
  double wheel_offset = 0.0;  // of the wheel path over the pipe, mm
  SwingCenter swing_center = SwingCenter::remote;
  double pivot_length = 0.0;  // pivot above the wall, mm; used with SwingCenter::pivot
  std::optional<double> standoff_max = {};  // maximum growth of the standoff, mm
};

/// Source 001: the mill's axes C, X, Z, B, given directly as columns.
struct ConeMill {
  static constexpr std::string_view kName = "cone_mill";
};

/// q = k_phi * phi_deg + k_z * z + k_b * B_deg + k_0, in the order of the machine's axes.
struct LinearMap {
  double k_phi = 0.0;
  double k_z = 0.0;
  double k_b = 0.0;
  double k_0 = 0.0;
};
struct Generic {
  static constexpr std::string_view kName = "generic";
  std::vector<LinearMap> maps = {};  // empty if the cut comes as plain axis columns
};

using Kinematics = std::variant<FiveAxisCutter, Crawler, ConeMill, Generic, TubeTable>;

/// The direction in which the machine counts B: towards the outer edge lying further into the kept
/// part, or towards the scrap.
enum class BPositive : std::uint8_t { outer_edge_into_part, outer_edge_to_waste };

struct Machine {
  std::string name = {};
  Kinematics kinematics = FiveAxisCutter{};
  double period = 0.004;  // control period, s
  BPositive b_positive = BPositive::outer_edge_into_part;
  std::vector<Axis> axes = {};

  /// Returns +1 if the torch's tip leads its pivot towards +z for B > 0 (source 000), else -1.
  [[nodiscard]] double sigma() const {
    return b_positive == BPositive::outer_edge_into_part ? -1.0 : 1.0;
  }
};

/// The axis that lifts the torch, and what it carries.
struct Lift {
  std::string_view axis;  // its name
  std::string_view fine;  // name of a second one; empty: the type has none
  double pivot_length = 0.0;
  double standoff = 0.0;
};
/// Returns it; empty if the machine's type has no axis for the height of the torch.
[[nodiscard]] std::optional<Lift> lift_of(const Machine& machine);
/// Sets the standoff of a machine that lifts its torch; others stay as they are.
void set_standoff(Machine& machine, double standoff);
/// Returns true if the machine moves its torch across the tube, as a tube that is not round needs.
[[nodiscard]] bool crosses(const Machine& machine);

/// Returns the name of its kind on the wire, `kName` of its kinematics.
[[nodiscard]] std::string_view type_name(const Machine& machine);

/// Checks the machine itself; `member` starts at "machine".
///
/// Errors  bad_number, zero_limit, wrong_count (axes 1..8, names missing or duplicate),
///         out_of_range.
[[nodiscard]] Result<void> check(const Machine& machine);

/// Returns the largest speed of an axis in its unit per second: its own limit or the overflow limit
/// n_max / (pulses * period).
[[nodiscard]] double velocity_limit(const Axis& axis, double period);

/// The source of one number of a built-in machine.
struct Provenance {
  std::string member;  // such as "axes/1/v_max"
  bool assumption = true;
  std::string source;
};
struct CatalogueEntry {
  Machine machine;
  std::vector<Provenance> values;  // one per number and choice of the record, in its order
};

/// Returns the built-in machines. The sources publish axes but no pulse counts, periods or limits,
/// so nearly every number is marked an assumption.
///
/// Source  docs/theory/pulse-schedules.md, sections 3 and 4.5.
[[nodiscard]] std::vector<CatalogueEntry> catalogue();

}  // namespace tubecut::motion

namespace tubecut {

template <>
inline constexpr auto kNames<motion::AxisUnit> = std::to_array<Option<motion::AxisUnit>>(
    {{"deg", motion::AxisUnit::deg}, {"mm", motion::AxisUnit::mm}});

}  // namespace tubecut
