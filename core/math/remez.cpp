#include "core/math/remez.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/stop.hpp"

namespace tubecut::math {
namespace {

constexpr int kMostExchanges = 60;

double relative_error(const SampledCurve& curve, const ChebyshevSeries& series, double t) {
  const double f = curve.at(t);
  return (value(series, t) - f) / f;
}

struct Levelled {
  ChebyshevSeries series;
  double level = 0.0;
};

/// Solves p(t_i)/f(t_i) - 1 = (-1)^i level for the coefficients and the level.
Levelled level_on(const SampledCurve& curve, const std::vector<double>& reference) {
  const auto n = static_cast<Eigen::Index>(reference.size());
  const double from = curve.grid.front();
  const double to = curve.grid.back();
  Eigen::MatrixXd system(n, n);
  Eigen::VectorXd right(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double t = reference[static_cast<std::size_t>(i)];
    const double s = (2.0 * t - from - to) / (to - from);
    const double f = curve.at(t);
    double before = s;  // T_{-1}
    double here = 1.0;
    for (Eigen::Index k = 0; k + 1 < n; ++k) {
      system(i, k) = here;
      const double next = 2.0 * s * here - before;
      before = here;
      here = next;
    }
    system(i, n - 1) = i % 2 == 0 ? -f : f;
    right(i) = f;
  }
  const Eigen::VectorXd solved = system.partialPivLu().solve(right);
  const Eigen::VectorXd residue = right - system * solved;
  const Eigen::VectorXd refined = solved + system.partialPivLu().solve(residue);
  Levelled out{{from, to, {}}, std::abs(refined(n - 1))};
  for (Eigen::Index k = 0; k + 1 < n; ++k) out.series.coefficients.push_back(refined(k));
  return out;
}

/// Finds the largest |error| of every run of equal sign, refined, in ascending t.
std::vector<Extreme> alternating_extrema(const SampledCurve& curve, const ChebyshevSeries& series) {
  const auto& grid = curve.grid;
  std::vector<std::size_t> best;
  std::vector<double> errors(grid.size());
  for (std::size_t i = 0; i < grid.size(); ++i) {
    errors[i] = (value(series, grid[i]) - curve.values[i]) / curve.values[i];
    const bool same_run = !best.empty() && (errors[best.back()] > 0.0) == (errors[i] > 0.0);
    if (!same_run) {
      best.push_back(i);
    } else if (std::abs(errors[i]) > std::abs(errors[best.back()])) {
      best.back() = i;
    }
  }
  std::vector<Extreme> out;
  for (const std::size_t i : best) {
    const double sign = errors[i] > 0.0 ? 1.0 : -1.0;
    const auto height = [&](double t) { return sign * relative_error(curve, series, t); };
    const Extreme refined =
        golden_maximum(height, grid[i == 0 ? 0 : i - 1], grid[std::min(i + 1, grid.size() - 1)]);
    const bool better = refined.value > std::abs(errors[i]);
    out.push_back(better ? refined : Extreme{grid[i], std::abs(errors[i])});
  }
  return out;
}

/// Drops extrema until `count` are left; the signs stay alternating and the largest one stays.
void thin(std::vector<Extreme>& extrema, std::size_t count) {
  while (extrema.size() > count) {
    if (extrema.size() == count + 1) {
      const bool drop_front = extrema.front().value < extrema.back().value;
      extrema.erase(drop_front ? extrema.begin() : extrema.end() - 1);
      continue;
    }
    std::size_t weakest = 0;  // first of the neighbouring pair whose larger member is smallest
    const auto pair_height = [&](std::size_t i) {
      return std::max(extrema[i].value, extrema[i + 1].value);
    };
    for (std::size_t i = 1; i + 1 < extrema.size(); ++i)
      if (pair_height(i) < pair_height(weakest)) weakest = i;
    const auto first = extrema.begin() + static_cast<std::ptrdiff_t>(weakest);
    extrema.erase(first, first + 2);
  }
}

double highest(const std::vector<Extreme>& extrema) {
  double worst = 0.0;
  for (const auto& extreme : extrema) worst = std::max(worst, extreme.value);
  return worst;
}

}  // namespace

Result<RelativeMinimax> relative_minimax(const SampledCurve& curve, int degree) {
  const auto count = static_cast<std::size_t>(degree) + 2;
  auto reference = chebyshev_grid(count, curve.grid.front(), curve.grid.back());
  for (int exchange = 1; exchange <= kMostExchanges; ++exchange) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    auto solved = level_on(curve, reference);
    auto extrema = alternating_extrema(curve, solved.series);
    const double worst = highest(extrema);
    const double excess = worst - solved.level;
    if (excess <= kLevelled * solved.level || excess <= kLevelledFloor)
      return RelativeMinimax{std::move(solved.series), solved.level, worst, std::move(reference),
                             exchange};
    if (extrema.size() < count)
      break;  // p/f - 1 alternates too rarely: not a curve of the documented domain
    thin(extrema, count);
    for (std::size_t i = 0; i < count; ++i) reference[i] = extrema[i].at;
  }
  return fail({.code = ErrorCode::not_converged, .member = "fit"});
}

}  // namespace tubecut::math
