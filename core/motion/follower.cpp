#include "core/motion/follower.hpp"

#include <algorithm>
#include <cmath>

namespace tubecut::motion {
namespace {

double distance(const TipPoint& a, const TipPoint& b) {
  double square = 0.0;
  for (std::size_t c = 0; c < a.size(); ++c) square += (a[c] - b[c]) * (a[c] - b[c]);
  return std::sqrt(square);
}

/// Share of the way from `a` to `b` nearest to `p`, 0..1.
double foot(const TipPoint& p, const TipPoint& a, const TipPoint& b) {
  double along = 0.0, square = 0.0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    along += (p[c] - a[c]) * (b[c] - a[c]);
    square += (b[c] - a[c]) * (b[c] - a[c]);
  }
  return square > 0.0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
}

TipPoint between(const TipPoint& a, const TipPoint& b, double share) {
  TipPoint out{};
  for (std::size_t c = 0; c < a.size(); ++c) out[c] = a[c] + share * (b[c] - a[c]);
  return out;
}

}  // namespace

Follower::Follower(const Program& program, const std::vector<bool>& part, double window)
    : x_program(program), x_missed(program.size(), 1e300), x_window(window) {
  for (std::size_t c = 0; c < program.coordinates.size(); ++c) {
    if (part[c]) x_tip_coordinates.push_back(c);
  }
  for (std::size_t i = 0; i < program.size(); ++i) {
    Coordinates x{};
    for (std::size_t c = 0; c < program.x.size(); ++c) x[c] = program.x[c][i];
    x_points.push_back(tip_of(x));
    x_at.push_back(i == 0 ? 0.0 : x_at.back() + distance(x_points[i - 1], x_points[i]));
  }
}

TipPoint Follower::tip_of(const Coordinates& x) const {
  TipPoint out{};
  for (const std::size_t c : x_tip_coordinates) out[c] = x_program.coordinates[c].weight * x[c];
  return out;
}

Follower::Found Follower::nearest_on(std::size_t i, const TipPoint& tip) const {
  const double share = foot(tip, x_points[i], x_points[i + 1]);
  const double off = distance(tip, between(x_points[i], x_points[i + 1], share));
  return {off, x_at[i] + share * (x_at[i + 1] - x_at[i]), i};
}

Follower::Found Follower::follow(const TipPoint& tip) {
  Found best{1e300, x_last_at, x_low};
  for (std::size_t i = x_low; i + 1 < x_points.size(); ++i) {
    if (x_at[i] > x_last_at + x_window) break;
    const Found next = nearest_on(i, tip);
    if (next.distance < best.distance) best = next;
  }
  x_last_at = best.at;
  while (x_low > 0 && x_at[x_low] > best.at - x_window) --x_low;
  while (x_low + 2 < x_points.size() && x_at[x_low + 1] < best.at - x_window) ++x_low;
  reach_points(x_started ? x_last : tip, tip, best.at);
  x_last = tip;
  x_started = true;
  return best;
}

void Follower::reach_points(const TipPoint& from, const TipPoint& to, double at) {
  while (x_near > 0 && x_at[x_near - 1] >= at - x_window) --x_near;
  while (x_near < x_points.size() && x_at[x_near] < at - x_window) ++x_near;
  for (std::size_t i = x_near; i < x_points.size() && x_at[i] <= at + x_window; ++i) {
    const TipPoint nearest = between(from, to, foot(x_points[i], from, to));
    x_missed[i] = std::min(x_missed[i], distance(x_points[i], nearest));
  }
}

std::pair<double, double> Follower::range(std::size_t c, double at, double reach) const {
  const std::vector<double>& x = x_program.x[c];
  const double from = at - reach, to = at + reach;
  std::pair<double, double> out{1e300, -1e300};
  const auto see = [&out](double value) {
    out = {std::min(out.first, value), std::max(out.second, value)};
  };
  const auto first = std::ranges::lower_bound(x_at, from) - x_at.begin();
  for (auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(first, 1)); i < x.size(); ++i) {
    if (x_at[i - 1] > to) break;
    const double length = x_at[i] - x_at[i - 1];
    const auto at_share = [&](double s) {
      const double share = length > 0.0 ? std::clamp((s - x_at[i - 1]) / length, 0.0, 1.0) : 0.0;
      return x[i - 1] + share * (x[i] - x[i - 1]);
    };
    see(at_share(from));
    see(length > 0.0 ? at_share(to) : x[i]);
  }
  return out;
}

double Follower::farthest_missed() const { return *std::ranges::max_element(x_missed); }

}  // namespace tubecut::motion
