#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"
#include "core/groove/section.hpp"
#include "core/groove/survey.hpp"

namespace tubecut::groove {

/// Truncated cone; its radius grows towards the spindle. Lengths in mm.
struct Mill {
  Angle half_angle;         // kappa, [0, 90) deg
  double tip_radius = 0.0;  // >= 0; not 0 together with kappa
  double length = 0.0;      // along the axis, > 0
};

/// The direction in which the pipe end to be cut looks along machine Z.
enum class Mount : std::uint8_t { end_up, end_down };

struct Range {
  double min = 0.0, max = 0.0;
};
/// Travel of the linear axes in mm and of the tilt axis.
struct Travel {
  std::optional<Range> x, z, b_deg;
};

struct Setup {
  Mount mount = Mount::end_up;
  double pivot_length =
      0.0;  // from the tip to the B axis, >= 0, mm; 0: X, Z are those of the tip's centre
  double z_zero = 0.0;   // added to Z, mm
  Angle c_zero;          // C at omega = 0
  int direction = 1;     // +1: tip at curve 3, spindle beyond curve 4; -1: reversed
  double overrun = 0.0;  // of the generatrix past curve 3, >= 0, mm
  Travel travel;
};

/// Tool in the half plane of a section: components radial and along the branch axis.
struct ToolPose {
  Eigen::Vector2d tip;   // centre of the tip's face, mm
  Eigen::Vector2d axis;  // unit, from tip to spindle
};

/// The four axes. C is the table's turn (mod 360 deg), B the tilt of the tool axis from machine Z
/// towards X.
struct AxisPosition {
  Angle c;
  double x = 0.0, z = 0.0;  // mm
  Angle b;
};

enum class Hold : std::uint8_t {
  tip,    // X and Z follow so that B tilts the tool about its tip's centre
  pivot,  // the source's two variables: X stays, B tilts about its own axis
};

/// The increments of an optimisation to the initial position: machine increments, mm and rad.
struct Increment {
  double dz = 0.0, db = 0.0;
};

/// Returns the pose with the whole generatrix on the ruling of the section. Source 6.2.
[[nodiscard]] ToolPose initial_pose(const JointGeometry& joint, const Section& section,
                                    const Mill& mill, const Setup& setup);

/// Returns the pose after an increment. Source 8.1.
[[nodiscard]] ToolPose moved(const ToolPose& pose, const Setup& setup, Hold hold, Increment by);

/// Converts the pose in the section at `omega` to axis positions, and back. The two are inverses
/// except for rounding. Source 6.3.
[[nodiscard]] AxisPosition axis_position(const ToolPose& pose, const Setup& setup, Angle omega);
[[nodiscard]] ToolPose tool_pose(const AxisPosition& axes, const Setup& setup);

/// A point relative to the tool: `distance` to the unbounded flank cone (> 0 not cut), its
/// gradient, and the position of its foot along the generatrix from the tip. Coordinates of the
/// tool's section half plane: (radial, tangential, axial).
struct FlankFoot {
  double distance = 0.0;
  Eigen::Vector3d gradient;
  double along = 0.0;
};

/// A mill with the precomputed sine and cosine of its angle.
struct Cone {
  double sin_k = 0.0, cos_k = 1.0;
  double tip_radius = 0.0, back_radius = 0.0;
  double length = 0.0, generatrix = 0.0;

  explicit Cone(const Mill& mill);

  /// Computes the distance to the unbounded flank. Source 6.4.
  [[nodiscard]] double flank(const ToolPose& pose, const Eigen::Vector3d& p) const {
    const Meridian m = meridian(pose, p);
    return flank(m.rho, m.l);
  }
  [[nodiscard]] double flank(double rho, double l) const {
    return (rho - tip_radius) * cos_k - l * sin_k;
  }
  /// Computes the signed distance to the finite cutter, negative inside.
  [[nodiscard]] double solid(const ToolPose& pose, const Eigen::Vector3d& p) const {
    const Meridian m = meridian(pose, p);
    return solid(m.rho, m.l);
  }
  [[nodiscard]] double solid(double rho, double l) const;
  [[nodiscard]] FlankFoot foot(const ToolPose& pose, const Eigen::Vector3d& p) const;

  /// The derivatives of a distance by rho and l; at a corner of the solid, one of the two.
  struct Rise {
    double by_rho = 0.0, by_l = 0.0;
  };
  [[nodiscard]] Rise flank_rise() const { return {cos_k, -sin_k}; }
  [[nodiscard]] Rise solid_rise(double rho, double l) const;

  /// A point in the tool's coordinates.
  struct Meridian {
    double rho = 0.0, l = 0.0;  // from the axis, along it from the tip
    double across = 0.0;        // signed in-plane part of rho
  };
  [[nodiscard]] static Meridian meridian(const ToolPose& pose, const Eigen::Vector3d& p) {
    const double ws = p.x() - pose.tip.x(), wz = p.z() - pose.tip.y();
    const double across = ws * pose.axis.y() - wz * pose.axis.x();
    return {std::sqrt(across * across + p.y() * p.y()), ws * pose.axis.x() + wz * pose.axis.y(),
            across};
  }
};

/// Checks that tool and setup are possible, and fit the groove.
///
/// Errors  not_finite, out_of_range, tool, setup, tool_short, root_collision; `member` from
///         "mill/..." and "setup/...".
[[nodiscard]] Result<void> check_tool(const JointGeometry& joint, const Survey& survey,
                                      const Mill& mill, const Setup& setup);

}  // namespace tubecut::groove
