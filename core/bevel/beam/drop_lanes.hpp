#pragma once

#include <cstddef>
#include <span>
#include <vector>

/// The search for the smallest drop of `torch_line`, eight axes in parallel (base/lanes.hpp).
namespace tubecut::bevel::drop {

inline constexpr double kSeries = 0.25;  // maximum sine for a series of eight terms

/// One circle of the finished surface, straight from row to row.
struct Circle {
  double rho;
  double reach;  // rad: the reach of the beam to the side
  double limit;  // mm: the same, from the axis
  int rounds;    // of the search for the maximum; 0: by bisection
  int halvings;  // of an angle within reach, until a series of eight terms is accurate
  std::vector<double> z, rate;  // at each row; derivative by the phase, from there to the next
};

/// The finished lines of one part of the wall, at rows and between them, by their phases.
struct Lines {
  double low, high;  // radii
  std::vector<double> phi, sine, cosine, foot, slope;
};

struct Finished {
  double half, inner;
  std::vector<double> phi, sine, cosine;  // of the rows
  // No other reaches further than the first. The last three are those of the cut's inner edge, its
  // outer one and the middle. If more may be required between them, those of `between` are computed
  // too.
  std::vector<Circle> circles, between;
  std::vector<double> swing;  // for each row: its addition to that, mm
  std::vector<Lines> bands;
};

/// Axes before they are lowered, each in the half plane of its phase: between 0 and 2 pi, mostly
/// ascending.
struct Axes {
  std::vector<std::size_t> row;             // the row after which it lies
  std::vector<double> phi, sine, cosine;    // of the axis
  std::vector<double> foot, slope, secant;  // on the inner wall; secant: 1 / cos B

  void resize(std::size_t n);
};

/// Computes the drop that each axis requires.
///
/// Accuracy  1e-5 of half the kerf, times the secant of the finished surface's slope.
/// Cost      per axis and circle some 10 ns for each interval in reach, 5 for each line.
void least(const Finished& finished, const Axes& axes, std::span<double> out);

}  // namespace tubecut::bevel::drop
