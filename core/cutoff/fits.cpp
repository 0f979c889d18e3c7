#include "core/cutoff/fits.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/try.hpp"
#include "core/math/quadrature.hpp"

namespace tubecut::cutoff {
namespace {

constexpr int kGaussPoints = 64;

math::ChebyshevSeries through(const WorkFeed& work, const std::vector<double>& nodes) {
  std::vector<double> values;
  for (const double t : nodes) values.push_back(work.cylinder_speed(t));
  return math::interpolant(nodes, values, 0.0, work.work().duration);
}

}  // namespace

Result<math::ChebyshevSeries> three_point(const WorkFeed& work,
                                          const std::optional<std::array<double, 3>>& nodes) {
  const double duration = work.work().duration;
  if (!nodes)
    return through(work, {0.0, work.work().time_at_peak.value_or(0.5 * duration), duration});
  const auto [first, second, third] = *nodes;
  const bool ascending = first >= 0.0 && first < second && second < third && third <= duration;
  if (!ascending)
    return fail({.code = ErrorCode::bad_nodes,
                 .member = "fit/nodes",
                 .limit = Intervals{{0.0, duration}},
                 .unit = "s"});
  return through(work, {first, second, third});
}

math::ChebyshevSeries equispaced(const WorkFeed& work, int degree) {
  std::vector<double> nodes;
  for (int i = 0; i <= degree; ++i) nodes.push_back(work.work().duration * i / degree);
  return through(work, nodes);
}

math::ChebyshevSeries least_squares(const WorkFeed& work, int degree) {
  const double duration = work.work().duration;
  const auto rule = math::gauss_legendre(kGaussPoints);
  std::vector<double> projected(static_cast<std::size_t>(degree) + 1);
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double weighted =
        rule.weights[i] * work.cylinder_speed(0.5 * duration * (1.0 + rule.nodes[i]));
    const auto p = math::legendre(degree, rule.nodes[i]);
    for (std::size_t n = 0; n < p.size(); ++n)
      projected[n] += (static_cast<double>(n) + 0.5) * weighted * p[n];
  }
  const auto projection = [&](double t) {
    const auto p = math::legendre(degree, 2.0 * t / duration - 1.0);
    double sum = 0.0;
    for (std::size_t n = p.size(); n-- > 0;) sum += projected[n] * p[n];
    return sum;
  };
  return math::chebyshev_interpolant(projection, degree, 0.0, duration);
}

Result<math::ChebyshevSeries> minimax(const WorkFeed& work, int degree) {
  TRY(auto found, math::relative_minimax(work.speed(), degree));
  return std::move(found.series);
}

}  // namespace tubecut::cutoff
