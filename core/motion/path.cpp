#include "core/motion/path.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"

namespace tubecut::motion {
namespace {

constexpr double kSpacing = 0.1;      // mm between knots, before any halving
constexpr double kWidestTip = 1.0;    // mm, full width of one mean over the tip's coordinates
constexpr double kWidestBevel = 6.0;  // mm, of one mean over B
constexpr double kLeastTip = 1e-3;    // mm
constexpr double kLeastBevel = 0.01 * kRadPerDeg;

/// x at -j is 2 x[0] - x[j], and likewise behind the end.
std::vector<double> reflected(const std::vector<double>& x, std::size_t m) {
  const std::size_t n = x.size();
  std::vector<double> out;
  out.reserve(n + 2 * m);
  for (std::size_t j = m; j > 0; --j) out.push_back(2.0 * x.front() - x[std::min(j, n - 1)]);
  out.insert(out.end(), x.begin(), x.end());
  for (std::size_t j = 1; j <= m; ++j) {
    out.push_back(2.0 * x.back() - x[n - 1 - std::min(j, n - 1)]);
  }
  return out;
}

/// Sums differences to the centre, in pairs: little rounding, and none of the direction.
std::vector<double> mean(const std::vector<double>& x, std::size_t m, const std::stop_token& stop) {
  const std::vector<double> wide = reflected(x, m);
  std::vector<double> out(x.size());
  for (std::size_t i = 0; i < x.size() && !stop.stop_requested(); ++i) {
    double sum = 0.0;
    for (std::size_t j = 1; j <= m; ++j) {
      sum += (wide[i + m + j] - x[i]) + (wide[i + m - j] - x[i]);
    }
    out[i] = x[i] + sum / static_cast<double>(2 * m + 1);
  }
  return out;
}

double knot(const std::vector<double>& p, std::size_t j) {
  if (j == 0 || j + 1 == p.size()) return p[j];
  return (p[j - 1] + 4.0 * p[j] + p[j + 1]) / 6.0;
}

using Group = Coordinate::Group;

struct Smoothed {
  std::vector<std::vector<double>> control;  // of the group's coordinates, in their order
  double deviation = 0.0;                    // mm of generalised length
};

Smoothed smoothed(const Program& p, const Resampled& r, Group group, std::size_t m,
                  const std::stop_token& stop) {
  Smoothed out;
  std::vector<double> square(r.x.front().size(), 0.0);
  for (std::size_t c = 0; c < r.x.size(); ++c) {
    if (p.coordinates[c].group != group) continue;
    out.control.push_back(box2(r.x[c], m, stop));
    for (std::size_t j = 0; j < square.size() && !stops(stop, j); ++j) {
      const double off = p.coordinates[c].weight * (knot(out.control.back(), j) - r.x[c][j]);
      square[j] = group == Group::tip ? square[j] + off * off : std::max(square[j], off * off);
    }
  }
  out.deviation = std::sqrt(*std::ranges::max_element(square));
  return out;
}

/// The widest smoothing that keeps the tolerance; deviation above it only where even none does.
Smoothed widest(const Program& p, const Resampled& r, Group group, double most, double tolerance,
                const std::stop_token& stop) {
  auto fits = static_cast<std::size_t>(most / (2.0 * r.d));
  Smoothed best = smoothed(p, r, group, fits, stop);
  if (best.deviation <= tolerance) return best;
  std::size_t fails = fits;
  fits = 0;
  best = smoothed(p, r, group, 0, stop);
  while (best.deviation <= tolerance && fails - fits > 1 && !stop.stop_requested()) {
    const std::size_t m = fits + (fails - fits) / 2;
    Smoothed next = smoothed(p, r, group, m, stop);
    if (next.deviation <= tolerance) {
      best = std::move(next);
      fits = m;
    } else {
      fails = m;
    }
  }
  return best;
}

Path assembled(const Program& p, const Resampled& r, Smoothed tip, Smoothed bevel) {
  Path path;
  path.d = r.d;
  path.coordinates = p.coordinates;
  std::size_t t = 0, b = 0;
  for (const Coordinate& c : p.coordinates) {
    path.control.push_back(c.group == Group::tip ? tip.control[t++] : bevel.control[b++]);
  }
  path.deviation_tip = tip.deviation;
  path.deviation_b = bevel.deviation / kBevelWeight;
  path.sag_tip = r.sag_tip;
  path.sag_b = r.sag_b;
  path.at_point = p.lengths();
  return path;
}

double behind(const std::vector<double>& p, std::size_t j) {
  return j == 0 ? 2.0 * p[0] - p[1] : p[j - 1];
}
double ahead(const std::vector<double>& p, std::size_t j) {
  return j + 1 == p.size() ? 2.0 * p[j] - p[j - 1] : p[j + 1];
}

/// Position, slope, curvature and third derivative of one coordinate at a knot, seen from the
/// interval after it.
struct Cubic {
  double x, first, second, third;
};
Cubic cubic(const std::vector<double>& p, std::size_t i, double d) {
  const double a = behind(p, i), b = p[i], c = p[i + 1], e = ahead(p, i + 1);
  return {knot(p, i), (c - a) / (2.0 * d), (c - 2.0 * b + a) / (d * d),
          (e - 3.0 * c + 3.0 * b - a) / (d * d * d)};
}

}  // namespace

std::vector<double> box2(const std::vector<double>& x, std::size_t m, const std::stop_token& stop) {
  std::vector<double> out = mean(mean(x, m, stop), m, stop);
  out.front() = x.front();
  out.back() = x.back();
  return out;
}

Coordinates Path::at(std::size_t i, double offset) const {
  return PathCursor(*this, false).at(i, offset).x;
}

Pose PathCursor::at(std::size_t i, double w) {
  const std::size_t n = path_.control.size();
  if (i != interval_) {
    for (std::size_t c = 0; c < n; ++c) {
      const auto [x, first, second, third] = cubic(path_.control[c], i, path_.d);
      cubic_[c] = {x, first, 0.5 * second, third / 6.0};
    }
    interval_ = i;
  }
  const bool end = i + 1 == path_.intervals() && w >= path_.d;
  Pose out;
  for (std::size_t c = 0; c < n; ++c) {
    const Cubic& q = cubic_[c];
    out.x[c] = end ? path_.control[c].back() : q.x + w * (q.first + w * (q.second + w * q.third));
  }
  if (bends_) {
    const auto [sin, cos] = elementary::sincos(out.x[2]);
    out.sin_b = sin;
    out.cos_b = cos;
  }
  return out;
}

Jet Path::jet(std::size_t i, double w) const {
  Jet out;
  for (std::size_t c = 0; c < control.size(); ++c) {
    const Cubic q = cubic(control[c], i, d);
    out.value[c] = q.x + w * (q.first + w * (0.5 * q.second + w * (q.third / 6.0)));
    out.first[c] = q.first + w * (q.second + w * 0.5 * q.third);
    out.second[c] = q.second + w * q.third;
    out.third[c] = q.third;
  }
  return out;
}

Result<Path> smooth_path(const Program& p, double eps_tip, Angle eps_b, std::stop_token stop) {
  if (!(eps_tip >= kLeastTip)) {
    return fail({ErrorCode::out_of_range, "motion/eps_tip", eps_tip, kLeastTip, "mm", {}});
  }
  if (!(eps_b.rad() >= kLeastBevel)) {
    return fail({ErrorCode::out_of_range, "motion/eps_b", eps_b.deg(), 0.01, "deg", {}});
  }
  const double bevel = eps_b.rad() * kBevelWeight;
  // With no mean at all a knot is off by at most d / 3, so the halving ends.
  for (double d = kSpacing;; d *= 0.5) {
    const auto samples = resample(p, d, eps_tip, eps_b.rad(), stop);
    if (!samples) return tl::unexpected<Error>(samples.error());
    Smoothed tip = widest(p, *samples, Group::tip, kWidestTip, eps_tip, stop);
    Smoothed swing = widest(p, *samples, Group::bevel, kWidestBevel, bevel, stop);
    if (stop.stop_requested()) return fail({.code = ErrorCode::cancelled});
    if (tip.deviation <= eps_tip && swing.deviation <= bevel) {
      return assembled(p, *samples, std::move(tip), std::move(swing));
    }
  }
}

}  // namespace tubecut::motion
