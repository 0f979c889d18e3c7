#include "core/motion/machine/soft_limits.hpp"

#include <string>

#include "core/base/stop.hpp"

namespace tubecut::motion {
namespace {

Issue soft_limit(const Axis& axis, std::size_t index, bool upper, double value, double at,
                 bool has_phi) {
  const std::string where = has_phi ? " at phi " + std::to_string(at * kDegPerRad) + " deg" : "";
  return {ErrorCode::soft_limit,
          "machine/axes/" + std::to_string(index) + (upper ? "/soft_max" : "/soft_min"),
          value,
          upper ? *axis.soft_max : *axis.soft_min,
          std::string(name_of(axis.unit)),
          "axis " + axis.name + where};
}

}  // namespace

Result<void> check_soft_limits(const Path& path, const std::vector<AxisFunction>& axes,
                               const Machine& machine, bool has_phi) {
  std::vector<Issue> issues;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const Axis& axis = machine.axes[a];
    for (const bool upper : {false, true}) {
      const auto& bound = upper ? axis.soft_max : axis.soft_min;
      if (!bound) continue;
      double worst = 0.0, value = 0.0, at = 0.0;
      for (std::size_t j = 0; j <= path.intervals() && !stops(j); ++j) {
        const std::size_t i = j == path.intervals() ? j - 1 : j;
        const Coordinates x = path.at(i, j == i ? 0.0 : path.d);
        const double q = axes[a].at(x);
        const double beyond = upper ? q - *bound : *bound - q;
        if (beyond <= worst) continue;
        worst = beyond;
        value = q;
        at = x[0];
      }
      if (worst > 0.0) issues.push_back(soft_limit(axis, a, upper, value, at, has_phi));
    }
  }
  return no_issues(std::move(issues));
}

}  // namespace tubecut::motion
