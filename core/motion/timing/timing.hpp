#pragma once

#include <cstdint>
#include <vector>

#include "core/motion/path/path_limits.hpp"
#include "core/motion/timing/window_maxima.hpp"

namespace tubecut::motion {

/// u(t) of a path: x = u_dot^2 at the knots, then a moving average of `filter` seconds over u(t).
struct Timing {
  std::vector<double> x = {};
  double filter = 0.0;  // s; 0: no jerk limit
  double time = 0.0;    // s, the filter included
};

/// The widest optimism of the jerk rows on every interval; 1 is proven.
using Optimism = std::vector<double>;

/// The start of a profile by signed rows.
struct SignedRows {
  HalfPlanes acceleration = {};
  Profile without_jerk = {};
  std::vector<double> share = {};  // fraction of a_max that each interval may use
};

/// Computes the fastest profiles whose rows still hold after a filter. Data of the path and buffers
/// are prepared once for all trials.
class FilteredProfiles {
 public:
  /// If cancelled, they are incomplete and must not be used.
  explicit FilteredProfiles(const PathLimits& limits);

  /// Computes the profile for a filter of `filter` seconds. With optimism 1 everywhere the filtered
  /// motion provably keeps every limit.
  ///
  /// Cost    at most `rounds` (1..4) times the maxima over windows and two passes.
  /// Source  docs/theory/pulse-schedules.md, section 6.4 (with the proof).
  [[nodiscard]] Timing by_magnitudes(const std::vector<double>& without_jerk, double filter,
                                     const Optimism& optimism, int rounds);

  /// Computes the same with |q' u_ddot + q'' x| <= share a_max in place of the sum of magnitudes,
  /// so that terms of opposite signs cancel. A mean over the filter's window violates these rows by
  /// as much as q' and q'' change within it: samples decide whether acceleration and jerk hold;
  /// speeds hold by proof.
  ///
  /// Cost    as `by_magnitudes`, times about 4.
  /// Source  docs/theory/pulse-schedules.md, section 6.3.
  [[nodiscard]] Timing by_signs(const SignedRows& rows, double filter, const Optimism& optimism,
                                int rounds);

 private:
  template <class Solve>
  Timing refined(const std::vector<double>& without_jerk, double filter, const Optimism& optimism,
                 int rounds, const Solve& solve);
  void find_window_maxima(const std::vector<double>& fastest, double filter);
  void bound_acceleration(double filter, bool by_axes);
  void tighten(const std::vector<double>& x);
  void bound_edges(double filter);
  [[nodiscard]] std::vector<double> capped(const std::vector<double>& fastest) const;
  [[nodiscard]] double reach(std::size_t i, double from, double most) const;
  [[nodiscard]] std::vector<double> passed(std::vector<double> x) const;
  [[nodiscard]] HalfPlanes signed_rows(const SignedRows& rows) const;

  const PathLimits& limits_;
  WindowMaxima maxima_;
  Windows windows_, beside_;
  // For the axes, pack by pack: limits and their inverses; a missing jerk limit, and the padding
  // after the last axis, is a limit that is never reached.
  std::vector<Pack> jerk_, acceleration_, per_speed_, per_acceleration_, per_jerk_;
  std::vector<double> root_;   // of the fastest x at the knots
  std::vector<double> bound_;  // of |u_ddot| on every interval
  std::vector<double> used_, wide_;
  std::vector<Row> extra_;  // in addition to the rows of every interval
  std::vector<std::uint32_t> extra_first_;
};

}  // namespace tubecut::motion
