#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/motion/path/path_limits.hpp"

namespace tubecut::motion {

/// Columns are processed in packs of this size.
inline constexpr std::size_t kPack = 4;
using Pack = Eigen::Array<double, kPack, 1>;

/// Intervals low[i] .. high[i] for every interval i; neither bound ever decreases.
struct Windows {
  std::vector<std::uint32_t> low = {};
  std::vector<std::uint32_t> high = {};
};

/// Computes the largest value of `values` over each window.
///
/// Cost  each value is added and removed once.
void widen(const std::vector<double>& values, const Windows& w, std::vector<double>& out);

/// Maxima of every bound of a path over the windows of its intervals, and of two more columns that
/// change from trial to trial. A row contains all columns of an interval, so that one comparison of
/// rows is enough for all of them.
class WindowMaxima {
 public:
  /// If cancelled, it is incomplete and must not be used.
  explicit WindowMaxima(const PathLimits& limits);

  void set_optimism(std::size_t i, double optimism) { at(rows_, i)[optimism_] = -optimism; }
  void set_speed(std::size_t i, double speed) { at(rows_, i)[speed_] = speed; }

  /// Computes the maxima over the windows.
  ///
  /// Cost  three comparisons of rows an interval, for any windows.
  void widen(const Windows& w);

  /// Return |q'|, |q''| and |q'''| of axes `a` and the following, 0 after the last.
  [[nodiscard]] Pack first(std::size_t i, std::size_t a) const { return pack(i, a); }
  [[nodiscard]] Pack second(std::size_t i, std::size_t a) const { return pack(i, axes_ + a); }
  [[nodiscard]] Pack third(std::size_t i, std::size_t a) const { return pack(i, 2 * axes_ + a); }
  /// Returns the number of axes, including the padding of their last pack.
  [[nodiscard]] std::size_t axes() const { return axes_; }
  [[nodiscard]] double slowness(std::size_t i) const { return at(i)[slowness_]; }
  [[nodiscard]] double optimism(std::size_t i) const { return -at(i)[optimism_]; }  // the minimum
  [[nodiscard]] double speed(std::size_t i) const { return at(i)[speed_]; }         // of u

 private:
  [[nodiscard]] const double* at(std::size_t i) const { return &maxima_[i * width_]; }
  [[nodiscard]] double* at(std::vector<double>& of, std::size_t i) const { return &of[i * width_]; }
  [[nodiscard]] Pack pack(std::size_t i, std::size_t column) const {
    return Eigen::Map<const Pack>(at(i) + column);
  }
  void raise(const double* a, const double* b, double* to) const;

  std::size_t axes_, slowness_, optimism_, speed_, width_;
  std::vector<double> rows_, maxima_;
  std::vector<double> heads_;  // maximum of the rows from each one up to the pivot
};

}  // namespace tubecut::motion
