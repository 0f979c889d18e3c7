#pragma once

#include <cstddef>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/error.hpp"

namespace tubecut::motion {

struct Program;

/// Speed of the cut: one number, or by the metal that the beam must cut.
struct SpeedTable {
  std::vector<std::pair<double, double>> pairs = {};  // beam mm, mm/s; beam ascending
};
using Speed = std::variant<double, SpeedTable>;  // mm/s

/// The requested speed along a path, by its parameter.
class SpeedAlong {
 public:
  /// Errors  bad_number, wrong_count, out_of_range (the table itself), speed_table_range (with phi
  ///         and beam).
  static Result<SpeedAlong> of(const Speed& speed, const Program& program);

  /// Return the smallest and largest speed between two parameters of the path, mm/s. Beam and table
  /// are piecewise linear, so the extremes lie at the ends, at a point of the program or at a pair
  /// of the table.
  [[nodiscard]] double least(double from, double to) const { return extreme(from, to, true); }
  [[nodiscard]] double greatest(double from, double to) const { return extreme(from, to, false); }
  /// Returns the speed at point `i` of the program.
  [[nodiscard]] double at_point(std::size_t i) const;

 private:
  [[nodiscard]] double extreme(double from, double to, bool least) const;
  [[nodiscard]] double of_beam(double beam) const;
  double number_ = 0.0;
  std::vector<std::pair<double, double>> pairs_ = {};
  std::vector<double> lengths_ = {};
  std::vector<double> beam_ = {};
};

}  // namespace tubecut::motion
