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
/// share one evaluation; of a section also the sine and cosine of the angle of the normal.
struct Jet {
  Coordinates value{};
  Coordinates first{};
  Coordinates second{};
  Coordinates third{};
  double sin_b = 0.0;
  double cos_b = 1.0;
  double sin_up = 0.0;
  double cos_up = 1.0;
};

/// Coordinates with sin B and cos B, and those of the angle of the normal, so that several axes
/// share one evaluation.
struct Pose {
  Coordinates x{};
  double sin_b = 0.0;
  double cos_b = 1.0;
  double sin_up = 0.0;
  double cos_up = 1.0;
};

/// q = constant + linear . x + sin_b sin B + cos_b cos B + tan_b tan B + across p . t + out p . n,
/// with B the coordinate of index 2, p = (x_3, x_4) the tip in the plane across the tube, and n, t
/// the normal and tangent at the angle x_0. Every machine here, and the trace of the beam on either
/// wall surface, has this form.
struct AxisFunction {
  double constant = 0.0;
  Coordinates linear{};
  double sin_b = 0.0;
  double cos_b = 0.0;
  double tan_b = 0.0;
  double across = 0.0;
  double out = 0.0;

  [[nodiscard]] bool turns() const { return across != 0.0 || out != 0.0; }
  [[nodiscard]] bool is_linear() const {
    return sin_b == 0.0 && cos_b == 0.0 && tan_b == 0.0 && !turns();
  }
  [[nodiscard]] double at(const Coordinates& x) const;
  [[nodiscard]] double at(const Pose& pose) const;
  /// Computes q', q'', q''' along the path by the chain rule.
  ///
  /// Source  docs/theory/pulse-schedules.md, section 3; docs/theory/sections.md, section 7.
  [[nodiscard]] std::array<double, 3> derivatives(const Jet& jet) const;
};

/// Returns the axes of a machine over the coordinates of a cut, in the machine's order.
///
/// Errors  unsupported_combination: a contour on a machine that requires columns, or the reverse; a
///         section on a machine without an axis across the tube, or with its speed on the bore; a
///         bevel on a table without an axis B.
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
