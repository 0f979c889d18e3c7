#pragma once

#include <Eigen/Geometry>

#include "core/groove/mill_path.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::groove {

// The machine as bodies in space: an independent path from axes to tool and workpiece, for
// verification only.

/// The tool as a body in machine space.
struct Tool {
  Eigen::Vector3d tip;   // centre of its face
  Eigen::Vector3d axis;  // unit, to the spindle
};

/// The machine as rotations and shifts of points in space.
class Machine {
 public:
  explicit Machine(const MillPathSpec& spec) : spec_(spec) {
    if (spec.setup.mount == Mount::end_up)
      lying_ << 0, 1, 0, 1, 0, 0, 0, 0, -1;
    else
      lying_ << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  }

  [[nodiscard]] Tool tool(const AxisPosition& at) const {
    const Eigen::Vector3d axis = math::turn_about_y(at.b.rad()) * Eigen::Vector3d::UnitZ();
    return {Eigen::Vector3d(at.x, 0.0, at.z) - spec_.setup.pivot_length * axis, axis};
  }
  [[nodiscard]] Eigen::Matrix3d table(Angle c) const {
    return math::turn_about_z((c - spec_.setup.c_zero).rad()) * lying_;
  }
  [[nodiscard]] Eigen::Vector3d lift() const { return {0.0, 0.0, spec_.setup.z_zero}; }
  /// Returns the axes without the optimisation's part.
  [[nodiscard]] AxisPosition before(const MillPosition& p) const {
    AxisPosition out = p.at;
    out.b = p.at.b - Angle::rad(p.by.db);
    out.z -= p.by.dz;
    if (spec_.optimise.hold == Hold::pivot) return out;
    const Eigen::Vector3d arm = spec_.setup.pivot_length * (tool(p.at).axis - tool(out).axis);
    out.x -= arm.x();
    out.z -= arm.z();
    return out;
  }

 private:
  const MillPathSpec& spec_;
  Eigen::Matrix3d lying_;
};

/// Computes the distance to the flank from the cone's apex and the angle there. For nearly
/// cylindrical mills, whose apex is far away, it uses the axis.
[[nodiscard]] double flank_distance(const Mill& mill, const Tool& tool, const Eigen::Vector3d& p);

/// Computes the signed distance to the cutter's whole meridian, both sides of the axis, as a
/// polygon.
[[nodiscard]] double solid_distance(const Mill& mill, const Tool& tool, const Eigen::Vector3d& p);

}  // namespace tubecut::groove
