#include "api/formats/schedule_formats.hpp"

#include <algorithm>
#include <cmath>

#include "api/formats/chart.hpp"
#include "api/formats/csv.hpp"
#include "core/base/elementary.hpp"
#include "core/motion/replay.hpp"

namespace tubecut::api {
namespace {

constexpr const char* kColors[] = {"#1f5fbf", "#c0392b", "#1e8449", "#8e44ad", "#b9770e"};
constexpr std::size_t kMostPoints = 4'000;  // of a curve: more cannot be told apart

/// Extremes of equal stretches of a long column, so that no peak is lost.
Series thinned(std::string name, const std::vector<double>& y, double dt, const char* color) {
  Series out{.name = std::move(name), .x = {}, .y = {}, .color = color};
  const auto stride = std::max<std::size_t>(1, 2 * y.size() / kMostPoints);
  for (std::size_t i = 0; i < y.size(); i += stride) {
    const auto end = y.begin() + static_cast<std::ptrdiff_t>(std::min(i + stride, y.size()));
    const auto [low, high] = std::minmax_element(y.begin() + static_cast<std::ptrdiff_t>(i), end);
    for (const auto at : {std::min(low, high), std::max(low, high)}) {
      out.x.push_back(dt * static_cast<double>(at - y.begin()));
      out.y.push_back(*at);
      if (low == high) break;
    }
  }
  return out;
}

/// On the surface where the speed is asked for, mm/min.
std::vector<double> tip_speed(const motion::ScheduleSpec& spec, const motion::Schedule& s) {
  motion::ReplaySpec again{.job = spec, .period = s.period, .counts = {}, .start = {}};
  for (const auto& axis : s.axes) {
    again.counts.emplace_back(axis.counts.begin(), axis.counts.end());
    again.start.push_back(axis.start);
  }
  const auto path = motion::replay(again);
  std::vector<double> out;
  if (!path) return out;
  const auto& contour = std::get<motion::Contour>(spec.cut);
  const bool outer = spec.motion.speed_on == motion::Surface::outer;
  const double radius = outer ? contour.outer_radius : contour.inner_radius();
  const double rise = spec.machine.sigma() * (radius - contour.radius());
  const auto along = [&](std::size_t i) { return path->z[i] - rise * elementary::tan(path->b[i]); };
  constexpr std::size_t kMean = 25;  // periods, over which the rounding of pulses averages out
  for (std::size_t i = kMean; i < path->phi.size(); ++i) {
    const double length =
        std::hypot(radius * (path->phi[i] - path->phi[i - kMean]), along(i) - along(i - kMean));
    out.push_back(60.0 * length / (static_cast<double>(kMean) * s.period));
  }
  return out;
}

}  // namespace

std::string schedule_csv(const motion::Schedule& schedule, const Caption& caption) {
  std::vector<std::int64_t> period(static_cast<std::size_t>(schedule.periods));
  for (std::size_t i = 0; i < period.size(); ++i) period[i] = static_cast<std::int64_t>(i);
  Columns columns;
  columns.integers("period", period);
  for (const auto& axis : schedule.axes)
    if (!axis.idle()) columns.integers(axis.name + "_pulses", axis.counts);
  return Csv(caption).table(columns).print();
}

std::string schedule_svg(const motion::ScheduleSpec& spec, const motion::Schedule& s,
                         const Caption& caption) {
  Chart pulses{.title = "Pulses per period of " + shown(s.period * 1e3) + " ms",
               .x_label = "time, s",
               .y_label = "pulses",
               .series = {}};
  for (std::size_t a = 0; a < s.axes.size(); ++a) {
    if (s.axes[a].idle()) continue;
    const std::vector<double> counts(s.axes[a].counts.begin(), s.axes[a].counts.end());
    pulses.series.push_back(
        thinned(s.axes[a].name, counts, s.period, kColors[a % std::size(kColors)]));
  }
  for (const auto& event : s.events)
    pulses.marks.push_back(
        {s.period * static_cast<double>(event.period), std::string(motion::name_of(event.what))});
  std::vector<Chart> charts{std::move(pulses)};
  if (std::holds_alternative<motion::Contour>(spec.cut)) {
    Chart speed{.title = std::string("Speed of the cut on the ") +
                         (spec.motion.speed_on == motion::Surface::outer ? "outer" : "inner") +
                         " surface, mean of 25 periods",
                .x_label = "time, s",
                .y_label = "mm/min",
                .series = {thinned("tip", tip_speed(spec, s), s.period, kColors[0])},
                .y_from_zero = true};
    for (const auto& zone : s.report.slow)
      speed.bands.push_back({s.period * static_cast<double>(zone.from),
                             s.period * static_cast<double>(zone.to), "slow"});
    charts.push_back(std::move(speed));
  }
  return print_charts(charts, caption);
}

}  // namespace tubecut::api
