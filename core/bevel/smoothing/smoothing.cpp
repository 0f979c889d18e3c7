#include "core/bevel/smoothing/smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/angle.hpp"

namespace tubecut::bevel {
namespace {

double length_after(const AngleProfile& profile, std::size_t j) {
  const auto& s = profile.s;
  return j + 1 < s.size() ? s[j + 1] - s[j] : s.front() + profile.period - s.back();
}

std::size_t previous(std::size_t j, std::size_t n) { return j == 0 ? n - 1 : j - 1; }
std::size_t next(std::size_t j, std::size_t n) { return j + 1 == n ? 0 : j + 1; }

bool finite(double x) { return std::isfinite(x); }

}  // namespace

Result<BevelRateLimits> bevel_rate_limits(double velocity, double acceleration, double speed,
                                          double use) {
  const auto above_zero = [](double x) { return finite(x) && x > 0.0; };
  if (!above_zero(velocity))
    return fail({.code = ErrorCode::zero_limit,
                 .member = "velocity",
                 .got = velocity * kDegPerRad,
                 .limit = 0.0,
                 .unit = "deg/s"});
  if (!above_zero(acceleration))
    return fail({.code = ErrorCode::zero_limit,
                 .member = "acceleration",
                 .got = acceleration * kDegPerRad,
                 .limit = 0.0,
                 .unit = "deg/s^2"});
  if (!above_zero(speed))
    return fail({.code = ErrorCode::out_of_range,
                 .member = "speed",
                 .got = speed,
                 .limit = 0.0,
                 .unit = "mm/s"});
  if (!(use > 0.0 && use <= 1.0))
    return fail({.code = ErrorCode::out_of_range, .member = "use", .got = use, .limit = 1.0});
  return BevelRateLimits{use * velocity / speed, use * acceleration / (speed * speed)};
}

std::vector<Mutation> mutations(std::span<const double> b, double limit) {
  std::vector<Mutation> found;
  for (std::size_t i = 0; i < b.size(); ++i) {
    const double step = b[next(i, b.size())] - b[i];
    if (std::abs(step) > limit) found.push_back({i, step});
  }
  return found;
}

Steepness steepness(const AngleProfile& profile) {
  const auto& b = profile.b;
  const std::size_t n = b.size();
  Steepness most;
  if (n == 0) return most;
  double h_left = length_after(profile, n - 1);
  double slope_left = (b[0] - b[n - 1]) / h_left;
  for (std::size_t j = 0; j < n; ++j) {
    const double h_right = length_after(profile, j);
    const double slope_right = (b[next(j, n)] - b[j]) / h_right;
    most.slope = std::max(most.slope, std::abs(slope_right));
    most.second =
        std::max(most.second, std::abs(slope_right - slope_left) / (0.5 * (h_left + h_right)));
    h_left = h_right;
    slope_left = slope_right;
  }
  return most;
}

Steepness allowed_steepness(const AngleProfile& smoothed, const BevelRateLimits& limits) {
  constexpr double kEps = std::numeric_limits<double>::epsilon();
  double highest = 0.0, narrow = smoothed.period;
  for (std::size_t j = 0; j < smoothed.b.size(); ++j) {
    highest = std::max(highest, std::abs(smoothed.b[j]));
    narrow = std::min(narrow, length_after(smoothed, j));
  }
  return {.slope = limits.slope * (1.0 + 1e-9) + 4.0 * kEps * highest / narrow,
          .second = limits.curvature * (1.0 + 1e-6) + 8.0 * kEps * highest / (narrow * narrow)};
}

double area_above(const AngleProfile& profile, std::span<const double> smoothed) {
  const std::size_t n = profile.b.size();
  double area = 0.0;
  for (std::size_t j = 0; j < n; ++j) {
    const double width = 0.5 * (length_after(profile, previous(j, n)) + length_after(profile, j));
    area += (smoothed[j] - profile.b[j]) * width;
  }
  return area;
}

Result<void> check_profile(const AngleProfile& profile) {
  const auto& [s, b, period] = profile;
  if (s.size() < 3 || s.size() != b.size())
    return fail({.code = ErrorCode::wrong_count,
                 .member = "b",
                 .got = static_cast<double>(b.size()),
                 .limit = static_cast<double>(std::max<std::size_t>(s.size(), 3))});
  for (std::size_t j = 0; j < s.size(); ++j) {
    if (!finite(s[j]))
      return fail({.code = ErrorCode::not_finite, .member = "s/" + std::to_string(j)});
    if (!finite(b[j]))
      return fail({.code = ErrorCode::not_finite, .member = "b/" + std::to_string(j)});
    if (j > 0 && !(s[j] > s[j - 1]))
      return fail({.code = ErrorCode::out_of_range,
                   .member = "s/" + std::to_string(j),
                   .got = s[j],
                   .limit = s[j - 1],
                   .unit = "mm"});
  }
  if (!finite(period) || !(s.front() + period - s.back() > 0.0))
    return fail({.code = ErrorCode::out_of_range,
                 .member = "period",
                 .got = period,
                 .limit = s.back() - s.front(),
                 .unit = "mm"});
  return {};
}

}  // namespace tubecut::bevel
