#pragma once

#include <cstddef>
#include <stop_token>
#include <vector>

namespace tubecut::motion {

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

/// One condition start x_i + end x_(i+1) <= 1 on an interval; x = u_dot^2 at its two knots.
/// Rest, x = 0, always holds it.
struct HalfPlane {
  double start = 0.0;
  double end = 0.0;
};

/// Conditions of all intervals, one after another; those of interval i are first[i] .. first[i+1].
struct HalfPlanes {
  std::vector<HalfPlane> rows = {};
  std::vector<std::size_t> first = {0};

  void add(double start, double end) { rows.push_back({start, end}); }
  void close_interval() { first.push_back(rows.size()); }
};

/// A profile at the knots and what bounds every profile.
struct Profile {
  std::vector<double> x = {};
  std::vector<double> bound = {};  // no profile within the rows is faster at any knot
};

/// From any x that the rows allow to the ends: a profile from which no knot can be raised, and a
/// bound on all profiles.
///
/// A row whose two factors are positive (an axis whose q' passes through zero) is replaced by two
/// caps in the proportion of `bound`. Every other row bounds one knot by an increasing function of
/// its neighbour, so profiles within them are closed under the larger of two, and the greedy walk,
/// at each knot the fastest from which the end can still be reached, finds the largest of them.
///
/// Accuracy  rows hold to 1e-11. Time over that of `bound` at most 1.01 in 200 random short cuts.
/// Cost      four passes; a multiply-add per row where a cap binds, about four where a row does.
/// Source    docs/theory/pulse-schedules.md, section 6.2.
[[nodiscard]] Profile fastest_profile(const std::vector<double>& caps, const HalfPlanes& rows,
                                      const std::stop_token& stop = {});

/// The profile alone, its caps for rows that hold both knots down in the proportion of `bound`.
[[nodiscard]] std::vector<double> fastest_within(const std::vector<double>& caps,
                                                 const std::vector<double>& bound,
                                                 const HalfPlanes& rows,
                                                 const std::stop_token& stop = {});

/// Time over a profile: sum of 2 d / (sqrt x_i + sqrt x_(i+1)), s.
[[nodiscard]] double duration(const std::vector<double>& x, double d);

}  // namespace tubecut::motion
