#pragma once

#include <cstddef>
#include <span>
#include <stop_token>
#include <vector>

/// The search for the least drop of `torch_line`, eight axes side by side (base/lanes.hpp).
namespace tubecut::bevel::drop {

inline constexpr double kSeries = 0.25;  // sine of an angle that a series of eight terms has

/// One circle of the finished surface, straight from row to row.
struct Circle {
  double rho;
  double reach;                 // rad: how far to the side the beam reaches
  double limit;                 // mm: the same, from the axis
  int rounds;                   // of the search for the place at which most is needed; 0: by halves
  int halvings;                 // of an angle within reach, until a series of eight terms has it
  std::vector<double> z, rate;  // at each row; by the phase, from there to the next
};

/// The finished lines of one part of the wall, at rows and between them, by their phases.
struct Lines {
  double low, high;  // radii
  std::vector<double> phi, sine, cosine, foot, slope;
};

struct Finished {
  double half, inner;
  std::vector<double> phi, sine, cosine;  // of the rows
  // No other reaches further than the first. The last three are of the cut's inner edge, its outer
  // one and half way; where more may be needed between them those of `between` are looked at.
  std::vector<Circle> circles, between;
  std::vector<double> swing;  // by row: what it adds to that, mm
  std::vector<Lines> bands;
};

/// Axes before they are lowered, each in the half plane of its phase: between 0 and 2 pi, mostly
/// ascending.
struct Axes {
  std::vector<std::size_t> row;             // on whose way to the next each stands
  std::vector<double> phi, sine, cosine;    // of it
  std::vector<double> foot, slope, secant;  // on the inner wall; secant: 1 / cos B

  void resize(std::size_t n);
};

/// What each axis needs.
///
/// Accuracy  1e-5 of half the kerf, times the secant of the finished surface's slope.
/// Cost      per axis and circle some 10 ns for each stretch in reach, 5 for each line.
void least(const Finished& finished, const Axes& axes, std::span<double> out,
           const std::stop_token& stop);

}  // namespace tubecut::bevel::drop
