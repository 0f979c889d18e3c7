#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/motion/machine/kinematics.hpp"
#include "core/motion/path/program.hpp"

namespace tubecut::motion {

/// Counts from outside, one span per axis of the machine; empty when the axis is at rest.
struct Counted {
  double period = 0.0;
  std::size_t periods = 0;
  std::vector<std::span<const std::int32_t>> counts = {};
  std::vector<double> start = {};
  /// For a part of a longer schedule: pulses of every axis from `start` to the part. Empty: 0.
  std::vector<std::int64_t> before = {};

  [[nodiscard]] std::int64_t pulses_before(std::size_t axis) const {
    return before.empty() ? 0 : before[axis];
  }
};

/// The axis values of counts, period by period.
class AxisValues {
 public:
  AxisValues(const Counted& counted, const Machine& machine);
  [[nodiscard]] const std::vector<double>& now() const { return q_; }
  void step(std::size_t period);

 private:
  const Counted& counted_;
  std::vector<double> q_;
  std::vector<double> pulses_ = {};  // per unit of each axis
  std::vector<std::int64_t> sum_ = {};
};

/// Forward kinematics: computes the path's coordinates from axis values, by formulas independent of
/// those that made them.
///
/// Source  docs/theory/pulse-schedules.md, section 3.4.
class Reconstruction {
 public:
  explicit Reconstruction(const ScheduleSpec& spec);

  /// Computes the coordinates that the axes determine; the others stay 0.
  [[nodiscard]] Coordinates at(const std::vector<double>& axes) const;
  [[nodiscard]] bool knows(std::size_t coordinate) const { return known_[coordinate]; }
  /// Returns the height of the pivot less the height required by the torch's angle, mm; of a table
  /// the distance of the tip's place from the outside. Only for machines with a height axis.
  [[nodiscard]] std::optional<double> standoff_error(const std::vector<double>& axes) const;

  /// Returns the maximum change of each coordinate by half a pulse on every axis, with |B| up to
  /// `largest_b`.
  [[nodiscard]] Coordinates quantum(double largest_b) const;
  [[nodiscard]] double standoff_quantum() const;

 private:
  struct Roles {
    std::size_t phi = 0, z = 0, b = 0, height = 0, fine = 0, across = 0;
    bool has_fine = false, has_b = true;
  };
  void set_tube(const CutPath& cut_path);
  void set_generic(const Generic& generic);
  void set_table(const TubeTable& table);
  [[nodiscard]] Coordinates at_table(const std::vector<double>& axes) const;
  [[nodiscard]] Coordinates table_quantum(double slope) const;
  [[nodiscard]] double half_pulse(std::size_t axis) const;  // in the axis' unit

  enum class Kind : std::uint8_t { five_axis, crawler, generic, columns, table };
  Kind kind_ = Kind::columns;
  std::vector<Axis> axes_;
  Roles roles_ = {};
  double sigma_ = 1.0;
  double pivot_ = 0.0;  // L: pivot to the wall along the beam
  double past_ = 0.0;   // e: radially from the contour's surface to the outer one
  double outer_ = 0.0;
  double wheel_ = 0.0;                            // radius of a crawler's wheel path
  std::optional<section::Section> section_ = {};  // of a tube that is not round
  std::vector<Coordinates> inverse_ =
      {};  // generic: change of the coordinates per unit of each axis
  Coordinates origin_{};
  std::array<bool, kMostCoordinates> known_{};
};

/// A point for the follower: tip coordinates in mm.
using TipPoint = Coordinates;

/// Follows reconstructed points along the polyline of a program: computes the distance of each, the
/// points of the polyline that were never reached, and the contour's B at each point. It searches
/// only near the last place, so that the order of the cut counts.
class Follower {
 public:
  /// `part`: coordinates that take part. `allowed`: mm of tip path searched on both sides in any
  /// case; `moved`: the most that a motion of the tip adds to it. If cancelled, it is empty.
  Follower(const Program& program, const std::vector<bool>& part, double allowed, double moved);

  struct Found {
    double distance = 0.0;  // mm
    double at = 0.0;        // mm of tip path along the polyline
    std::size_t segment = 0;
  };
  /// Finds the nearest place of the polyline to the next reconstructed point.
  Found follow(const TipPoint& tip);

  /// Returns the smallest and largest value of coordinate `c` of the contour within `reach` mm of
  /// tip path around `at`.
  [[nodiscard]] std::pair<double, double> range(std::size_t c, double at, double reach) const;
  /// Returns the largest distance of a polyline point to the followed path, mm.
  [[nodiscard]] double farthest_missed() const;
  [[nodiscard]] double tip_length(std::size_t point) const { return at_[point]; }
  /// Converts program coordinates to tip coordinates, mm.
  [[nodiscard]] TipPoint tip_of(const Coordinates& x) const;

 private:
  void reach_points(const TipPoint& from, const TipPoint& to, double at);
  [[nodiscard]] Found nearest_on(std::size_t segment, const TipPoint& tip) const;

  const Program& program_;
  std::vector<std::size_t> tip_coordinates_ = {};
  std::vector<TipPoint> points_ = {};
  std::vector<double> at_ = {};      // tip length up to each point
  std::vector<double> missed_ = {};  // distance of each point to the path so far
  double allowed_, window_;
  std::size_t low_ = 0;   // first segment within the window
  std::size_t near_ = 0;  // first point within the window
  double last_at_ = 0.0;
  bool started_ = false;
  TipPoint last_ = {};
};

}  // namespace tubecut::motion
