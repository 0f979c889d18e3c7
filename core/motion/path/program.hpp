#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/motion/schedule/spec.hpp"

namespace tubecut::motion {

/// Weight of B in the generalised length, mm per rad: of 5, 10, 20 and 50 the only one that is
/// never bad.
inline constexpr double kBevelWeight = 10.0;

/// One coordinate of the path. `weight` turns its unit into mm of generalised length.
struct Coordinate {
  /// Smoothed within eps_tip or eps_b; `turn` is smooth already, and no part of the length,
  /// because the tip moves wherever it changes.
  enum class Group : std::uint8_t { tip, bevel, turn };
  double weight = 1.0;
  Group group = Group::tip;
};

/// The polyline to be followed, coordinate by coordinate: phi, z, B of a contour; of a section the
/// angle of its normal, z, B and the tip's x and y across the tube; or axis columns.
struct Program {
  std::vector<Coordinate> coordinates = {};
  /// [coordinate][point], rad and mm (axis units for columns).
  std::vector<std::vector<double>> x = {};
  std::vector<bool> corner = {};  // a point where the direction jumps
  std::vector<double> beam = {};  // mm per point; empty when the speed is one number
  std::size_t cut_first = 0;      // points before it are the lead-in
  std::size_t cut_last = 0;       // points after it are the lead-out
  bool closed = false;            // ends where it starts: no lead, no overcut, no sector
  int turns = 0;                  // of phi over a closed contour
  /// The full width of one mean over the tip's coordinates, mm.
  double widest = 1.0;
  /// How far the curve through the points may leave the range of two neighbours in a coordinate of
  /// the tip, mm, if half of eps_tip is more.
  double overshoot = 1e300;

  [[nodiscard]] std::size_t size() const { return x.front().size(); }
  /// Returns the generalised distance of two neighbouring points, mm.
  [[nodiscard]] double step(std::size_t from, std::size_t to) const;
  /// Returns the generalised length up to each point, mm.
  [[nodiscard]] std::vector<double> lengths() const;
};

/// Checks the input, then applies start point, direction, sector, lead and overcut.
///
/// Errors  bad_number, wrong_count, angle_out_of_range (|B| > 85 deg), duplicate_point, turns_back,
///         not_closed, out_of_range (also a tip tolerance above a tenth of a closed path's length),
///         unsupported_combination, lead_blocked (a lead or pierce point
///         lies in the finished part).
/// Source  docs/theory/pulse-schedules.md, sections 2.1, 2.2 and 2.6.
[[nodiscard]] Result<Program> program(const ScheduleSpec& spec);

}  // namespace tubecut::motion
