#include "core/cutout/shadow/square_lines.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::cutout {
namespace {

using Eigen::Vector2d;

constexpr double kEdgeOn = 1e-9;  // of a direction: a flat seen along itself

double direction_of(const Vector2d& v) { return elementary::atan2(v.y(), v.x()); }

}  // namespace

double SquareLines::girth() const {
  return wall_ ? wall_->outer().girth() : kTwoPi * tube_.outer_radius;
}

SquareLine SquareLines::at(double s) const {
  if (!wall_) {
    const auto [sin, cos] = elementary::sincos(s / tube_.outer_radius);
    const Vector2d n(cos, sin), t(-sin, cos);
    return {tube_.outer_radius * n, tube_.inner_radius() * n, t,
            tube_.inner_radius() / tube_.outer_radius * t};
  }
  const auto at = wall_->outer().at(s);
  const auto across = wall_->across(at);
  const auto t = at.tangent();
  const double slope = across.bore.normal.dot(t) / across.bore.normal.dot(at.normal);
  return {at.point, across.bore.point, t,
          (1.0 - at.curvature * across.wall) * (t - slope * at.normal)};
}

std::vector<double> SquareLines::seams(double from, double to) const {
  if (!wall_) return {};
  const auto& bore = wall_->bore();
  auto all = wall_->outer().seams();
  for (const double s : bore.seams()) all.push_back(wall_->outside_of(bore.at(s)));
  std::vector<double> out;
  for (const double s : all)
    for (int turn = -2; turn <= 2; ++turn)
      if (const double here = s + turn * girth(); here > from && here < to) out.push_back(here);
  std::ranges::sort(out);
  return out;
}

SquareLines::Side SquareLines::side(const Vector2d& towards) const {
  const double nu = direction_of(towards), quarter = 0.5 * kPi;
  if (!wall_) return {tube_.outer_radius * (nu - quarter), tube_.outer_radius * (nu + quarter)};
  Side out{};
  bool any = false;
  const auto keep = [&](double from, double to) {
    out = any ? Side{std::min(out.from, from), std::max(out.to, to)} : Side{from, to};
    any = true;
  };
  for (const auto& segment : wall_->outer().segments())
    for (int turn = -2; turn <= 2; ++turn) {
      const double begin = segment.nu + turn * kTwoPi, s = segment.from + turn * girth();
      if (!segment.is_arc()) {
        if (std::abs(begin - nu) < kPi && segment.normal.dot(towards) > kEdgeOn)
          keep(s, s + segment.length);
        continue;
      }
      const double from = std::max(begin, nu - quarter);
      const double to = std::min(begin + segment.length / segment.radius, nu + quarter);
      if (to - from > kEdgeOn)
        keep(s + segment.radius * (from - begin), s + segment.radius * (to - begin));
    }
  return out;
}

}  // namespace tubecut::cutout
