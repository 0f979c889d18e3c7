#include "core/cutoff/verify.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/cutoff/verify_parts.hpp"
#include "core/math/search.hpp"

namespace tubecut::cutoff {
namespace {

double ratio(double got, double want) { return std::abs(got - want) / std::abs(want); }

double feed_error(const Linkage& linkage, const ArmTip& tip, double stroke, double feed) {
  const TipFeed here = tip.at(stroke);
  return std::abs(here.feed - feed) / feed_scale(linkage, here);
}

void verify_geometry(const FeedCurveSpec& spec, const FeedCurve& curve, const ArmTip& tip,
                     std::vector<Check>& checks) {
  const auto& g = curve.geometry;
  double limits = 0.0;  // at an end of the stroke the tool is infinitely far, or slot 1 tangent to
                        // the arm circle
  for (const double stroke : {g.stroke_low, g.stroke_high}) {
    const TipFeed end = tip.at(stroke);
    worsen(limits, std::min(end.elevation_cosine, std::abs(end.tangency)));
  }
  checks.push_back({"stroke_limits", limits, limit::kStrokeLimit, ""});
  if (g.feed_at_peak) {
    const auto beyond = [&](double stroke) { return tip.at(stroke).feed - *g.feed_at_peak; };
    const double width = g.stroke_high - g.stroke_low;
    const double stroke =
        math::sign_change(beyond, g.stroke_low + 1e-9 * width, g.stroke_high - 1e-9 * width);
    const TipFeed here = tip.at(stroke);
    checks.push_back(
        {"peak_feed", std::abs(here.second) / here.second_terms, limit::kAcceleration, ""});
  }
  const auto& w = curve.work;
  const double ends = worst_of({feed_error(spec.linkage, tip, w.start_stroke, w.start_feed),
                                feed_error(spec.linkage, tip, w.end_stroke, w.end_feed)});
  checks.push_back({"work_ends", ends, limit::kFeed, ""});
  if (const auto& pair = spec.linkage.calibrate)
    checks.push_back(
        {"calibration", feed_error(spec.linkage, tip, pair->stroke, pair->feed), limit::kFeed, ""});
}

void verify_table(const FeedCurveSpec& spec, const FeedCurve& curve, const ArmTip& tip,
                  std::vector<Check>& checks) {
  const auto& t = curve.table;
  const auto& w = curve.work;
  const double v = w.feed;
  const double reach = std::abs(w.start_feed) + std::abs(w.end_feed);
  double feed = 0.0;
  double speed = 0.0;
  double acceleration = 0.0;
  double pace = ratio(t.time.back(), w.duration) + std::abs(t.time.front()) / w.duration;
  for (std::size_t i = 0; i < t.time.size() && !stopped(); ++i) {
    const TipFeed here = tip.at(t.stroke[i]);
    const double cube = here.first * here.first * here.first;
    worsen(feed, std::abs(here.feed - t.feed[i]) / feed_scale(spec.linkage, here));
    worsen(speed, ratio(t.speed[i] * here.first, v));
    worsen(acceleration,
           std::abs(t.acceleration[i] * cube / (v * v) + here.second) / here.second_terms);
    worsen(pace, std::abs(w.start_feed + v * t.time[i] - t.feed[i]) / reach);
  }
  checks.push_back({"table_feed", feed, limit::kFeed, ""});
  checks.push_back({"table_speed", speed, limit::kSpeed, ""});
  checks.push_back({"table_acceleration", acceleration, limit::kAcceleration, ""});
  checks.push_back({"table_pace", pace, limit::kPace, ""});
}

void verify_tool(const FeedCurveSpec& spec, const FeedCurve& curve, std::vector<Check>& checks) {
  const auto& tool = *spec.tool;
  const auto& out = *curve.tool;
  const double v = curve.work.feed;
  const double per_second = tool.disc / 60.0;
  const double ripple = curve.fit.errors.tool_ripple;
  checks.push_back(
      {"tool_feed",
       worst_of({ratio(out.feed_per_revolution * per_second, v),
                 ratio(out.feed_per_blade * per_second * tool.blades, v),
                 ratio(out.feed_per_blade_low + out.feed_per_blade_high, 2.0 * out.feed_per_blade),
                 std::abs((out.feed_per_blade_high - out.feed_per_blade) / out.feed_per_blade -
                          ripple)}),
       limit::kTool, ""});
  const double fine = out.feed_per_blade / 2.0;  // mm, in the parabola y^2/(2 r) of the corner
  const double coarse = out.feed_per_revolution / 2.0;
  checks.push_back({"tool_roughness",
                    worst_of({ratio(out.roughness / 1000.0 * 2.0 * tool.corner_radius, fine * fine),
                              ratio(out.roughness_one_blade / 1000.0 * 2.0 * tool.corner_radius,
                                    coarse * coarse)}),
                    limit::kTool, ""});
  if (!out.wall_cut) return;
  const auto& cut = *out.wall_cut;
  const double outside = 0.5 * spec.tube->outer_diameter;
  const double bore = outside - spec.tube->wall;
  const double metres_per_rad = kTwoPi * tool.disc / 1000.0;
  checks.push_back(
      {"tool_wall_cut",
       worst_of({ratio(cut.cutting_speed_outside, outside * metres_per_rad),
                 ratio(cut.cutting_speed_bore, bore * metres_per_rad),
                 ratio(cut.duration * v, outside - bore),
                 ratio(cut.revolutions, cut.duration * per_second),
                 ratio(cut.chip_rate, kTwoPi * outside * tool.kerf * v),
                 ratio(cut.chip_volume, kPi * (outside * outside - bore * bore) * tool.kerf)}),
       limit::kWallCut, ""});
}

}  // namespace

std::vector<Check> verify(const FeedCurveSpec& spec, const FeedCurve& curve) {
  const ArmTip tip(spec.linkage, curve.geometry.rad_per_mm);
  std::vector<Check> checks;
  verify_geometry(spec, curve, tip, checks);
  verify_table(spec, curve, tip, checks);
  verify_command(spec, curve, tip, checks);
  if (curve.cycle) verify_cycle(spec, curve, tip, checks);
  if (curve.tool) verify_tool(spec, curve, checks);
  return checks;
}

}  // namespace tubecut::cutoff
