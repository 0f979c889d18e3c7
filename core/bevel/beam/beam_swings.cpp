#include "core/bevel/beam/beam_swings.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/bevel/beam/beam_surface.hpp"

namespace tubecut::bevel::beam {
namespace {

constexpr double kApart = 0.1;    // rad: minimum difference of two leans
constexpr double kTiny = 1e-300;  // mm: steps may have zero length

/// Marks the rows near which these leans differ within half a kerf.
void mark_swings(const std::vector<double>& leans, const std::vector<double>& steps, double reach,
                 std::vector<bool>& near) {
  const auto n = leans.size();
  for (std::size_t i = 0; i < n && !stopped(); ++i) {
    double low = leans[i], high = low, left = reach;  // distance ahead
    std::size_t k = i;
    for (; k < i + n && left > 0.0; ++k) {
      const double there =
          mixed(leans[k % n], leans[(k + 1) % n], std::min(1.0, left / (steps[k % n] + kTiny)));
      low = std::min(low, there);
      high = std::max(high, there);
      left -= steps[k % n];
    }
    if (high - low < kApart) continue;
    for (std::size_t m = i + n - 1; m < k + n; ++m) near[m % n] = true;
  }
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> swings(const BeamCut& cut) {
  const auto n = cut.torch.size();
  const bool hole = cut.turn == 0.0;
  const double wall = cut.outer - cut.inner;
  std::vector<double> along_tube, round_tube, steps;
  for (std::size_t i = 0; i < n; ++i) {
    const auto &a = cut.torch[i], &b = cut.torch[(i + 1) % n];
    const double turn = i + 1 == n ? cut.turn : 0.0;
    along_tube.push_back(a.z_outer - a.z_inner);
    round_tube.push_back(cut.outer * (a.phi_outer - a.phi_inner));
    const double round = cut.inner * (b.phi_inner + turn - a.phi_inner);
    steps.push_back(hole ? elementary::hypot(round, b.z_inner - a.z_inner) : std::abs(round));
  }
  const std::vector<double> walls(n, wall);
  elementary::atan2(along_tube, walls, along_tube);
  if (hole) elementary::atan2(round_tube, walls, round_tube);
  std::vector<bool> near(n, false);
  mark_swings(along_tube, steps, 0.5 * cut.kerf, near);
  if (hole) mark_swings(round_tube, steps, 0.5 * cut.kerf, near);
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (std::size_t i = 0; i < n; ++i) {
    if (!near[i]) continue;
    if (out.empty() || out.back().second != i) out.emplace_back(i, i);
    out.back().second = i + 1;
  }
  return out;
}

}  // namespace tubecut::bevel::beam
