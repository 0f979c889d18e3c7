#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/bevel/hole/hole.hpp"

namespace tubecut::bevel {

/// The branch relative to the chord: its axis, and the two directions across it from which its
/// phase is measured. `x` is opposite to the common perpendicular, so that the chord's clocking
/// there is 0.
struct BranchFrame {
  Eigen::Vector3d foot, x, y, axis;
  Eigen::Vector3d side, across;  // of the chord: unit, to the branch's side; a quarter turn further
  double side_phi = 0.0;         // [0, 2 pi)
};
[[nodiscard]] BranchFrame branch_frame(const joint::TubeCutter& branch);
/// Returns the same axis from the chord's other side.
[[nodiscard]] joint::TubeCutter reversed(const joint::TubeCutter& branch);

/// The line along which one point of the hole's wall is cut.
struct WallLine {
  Eigen::Vector3d root, outer, inner;  // finished wall
  Eigen::Vector3d torch_outer, torch_inner;
  double dihedral = 0.0, groove = 0.0, b = 0.0, a = 0.0;
  double lost = 0.0;  // groove requested but not cut; set-on: difference to the branch's direction
  bool beyond_torch = false;  // the torch cannot keep the wall off the branch here
  double needs = 0.0;         // rad: the lean that could; if no lean can, a right angle
  bool misses_bore = false;   // the line does not reach the other surface
};

/// Computes wall lines for one side of the chord.
class WallLines {
 public:
  WallLines(const HoleSpec& spec, const joint::TubeCutter& branch, double radius,
            const joint::PreparedCutter& chord);

  [[nodiscard]] WallLine at(double phase) const { return at(phase, 0.5 * spec_.kerf); }
  /// `off` is the distance of the torch's axis to the wall, mm.
  [[nodiscard]] WallLine at(double phase, double off) const;
  [[nodiscard]] const BranchFrame& frame() const { return frame_; }
  /// Returns the phase on the chord, continuous around the branch's side.
  [[nodiscard]] double phi(const Eigen::Vector3d& point) const;

 private:
  struct Corner;  // the two surfaces at the root
  struct Direction {
    Eigen::Vector3d unit;
    double b = 0.0;
    double held_back = 0.0;  // set-on: the angle between the torch and the branch's direction, rad
    bool beyond = false;
    double needs = 0.0;  // if beyond, as in WallLine
  };
  [[nodiscard]] double asked_groove(double dihedral) const;
  [[nodiscard]] std::optional<double> height_over(const Eigen::Vector3d& point, double side) const;
  [[nodiscard]] Corner moved_clear(const Corner& corner, const Eigen::Vector3d& radial,
                                   Eigen::Vector3d& root) const;
  [[nodiscard]] WallLine square_line(const Eigen::Vector3d& root, const Corner& met,
                                     double off) const;
  [[nodiscard]] Direction along_branch(const Corner& corner) const;
  [[nodiscard]] Direction free_direction(const Corner& corner) const;
  [[nodiscard]] Direction axial_direction(const Corner& corner,
                                          const Eigen::Vector3d& radial) const;

  const HoleSpec& spec_;
  BranchFrame frame_;
  double radius_;  // of the hole about the branch's axis
  joint::PreparedCutter chord_;
  bool root_outside_;
};

}  // namespace tubecut::bevel
