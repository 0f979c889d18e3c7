#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <random>
#include <span>
#include <tl/expected.hpp>
#include <vector>

#include "core/groove/overcut.hpp"

namespace tubecut::groove {

enum class Method : std::uint8_t { chebyshev, annealing, none };

enum class Bias : std::uint8_t {
  centred,     // over- and undercut equal
  no_overcut,  // the deepest contact at zero
};

/// The best linear step for a set of gaps, and the bound that no step is better.
struct LinearMinimax {
  Eigen::Vector2d step = Eigen::Vector2d::Zero();  // (dz, db)
  double level = 0.0;                              // eps: minimum of max |g + J p| over all steps p
  std::array<int, 3> reference = {};               // the three binding gaps
};

/// Computes min over p of max_i |g_i + J_i p| exactly: the triple of largest dual value.
///
/// Cost    n^3 / 6 triples of a few ns.
/// Source  docs/theory/grooves-and-milling.md, 8.3 step 2.
[[nodiscard]] LinearMinimax linear_minimax(std::span<const double> gaps,
                                           std::span<const Eigen::Vector2d> slopes);

/// One position to be optimised.
struct Task {
  const Neighbourhood& near;
  const Cone& cone;
  const Setup& setup;
  ToolPose start;
  Hold hold = Hold::tip;
};

struct Optimum {
  Increment by;
  Gap gap;                            // continuous, at the optimum
  double certificate = 0.0;           // max|g - bias| less the minimum over all linear steps, mm
  double bias = 0.0;                  // the common target offset, mm; 0 for centred
  std::array<int, 3> reference = {};  // of the certificate
  int evaluations = 0;                // of the objective
};

/// Computes d gap / d (Z, B) of each contact: the envelope theorem at the touched point. Source
/// 8.2.
[[nodiscard]] std::vector<Eigen::Vector2d> gap_slopes(const Task& task, const ToolPose& pose,
                                                      const Gap& gap);

/// Computes the certificate of a position as it is: 0 if nothing better is near.
[[nodiscard]] Optimum certified(const Task& task, Increment by, double bias, int evaluations,
                                Gap gap);

/// Runs the sequential linear minimax from the initial position.
///
/// Errors    of `gap`; z_ineffective (no contact moves by sin 5 deg per unit of Z); not_converged
///           (cap 50 steps); cancelled.
/// Accuracy  certificate <= 1e-9 mm; worst of 2000 random positions 3.2e-13.
/// Cost      2-7 evaluations in 2000 random positions, 4.7 on average; with `no_overcut` about 12.
/// Source    docs/theory/grooves-and-milling.md, 8.3. If a step does not help, the source halves it
///           at once; here it is accepted once on trust (9 and 11 evaluations became 7).
[[nodiscard]] tl::expected<Optimum, ErrorCode> chebyshev(const Task& task, Bias bias, Gap initial);

/// Runs the published method: simulated annealing of the grid objective (16), 80 levels of 30
/// moves, T from F(0) by 0.93. The source gives no schedule and no moves; those are ours. Only for
/// comparison.
///
/// Errors  of `gap` at the result; cancelled.
/// Cost    2401 grid evaluations, about 15 ms.
/// Source  docs/theory/grooves-and-milling.md, 8.5.
[[nodiscard]] tl::expected<Optimum, ErrorCode> annealing(const Task& task, std::mt19937_64& random);

}  // namespace tubecut::groove
