#pragma once

#include <optional>
#include <stop_token>

#include "core/motion/path.hpp"
#include "core/motion/spec.hpp"

namespace tubecut::motion {

/// Largest distance of the edges that a planned path cuts to those of its contour, whose points'
/// edges are joined straight in (phi, z) on each wall: smoothing and sag together, mm.
struct EdgeDeviation {
  double outer = 0.0;
  double inner = 0.0;
};

/// Of the cut between lead-in and lead-out; nothing of axis columns, which have no wall, and of a
/// cancelled call.
///
/// Accuracy  taken at the path's knots and three places between, 0.025 mm of generalised length
/// apart. Cost      linear in the knots.
[[nodiscard]] std::optional<EdgeDeviation> edge_deviation(const ScheduleSpec& spec,
                                                          const Program& program, const Path& path,
                                                          const std::stop_token& stop);

}  // namespace tubecut::motion
