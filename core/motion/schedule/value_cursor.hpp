#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/motion/path/path.hpp"
#include "core/motion/path/path_positions.hpp"

namespace tubecut::motion {

/// Computes functions of a path's coordinates at a sequence of positions. Within an interval the
/// coordinates are cubics, so the linear part of every function is one too, and the sine and cosine
/// of B, and of the angle of a section's normal, are rotated from those at its start.
///
/// Accuracy  at the start of an interval and at the path's end bit-equal to `AxisFunction::at`,
///           else within 4e-16 of the sum of the magnitudes of its terms.
/// Cost      three multiply-adds a function, and a sine and cosine an interval.
class ValueCursor {
 public:
  ValueCursor(const Path& path, std::span<const AxisFunction> functions);

  /// Returns the values in the functions' order; they are valid until the next call.
  const std::vector<double>& at(const PathPosition& position);

 private:
  using Cubic = std::array<double, 4>;  // by rising powers of the offset
  struct Bend {
    std::size_t function;
    double sin_b, cos_b, tan_b;
  };
  struct Turn {
    std::size_t function;
    double across, out;
  };
  void enter(std::size_t interval);
  void add_turns(double offset);

  const Path& path_;
  std::vector<AxisFunction> functions_;
  std::vector<Bend> bends_ = {};
  std::vector<Turn> turns_ = {};
  std::size_t interval_ = static_cast<std::size_t>(-1);
  std::vector<Cubic> linear_;
  std::vector<double> values_;
  Cubic b_{}, up_{}, x_{}, y_{};
  elementary::SinCos at_start_{}, up_at_start_{};
};

}  // namespace tubecut::motion
