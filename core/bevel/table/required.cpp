#include "core/bevel/table/required.hpp"

#include <algorithm>
#include <limits>

#include "core/base/elementary.hpp"

namespace tubecut::bevel {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

}  // namespace

double required_bevel(std::span<const joint::PreparedCutter> cutters, const Wall& wall,
                      const joint::Generator& inner_line, double z_root) {
  double slope = -kUnbounded;
  for (const auto& cutter : cutters)
    slope = std::max(slope, joint::steepest(cutter, wall, inner_line, z_root));
  return elementary::quick_atan2(slope, 1.0);
}

std::vector<double> required_bevels(std::span<const joint::PreparedCutter> cutters,
                                    const Wall& wall, const joint::Stations& inner,
                                    std::span<const double> z_root) {
  auto slopes = joint::steepest_at(cutters, wall, inner, z_root);
  elementary::quick_atan2(slopes, std::vector<double>(slopes.size(), 1.0), slopes);
  return slopes;
}

double lift(std::span<const joint::PreparedCutter> cutters, const Wall& wall,
            const joint::Generator& inner_line, double slope) {
  double z = -kUnbounded;
  for (const auto& cutter : cutters)
    z = std::max(z, joint::support(cutter, wall, inner_line, slope));
  return z;
}

}  // namespace tubecut::bevel
