#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "core/base/error.hpp"
#include "core/cutoff/work_feed.hpp"

namespace tubecut::cutoff {

enum class FitMethod { minimax, least_squares, three_point, equispaced, automatic };

/// The polynomial of time that replaces the exact cylinder speed in a controller.
struct FitSpec {
  FitMethod method = FitMethod::minimax;            // equispaced only in comparisons
  int degree = 2;                                   // 1..8; 2 for three_point; ignored by automatic
  double tolerance = 0.005;                         // largest relative speed error, automatic only
  std::optional<std::array<double, 3>> nodes = {};  // s, three_point: ascending in [0, duration]
  bool preserve_stroke = false;  // shift the constant so that the stroke at the end is exact
};

inline constexpr int kHighestDegree = 8;

struct Extent {
  double low = 0.0;
  double high = 0.0;
  [[nodiscard]] double largest() const { return std::max(-low, high); }
};

/// Deviation of a command from the exact motion over [0, duration].
struct CommandErrors {
  Extent speed;                      // p/v_j - 1
  Extent tool_speed;                 // p f'(y_p)/v - 1
  Extent tool_position;              // x_p - (x_s + v t), mm
  double max_relative_error = 0.0;   // largest |p/v_j - 1|
  double tool_ripple = 0.0;          // largest |p f'(y_p)/v - 1|
  double tool_position_error = 0.0;  // largest |x_p - x|, mm
  double end_drift = 0.0;            // x_p - x at the end, mm
  double cylinder_end_drift = 0.0;   // y_p - y at the end, mm
};

/// Coefficients in ascending order; speeds in mm/s.
struct Command {
  FitMethod method = FitMethod::minimax;  // the chosen method, never automatic
  int degree = 0;
  double duration = 0.0;               // s; the command is valid on [0, duration] only
  std::vector<double> chebyshev = {};  // coefficients of T_k(2 t/duration - 1), c_0 enters whole
  std::vector<double> scaled = {};     // coefficients of powers of 2 t/duration - 1
  std::vector<double> seconds = {};    // coefficients of powers of t in s
  std::vector<double> seconds_rounded =
      {};          // with the fewest digits that raise the speed error by at most 1 %
  int digits = 0;  // significant digits of `seconds_rounded`
  double rounded_max_relative_error = 0.0;
  CommandErrors errors = {};
};

/// The degrees in the comparison table, within 1..8.
struct ComparisonSpec {
  int first_degree = 2;
  int last_degree = 5;
};

/// Computes the polynomial command of a work feed.
///
/// Errors    out_of_range, unsupported_combination, bad_choice, bad_nodes, tolerance_not_met,
///           not_converged, cancelled; tan_pole if the command leaves the linkage's range.
/// Accuracy  the errors are those of the returned polynomial within 1e-4 relative or 1e-12 (worst
///           seen 5e-6).
/// Cost      some 10 passes over 1601 points.
/// Source    docs/theory/feed-curves.md, section 4.
[[nodiscard]] Result<Command> command(const WorkFeed& work, const FitSpec& spec);

/// Computes the four methods at each degree (three_point only at 2), rows by degree, then method.
/// If a command leaves the linkage's range, it has no row.
[[nodiscard]] Result<std::vector<Command>> comparison(const WorkFeed& work,
                                                      const ComparisonSpec& spec);

}  // namespace tubecut::cutoff
