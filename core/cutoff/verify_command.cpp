#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/error.hpp"
#include "core/cutoff/verify_parts.hpp"
#include "core/math/chebyshev.hpp"

namespace tubecut::cutoff {
namespace {

constexpr int kSteps = 2000;
constexpr double kErrorFloor =
    1e-6;  // of the speed: smaller errors are compared within kFitError of this, 2e-9

/// One instant of the work feed by Newton on eq. (4).
struct Instant {
  double time = 0.0;
  double feed = 0.0;
  double stroke = 0.0;
  TipFeed tip = {};
};

std::vector<Instant> march(const Work& work, const ArmTip& tip) {
  std::vector<Instant> out;
  double stroke = work.start_stroke;
  for (int i = 0; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    const double feed = work.start_feed + share * (work.end_feed - work.start_feed);
    stroke = tip.stroke_of(feed, stroke);
    out.push_back({share * work.duration, feed, stroke, tip.at(stroke)});
  }
  return out;
}

std::vector<double> integrated(const std::vector<double>& powers) {
  std::vector<double> out{0.0};
  for (std::size_t k = 0; k < powers.size(); ++k)
    out.push_back(powers[k] / static_cast<double>(k + 1));
  return out;
}

double largest_error(const std::vector<Instant>& path, double v,
                     const std::vector<double>& seconds) {
  double worst = 0.0;
  for (const auto& at : path)
    worsen(worst, std::abs(math::horner(seconds, at.time) * at.tip.first / v - 1.0));
  return worst;
}

void push_extremes(const Work& work, const std::vector<Instant>& path, std::vector<Check>& checks) {
  const double v = work.feed;
  double low = HUGE_VAL;
  double high = 0.0;
  double acceleration = 0.0;
  for (const auto& at : path) {
    const double speed = v / at.tip.first;
    low = std::min(low, speed);
    high = std::max(high, speed);
    worsen(acceleration, std::abs(speed * speed * speed * at.tip.second / v));
  }
  const double most = work.max_cylinder_acceleration;
  checks.push_back({"work_speed",
                    worst_of({std::abs(low - work.min_cylinder_speed),
                              std::abs(high - work.max_cylinder_speed)}) /
                        high,
                    limit::kExtreme, ""});
  checks.push_back({"work_acceleration",
                    std::abs(acceleration - most) / (most + kErrorFloor * high), limit::kExtreme,
                    ""});
}

double forms_error(const Command& fit, const std::vector<Instant>& path) {
  const math::ChebyshevSeries series{0.0, fit.duration, fit.chebyshev};
  double worst = 0.0;
  for (const auto& at : path) {
    const double p = math::horner(fit.seconds, at.time);
    const double scaled = math::horner(fit.scaled, 2.0 * at.time / fit.duration - 1.0);
    worst = worst_of(
        {worst, std::abs(scaled / p - 1.0), std::abs(math::value(series, at.time) / p - 1.0)});
  }
  return worst;
}

double disagreement(double measured, double stated, double floor) {
  return std::abs(measured - stated) / (stated + floor);
}

/// Checks the stated ripple, position error and drift against the seconds form, integrated as
/// powers and put through eq. (4).
void push_tool_errors(const FeedCurveSpec& spec, const FeedCurve& curve,
                      const std::vector<Instant>& path, const ArmTip& tip,
                      std::vector<Check>& checks) {
  const auto& fit = curve.fit;
  const double v = curve.work.feed;
  const auto integral = integrated(fit.seconds);
  double scale = 0.0;
  double ripple = 0.0;
  double position = 0.0;
  double drift = 0.0;
  for (const auto& at : path) {
    const TipFeed driven = tip.at(curve.work.start_stroke + math::horner(integral, at.time));
    scale = std::max(scale, feed_scale(spec.linkage, driven));
    drift = driven.feed - at.feed;
    worsen(ripple, std::abs(math::horner(fit.seconds, at.time) * driven.first / v - 1.0));
    worsen(position, std::abs(drift));
  }
  checks.push_back({"fit_tool_ripple", disagreement(ripple, fit.errors.tool_ripple, kErrorFloor),
                    limit::kFitError, ""});
  checks.push_back({"fit_tool_position",
                    disagreement(position, fit.errors.tool_position_error, kErrorFloor * scale),
                    limit::kFitError, ""});
  checks.push_back(
      {"fit_end_drift", std::abs(drift - fit.errors.end_drift) / scale, limit::kFeed, ""});
}

double excess_of_minimax(const std::vector<Command>& rows) {
  double worst = 0.0;
  for (const auto& lowest : rows) {
    if (lowest.method != FitMethod::minimax) continue;
    for (const auto& other : rows)
      if (other.degree == lowest.degree)
        worsen(worst, (lowest.errors.max_relative_error - other.errors.max_relative_error) /
                          (other.errors.max_relative_error + kErrorFloor));
  }
  return worst;
}

}  // namespace

void verify_command(const FeedCurveSpec& spec, const FeedCurve& curve, const ArmTip& tip,
                    std::vector<Check>& checks) {
  const auto path = march(curve.work, tip);
  const auto& fit = curve.fit;
  const double v = curve.work.feed;
  push_extremes(curve.work, path, checks);
  checks.push_back({"fit_forms", forms_error(fit, path), limit::kForms, ""});
  const double measured = largest_error(path, v, fit.seconds);
  checks.push_back({"fit_speed_error",
                    disagreement(measured, fit.errors.max_relative_error, kErrorFloor),
                    limit::kFitError, ""});
  const double rounded = largest_error(path, v, fit.seconds_rounded);
  checks.push_back({"fit_rounded",
                    disagreement(rounded, fit.rounded_max_relative_error, kErrorFloor),
                    limit::kFitError, ""});
  push_tool_errors(spec, curve, path, tip, checks);
  if (curve.comparison)
    checks.push_back(
        {"comparison_minimax", excess_of_minimax(*curve.comparison), limit::kMinimax, ""});
}

}  // namespace tubecut::cutoff
