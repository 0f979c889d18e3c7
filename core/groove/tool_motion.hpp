#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "core/groove/swept.hpp"

namespace tubecut::groove {

/// A point of the workpiece on its ruling, in the branch frame.
struct WorkPoint {
  Direction dir = {};       // of its omega
  double s = 0.0, z = 0.0;  // mm
};

/// Selects the distance to the flank or to the whole cutter.
enum class Part : std::uint8_t { flank, solid };

/// The minimum of a distance over the motion and its position.
struct Least {
  double value = 0.0;    // mm
  double station = 0.0;  // block index, with its fraction
};

/// A lower bound of the minimum distance over the motion, and a distance that occurs.
struct LeastRange {
  double low = 0.0;
  Least met = {};
};

/// A tool on its path around a workpiece, relative to one ruling after another: every block within
/// a quarter turn of it, in arrays.
class ToolMotion {
 public:
  ToolMotion(const Cone& cone, const Setup& setup, std::span<const Block> blocks, Between between);

  /// Selects the ruling in direction `dir` at `omega` for the following points.
  void select_ruling(double omega, Direction dir);

  /// Computes the minimum distance over the blocks.
  [[nodiscard]] Least at_blocks(const WorkPoint& point, Part part);

  /// Computes the minimum distance over the motion: at the blocks, then by golden section in both
  /// segments next to the best of them, where the distance falls and rises once.
  ///
  /// Accuracy  1e-7 mm.
  [[nodiscard]] Least over_motion(const WorkPoint& point, Part part);

  /// Computes bounds of `over_motion` from a known `at_blocks`: one or two distances instead of the
  /// search.
  ///
  /// A distance to a cone or a cutter is convex, so a tangent bounds it from below along the
  /// straight line between two positions of the point in the tool's frame; the point's path
  /// deviates from that line by at most its largest acceleration times an eighth of the square of
  /// the step.
  ///
  /// Accuracy  without rounding, which is below 1e-8 mm.
  [[nodiscard]] LeastRange range(const WorkPoint& point, Part part, const Least& best) const;

  /// Computes the distance at one station.
  [[nodiscard]] double distance(const WorkPoint& point, Part part, double station) const;

 private:
  /// A point in the tool's frame, its distance and the derivative of that.
  struct ToolFramePoint {
    Eigen::Vector3d at = {};     // across the axis in the section's plane, out of it, along
    Eigen::Vector3d slope = {};  // a subgradient
    double distance = 0.0;
    Eigen::Vector3d from_tip = {};  // in the section's frame: radial, tangential, axial
    double ahead = 0.0;             // radial, from the branch axis
    Eigen::Vector2d axis = {};      // of the tool
  };
  /// From one block to the next.
  struct Step {
    double turn = 0.0, x = 0.0, z = 0.0, lean = 0.0;  // rad, mm, mm, rad
  };

  [[nodiscard]] ToolFramePoint in_tool_frame(const WorkPoint& point, Part part,
                                             double station) const;
  [[nodiscard]] Step step_from(double block) const;
  [[nodiscard]] Eigen::Vector3d velocity(const ToolFramePoint& at, const Step& step) const;
  [[nodiscard]] double acceleration(const WorkPoint& point, const ToolFramePoint& at_one_end,
                                    const Step& step) const;
  [[nodiscard]] double bend(const ToolFramePoint& from, const ToolFramePoint& to,
                            double acceleration) const;
  void search_between(const WorkPoint& point, Part part, const ToolFramePoint& here, double from,
                      double to, LeastRange& out) const;
  [[nodiscard]] Least by_golden_section(const WorkPoint& point, Part part, double low) const;
  [[nodiscard]] Least least_solid();

  const Cone& cone_;
  const Setup& setup_;
  std::span<const Block> blocks_;
  Between between_;
  // For every block, twice around, so that a window never wraps.
  Eigen::ArrayXd sin_, cos_, tip_s_, tip_z_, axis_s_, axis_z_;
  // For the blocks in the window: the ruling's direction from theirs, then one point's meridians.
  Eigen::ArrayXd ahead_, aside_, rho_, along_, distance_;
  Eigen::Index first_ = 0, count_ = 0;
};

}  // namespace tubecut::groove
