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
    : program_(program), missed_(program.size(), 1e300), window_(window) {
  for (std::size_t c = 0; c < program.coordinates.size(); ++c) {
    if (part[c]) tip_coordinates_.push_back(c);
  }
  for (std::size_t i = 0; i < program.size(); ++i) {
    Coordinates x{};
    for (std::size_t c = 0; c < program.x.size(); ++c) x[c] = program.x[c][i];
    points_.push_back(tip_of(x));
    at_.push_back(i == 0 ? 0.0 : at_.back() + distance(points_[i - 1], points_[i]));
  }
}

TipPoint Follower::tip_of(const Coordinates& x) const {
  TipPoint out{};
  for (const std::size_t c : tip_coordinates_) out[c] = program_.coordinates[c].weight * x[c];
  return out;
}

Follower::Found Follower::nearest_on(std::size_t i, const TipPoint& tip) const {
  const double share = foot(tip, points_[i], points_[i + 1]);
  const double off = distance(tip, between(points_[i], points_[i + 1], share));
  return {off, at_[i] + share * (at_[i + 1] - at_[i]), i};
}

Follower::Found Follower::follow(const TipPoint& tip) {
  Found best{1e300, last_at_, low_};
  for (std::size_t i = low_; i + 1 < points_.size(); ++i) {
    if (at_[i] > last_at_ + window_) break;
    const Found next = nearest_on(i, tip);
    if (next.distance < best.distance) best = next;
  }
  last_at_ = best.at;
  while (low_ > 0 && at_[low_] > best.at - window_) --low_;
  while (low_ + 2 < points_.size() && at_[low_ + 1] < best.at - window_) ++low_;
  reach_points(started_ ? last_ : tip, tip, best.at);
  last_ = tip;
  started_ = true;
  return best;
}

void Follower::reach_points(const TipPoint& from, const TipPoint& to, double at) {
  while (near_ > 0 && at_[near_ - 1] >= at - window_) --near_;
  while (near_ < points_.size() && at_[near_] < at - window_) ++near_;
  for (std::size_t i = near_; i < points_.size() && at_[i] <= at + window_; ++i) {
    const TipPoint nearest = between(from, to, foot(points_[i], from, to));
    missed_[i] = std::min(missed_[i], distance(points_[i], nearest));
  }
}

std::pair<double, double> Follower::range(std::size_t c, double at, double reach) const {
  const std::vector<double>& x = program_.x[c];
  const double from = at - reach, to = at + reach;
  std::pair<double, double> out{1e300, -1e300};
  const auto see = [&out](double value) {
    out = {std::min(out.first, value), std::max(out.second, value)};
  };
  const auto first = std::ranges::lower_bound(at_, from) - at_.begin();
  for (auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(first, 1)); i < x.size(); ++i) {
    if (at_[i - 1] > to) break;
    const double length = at_[i] - at_[i - 1];
    const auto at_share = [&](double s) {
      const double share = length > 0.0 ? std::clamp((s - at_[i - 1]) / length, 0.0, 1.0) : 0.0;
      return x[i - 1] + share * (x[i] - x[i - 1]);
    };
    see(at_share(from));
    see(length > 0.0 ? at_share(to) : x[i]);
  }
  return out;
}

double Follower::farthest_missed() const { return *std::ranges::max_element(missed_); }

}  // namespace tubecut::motion
