#pragma once

#include <array>
#include <optional>

#include "core/cutoff/work_feed.hpp"
#include "core/math/chebyshev.hpp"

namespace tubecut::cutoff {

/// The four methods to fit the polynomial, each on [0, duration] of the work feed.
/// Source    docs/theory/feed-curves.md, section 4.

/// Computes the parabola through three times. If `nodes` is empty, they are 0, the time of the
/// highest speed (or duration/2), and duration.
/// Errors    bad_nodes: not finite, not ascending, or outside [0, duration].
[[nodiscard]] Result<math::ChebyshevSeries> three_point(
    const WorkFeed& work, const std::optional<std::array<double, 3>>& nodes);

/// Interpolates at degree + 1 equally spaced times.
[[nodiscard]] math::ChebyshevSeries equispaced(const WorkFeed& work, int degree);

/// Minimises the integral of the squared error: Legendre projection by 64-point Gauss.
[[nodiscard]] math::ChebyshevSeries least_squares(const WorkFeed& work, int degree);

/// Minimises the largest relative error.
/// Errors    not_converged, cancelled.
[[nodiscard]] Result<math::ChebyshevSeries> minimax(const WorkFeed& work, int degree);

}  // namespace tubecut::cutoff
