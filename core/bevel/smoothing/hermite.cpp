#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/angle.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/bevel/smoothing/smoothing.hpp"

namespace tubecut::bevel {
namespace {

constexpr std::size_t kMostWindows = 200;
constexpr double kUneven =
    1e-6;  // fraction of the spacing by which uniform samples may differ from it
constexpr double kSlopeOfTransition = 1.5;  // steepest slope of the cubic, in |step| / T

Result<void> check(const AngleProfile& profile, const HermiteSpec& spec) {
  if (auto sound = check_profile(profile); !sound) return sound;
  const auto n = profile.s.size();
  const double spacing = profile.period / static_cast<double>(n);
  for (std::size_t j = 0; j < n; ++j) {
    const double h =
        j + 1 < n ? profile.s[j + 1] - profile.s[j] : profile.s[0] + profile.period - profile.s[j];
    if (std::abs(h - spacing) > kUneven * spacing)
      return fail({.code = ErrorCode::sampling_not_uniform,
                   .member = "s/" + std::to_string(j),
                   .got = h,
                   .limit = spacing,
                   .unit = "mm"});
  }
  if (!(std::isfinite(spec.limit) && spec.limit > 0.0))
    return fail({.code = ErrorCode::out_of_range,
                 .member = "limit",
                 .got = spec.limit * kDegPerRad,
                 .limit = 0.0,
                 .unit = "deg"});
  if (spec.transition &&
      (*spec.transition < 2 || 4 * static_cast<std::size_t>(*spec.transition) > n))
    return fail({.code = ErrorCode::out_of_range,
                 .member = "transition",
                 .got = static_cast<double>(*spec.transition),
                 .limit = *spec.transition < 2 ? 2.0 : static_cast<double>(n / 4),
                 .hint = "at least 2 points and at most a quarter of the turn"});
  for (std::size_t i = 0; i < spec.junctions.size(); ++i) {
    if (spec.junctions[i] >= n || (i > 0 && spec.junctions[i] <= spec.junctions[i - 1]))
      return fail({.code = ErrorCode::out_of_range,
                   .member = "junctions/" + std::to_string(i),
                   .got = static_cast<double>(spec.junctions[i]),
                   .limit = static_cast<double>(n - 1)});
  }
  return {};
}

/// Returns the samples from the step at `index` to the next junction, forwards or backwards; a
/// whole lap if there is no other.
std::size_t gap_to_junction(std::span<const std::size_t> junctions, std::size_t index,
                            bool forwards, std::size_t n) {
  std::size_t least = n;
  for (const auto junction : junctions) {
    const auto away = forwards ? (junction + n - index) % n : (index + n - junction) % n;
    if (away > 0) least = std::min(least, away);
  }
  return least;
}

/// Returns the smallest T whose cubic stays within the limit, if it ends within half the gap to the
/// next junction.
Result<std::size_t> own_transition(const Mutation& worst, double limit,
                                   std::span<const std::size_t> junctions, std::size_t n) {
  const double least = std::max(2.0, std::ceil(kSlopeOfTransition * std::abs(worst.step) / limit));
  const auto gap = gap_to_junction(junctions, worst.index, worst.step < 0.0, n);
  const auto most = static_cast<double>(std::min(gap / 2, n / 4));
  if (!(least <= most))
    return fail({.code = ErrorCode::transition_too_long,
                 .member = "transition",
                 .got = least,
                 .limit = most});
  return static_cast<std::size_t>(least);
}

Mutation largest(std::span<const Mutation> found) {
  return *std::ranges::max_element(found, {}, [](const Mutation& m) { return std::abs(m.step); });
}

/// Replaces the inner samples of the window of `length` samples that keeps the larger side of the
/// step.
HermiteWindow smooth_step(std::vector<double>& b, const Mutation& worst, std::size_t length,
                          double spacing) {
  const std::size_t n = b.size();
  const bool before = worst.step < 0.0;
  const std::size_t a = before ? worst.index : (worst.index + 1 + n - length) % n;
  const auto at = [&](std::size_t l) -> double& { return b[(a + l) % n]; };
  const double m0 = at(0) - at(n - 1);
  const double m1 = at(length + 1) - at(length);
  const auto t = static_cast<double>(length);
  for (std::size_t inner = 1; inner < length; ++inner) {
    const auto l = static_cast<double>(inner);
    const double back = l - t;
    at(inner) = at(0) * (2.0 * l + t) * back * back / (t * t * t) -
                at(length) * (2.0 * l - 3.0 * t) * l * l / (t * t * t) +
                m0 * l * back * back / (t * t) + m1 * back * l * l / (t * t);
  }
  return {.index = worst.index,
          .step = worst.step,
          .kept = before ? HermiteWindow::Kept::before : HermiteWindow::Kept::after,
          .from = a,
          .to = (a + length) % n,
          .slope_start = m0 / spacing,
          .slope_end = m1 / spacing};
}

std::vector<std::size_t> junctions_of(const std::vector<double>& b, const HermiteSpec& spec) {
  if (!spec.junctions.empty()) return spec.junctions;
  std::vector<std::size_t> found;
  for (const auto& mutation : mutations(b, spec.limit)) found.push_back(mutation.index);
  return found;
}

}  // namespace

Result<HermiteSmoothed> hermite(const AngleProfile& profile, const HermiteSpec& spec) {
  TRY(check(profile, spec));
  const auto n = profile.b.size();
  const double spacing = profile.period / static_cast<double>(n);
  const auto junctions = junctions_of(profile.b, spec);
  HermiteSmoothed out{.b = profile.b, .windows = {}};
  while (true) {
    const auto left = mutations(out.b, spec.limit);
    if (left.empty()) return out;
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    const auto worst = largest(left);
    if (out.windows.size() == kMostWindows)
      return fail({.code = ErrorCode::smoothing_not_converged,
                   .member = "transition",
                   .got = std::abs(worst.step) * kDegPerRad,
                   .limit = spec.limit * kDegPerRad,
                   .unit = "deg",
                   .hint = std::to_string(left.size()) + " steps are left above the limit after " +
                           std::to_string(kMostWindows) + " windows"});
    TRY(auto length, spec.transition
                         ? Result<std::size_t>(static_cast<std::size_t>(*spec.transition))
                         : own_transition(worst, spec.limit, junctions, n));
    out.windows.push_back(smooth_step(out.b, worst, length, spacing));
  }
}

}  // namespace tubecut::bevel
