#pragma once

#include <array>
#include <vector>

#include "core/motion/path/program.hpp"
#include "core/motion/schedule/spec.hpp"

namespace tubecut::motion {

/// The coordinates of one place of the path, or one of their derivatives along it.
inline constexpr std::size_t kMostCoordinates = 9;
using Coordinates = std::array<double, kMostCoordinates>;

/// A place of the path with three derivatives along it, and sin B and cos B, so that several axes
/// share one evaluation.
struct Jet {
  Coordinates value{};
  Coordinates first{};
  Coordinates second{};
  Coordinates third{};
  double sin_b = 0.0;
  double cos_b = 1.0;
};

/// Coordinates with sin B and cos B, so that several axes share one evaluation.
struct Pose {
  Coordinates x{};
  double sin_b = 0.0;
  double cos_b = 1.0;
};

/// q = constant + linear . x + sin_b sin B + cos_b cos B + tan_b tan B, with B the coordinate of
/// index 2. Every machine here, and the trace of the beam on either wall surface, has this form.
struct AxisFunction {
  double constant = 0.0;
  Coordinates linear{};
  double sin_b = 0.0;
  double cos_b = 0.0;
  double tan_b = 0.0;

  [[nodiscard]] bool is_linear() const { return sin_b == 0.0 && cos_b == 0.0 && tan_b == 0.0; }
  [[nodiscard]] double at(const Coordinates& x) const;
  [[nodiscard]] double at(const Pose& pose) const;
  /// Computes q', q'', q''' along the path by the chain rule.
  ///
  /// Source  docs/theory/pulse-schedules.md, section 3.
  [[nodiscard]] std::array<double, 3> derivatives(const Jet& jet) const;
};

/// Returns the axes of a machine over the coordinates of a cut, in the machine's order.
///
/// Errors  unsupported_combination (a contour on a machine that requires columns, or the reverse).
[[nodiscard]] Result<std::vector<AxisFunction>> axis_functions(const ScheduleSpec& spec);

/// Returns the functions whose joint rate is the speed of the cut: the beam's trace on the
/// requested surface, the mill's tip, or the given length.
[[nodiscard]] std::vector<AxisFunction> speed_functions(const ScheduleSpec& spec);

/// Computes the largest growth of the standoff of a crawler that swings about its pivot, mm; 0 for
/// every other machine.
///
/// Errors  standoff_too_large.
[[nodiscard]] Result<double> standoff_growth(const ScheduleSpec& spec, const Program& program);

}  // namespace tubecut::motion
