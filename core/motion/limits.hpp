#pragma once

#include <array>
#include <stop_token>
#include <vector>

#include "core/motion/kinematics.hpp"
#include "core/motion/path.hpp"
#include "core/motion/profile.hpp"

namespace tubecut::motion {

/// The speed asked for along a path, by its parameter.
class SpeedAlong {
 public:
  /// Errors  bad_number, wrong_count, out_of_range (the table itself), speed_table_range (with phi
  /// and beam).
  static Result<SpeedAlong> of(const Motion& motion, const Program& program);

  /// Least and greatest speed between two parameters of the path, mm/s. Beam and table are
  /// piecewise linear, so the extremes lie at the ends, at a point of the program or at a pair of
  /// the table.
  [[nodiscard]] double least(double from, double to) const { return extreme(from, to, true); }
  [[nodiscard]] double greatest(double from, double to) const { return extreme(from, to, false); }
  /// Speed at point `i` of the program.
  [[nodiscard]] double at_point(std::size_t i) const;

 private:
  [[nodiscard]] double extreme(double from, double to, bool least) const;
  [[nodiscard]] double of_beam(double beam) const;
  double number_ = 0.0;
  std::vector<std::pair<double, double>> pairs_ = {};
  std::vector<double> lengths_ = {};
  std::vector<double> beam_ = {};
};

/// An axis' derivatives where intervals meet.
struct SignedDerivatives {
  std::vector<double> first = {};   // q' at the knots
  std::vector<double> second = {};  // q'' at the knots
  std::vector<double> third = {};   // q''' at the start of every interval
  bool linear = true;               // in the coordinates: q' is a quadratic on every interval
};

/// Bounds of an axis' derivatives over every interval: |q'|, |q''|, |q'''| per mm, mm2, mm3 of u.
struct AxisBounds {
  std::size_t axis = 0;  // of the machine
  std::vector<double> first = {};
  std::vector<double> second = {};
  std::vector<double> third = {};
  double v_max = 0.0;  // after the overflow cap
  double a_max = 0.0;
  double j_max = 0.0;  // 0: no jerk limit
  SignedDerivatives along = {};
};

/// All that timing needs to know of a path on a machine.
struct Limits {
  double d = 0.1;
  std::vector<AxisBounds> axes = {};  // moving axes only
  std::vector<double> slowness =
      {};  // per interval: tip path per mm of u over the speed asked, s/mm
  /// The same at an interval's start, as inner Bezier value and at its end.
  std::vector<std::array<double, 3>> slowness_along = {};

  [[nodiscard]] std::size_t intervals() const { return slowness.size(); }
};

/// Accuracy  exact for axes linear in the coordinates; else sampled at three points of each
/// interval with 0.1 % margin,
///           the last check covers the rest.
/// Source  docs/theory/pulse-schedules.md, sections 5.1 and 5.2.
[[nodiscard]] Limits limits(const Path& path, const std::vector<AxisFunction>& axes,
                            const std::vector<AxisFunction>& tip, const SpeedAlong& speed,
                            const Machine& machine, const std::stop_token& stop = {});

/// One condition alpha |u_ddot| + beta x <= c on an interval, x = u_dot^2.
struct Row {
  double alpha = 0.0;
  double beta = 0.0;
  double c = 0.0;
};

/// Rows of all intervals, one after another; those of interval i are first[i] .. first[i+1].
struct Rows {
  std::vector<Row> rows = {};
  std::vector<std::size_t> first = {0};

  void add(const Row& row) { rows.push_back(row); }
  void close_interval() { first.push_back(rows.size()); }
};

/// The largest x at the knots within `caps` under the rows, u_ddot constant on each interval of `d`
/// mm. It exists, is the fastest profile, and is found by one pass each way.
///
/// Cost    one multiply-add per row and pass.
/// Source  docs/theory/pulse-schedules.md, section 6.1 (with the proof).
[[nodiscard]] std::vector<double> largest_profile(std::vector<double> caps, double d,
                                                  const Rows& rows,
                                                  const std::stop_token& stop = {});

/// Caps at the knots and rows of acceleration, without jerk; zero at both ends.
struct Conditions {
  std::vector<double> caps = {};
  Rows rows = {};
};
[[nodiscard]] Conditions without_jerk(const Limits& limits, const std::stop_token& stop = {});

/// Caps of x at the knots by the speeds of axes and tip, on whole intervals; zero at both ends.
///
/// Accuracy  as `limits`.
[[nodiscard]] std::vector<double> speed_caps(const Limits& limits,
                                             const std::stop_token& stop = {});

/// |q' u_ddot + q'' x| <= a_max of every axis on whole intervals, signs kept. With u_ddot constant
/// it is a quadratic along the interval, so that its three Bezier values bound it.
///
/// Accuracy  exact for axes linear in the coordinates; else with 0.1 % margin.
/// Source    docs/theory/pulse-schedules.md, section 6.2.
[[nodiscard]] HalfPlanes acceleration_rows(const Limits& limits, const std::stop_token& stop = {});

/// Time over a profile: sum of 2 d / (sqrt i_ + sqrt x_(i+1)), s.
[[nodiscard]] double duration(const std::vector<double>& x, double d);

}  // namespace tubecut::motion
