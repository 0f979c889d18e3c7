#include "core/motion/path/between_knots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/stop.hpp"

namespace tubecut::motion {
namespace {

constexpr int kInner = 15;  // points of the curve between two knots

/// Returns the distance of a point to a piece of a polyline, squared.
template <class Vector>
double squared_distance(const Vector& p, const Vector& from, const Vector& to) {
  const Vector way = to - from;
  const double square = way.squaredNorm();
  const double share = square > 0.0 ? std::clamp(way.dot(p - from) / square, 0.0, 1.0) : 0.0;
  return (from + share * way - p).squaredNorm();
}

}  // namespace

TipPolyline::TipPolyline(const Program& program) : lengths_(program.lengths()) {
  std::vector<std::size_t> tip;
  for (std::size_t c = 0; c < program.coordinates.size(); ++c) {
    if (program.coordinates[c].group != Coordinate::Group::tip) continue;
    tip.push_back(c);
    weights_.push_back(program.coordinates[c].weight);
  }
  points_.reserve(program.size());
  for (std::size_t i = 0; i < program.size() && !stops(i); ++i) {
    Tip& point = points_.emplace_back(static_cast<Eigen::Index>(tip.size()));
    for (std::size_t k = 0; k < tip.size(); ++k)
      point(static_cast<Eigen::Index>(k)) = weights_[k] * program.x[tip[k]][i];
  }
}

double TipPolyline::farthest_between(const std::vector<std::vector<double>>& control, std::size_t i,
                                     double d, double reach) const {
  const double from = d * static_cast<double>(i) - reach,
               to = d * static_cast<double>(i + 1) + reach;
  const auto after = std::ranges::upper_bound(lengths_, from) - lengths_.begin();
  const auto first = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - 1, 0));
  std::vector<std::array<double, 4>> cubics;
  for (const auto& values : control) cubics.push_back(cubic(values, i, d));
  double farthest = 0.0;
  Tip at(static_cast<Eigen::Index>(control.size()));
  for (int j = 1; j <= kInner; ++j) {
    const double w = d * j / (kInner + 1);
    for (std::size_t k = 0; k < cubics.size(); ++k) {
      const auto& q = cubics[k];
      at(static_cast<Eigen::Index>(k)) = weights_[k] * (q[0] + w * (q[1] + w * (q[2] + w * q[3])));
    }
    double nearest = std::numeric_limits<double>::max();
    for (std::size_t p = first; p + 1 < points_.size() && (p == first || lengths_[p] < to); ++p)
      nearest = std::min(nearest, squared_distance(at, points_[p], points_[p + 1]));
    farthest = std::max(farthest, nearest);
  }
  return std::sqrt(farthest);
}

}  // namespace tubecut::motion
