#pragma once

#include <optional>
#include <vector>

#include "core/motion/kinematics.hpp"

namespace tubecut::motion {

/// Forward kinematics: the path's coordinates from axis values, by other formulas than those that
/// made them.
///
/// Source  docs/theory/pulse-schedules.md, section 3.4.
class Reconstruction {
 public:
  explicit Reconstruction(const ScheduleSpec& spec);

  /// Coordinates that the axes determine; the others stay 0.
  [[nodiscard]] Coordinates at(const std::vector<double>& axes) const;
  [[nodiscard]] bool knows(std::size_t coordinate) const { return known_[coordinate]; }
  /// Height of pivot less the height the torch's angle asks for, mm; machines with a height axis.
  [[nodiscard]] std::optional<double> standoff_error(const std::vector<double>& axes) const;

  /// What half a pulse on every axis moves each coordinate by, at most, with |B| up to `largest_b`.
  [[nodiscard]] Coordinates quantum(double largest_b) const;
  [[nodiscard]] double standoff_quantum() const;

 private:
  struct Roles {
    std::size_t phi = 0, z = 0, b = 0, height = 0, fine = 0;
    bool has_fine = false;
  };
  void set_tube(const Contour& contour);
  void set_generic(const Generic& generic);
  [[nodiscard]] double half_pulse(std::size_t axis) const;  // in the axis' unit

  enum class Kind : std::uint8_t { five_axis, crawler, generic, columns };
  Kind kind_ = Kind::columns;
  std::vector<Axis> axes_;
  Roles roles_ = {};
  double sigma_ = 1.0;
  double pivot_ = 0.0;  // L: pivot to the wall along the beam
  double past_ = 0.0;   // e: radially from the contour's surface to the outer one
  double outer_ = 0.0;
  double wheel_ = 0.0;                     // radius of a crawler's wheel path
  std::vector<Coordinates> inverse_ = {};  // generic: what a unit of each axis moves
  Coordinates origin_{};
  std::array<bool, kMostCoordinates> known_{};
};

}  // namespace tubecut::motion
