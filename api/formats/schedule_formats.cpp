#include "api/formats/schedule_formats.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "api/formats/csv.hpp"
#include "api/formats/drawing/chart.hpp"
#include "api/formats/numbers.hpp"
#include "api/stop.hpp"
#include "api/wire/motion_names.hpp"
#include "api/wire/words.hpp"
#include "core/base/elementary.hpp"
#include "core/motion/replay/replay.hpp"

namespace tubecut::api {
namespace {

constexpr const char* kColors[] = {"#2c6a9b", "#c2571a", "#4a8a57",
                                   "#8a5f8f", "#a98545", "#3f8a9a"};
/// Returns the speed on the surface for which it is requested, mm/min.
std::vector<double> tip_speed(const motion::ScheduleSpec& spec, const motion::Schedule& s) {
  motion::Counted counted{s.period, static_cast<std::size_t>(s.periods), {}, {}, {}};
  for (const auto& axis : s.axes) {
    counted.counts.emplace_back(axis.counts);
    counted.start.push_back(axis.start);
  }
  motion::Replay path;
  motion::rebuild(spec, counted, path);
  ask();
  std::vector<double> out;
  const auto& contour = std::get<motion::CutPath>(spec.cut);
  const bool outer = spec.motion.speed_on == motion::Surface::outer;
  const double radius = outer ? contour.outer_radius : contour.inner_radius();
  const double rise = spec.machine.sigma() * (radius - contour.radius());
  const auto along = [&](std::size_t i) { return path.z[i] - rise * elementary::tan(path.b[i]); };
  const bool section = contour.section.has_value();
  constexpr std::size_t kMean = 25;  // periods, over which the rounding of pulses averages out
  Pace pace;
  for (std::size_t i = kMean; i < path.phi.size(); ++i) {
    pace.tick();
    const std::size_t from = i - kMean;
    const double length =
        section ? std::hypot(path.x[i] - path.x[from], path.y[i] - path.y[from],
                             path.z[i] - path.z[from])
                : std::hypot(radius * (path.phi[i] - path.phi[from]), along(i) - along(from));
    out.push_back(60.0 * length / (static_cast<double>(kMean) * s.period));
  }
  return out;
}

/// Returns the same cut without a plan: the pulses that each segment requires, and the capacity of
/// a period.
Chart naive_chart(const motion::ScheduleSpec& spec, const motion::Naive& naive) {
  Chart out{.title = "Before: pulses per period at constant speed, segment by segment",
            .x_label = "time, s",
            .y_label = "pulses",
            .series = {},
            .y_from_zero = true};
  for (std::size_t a = 0; a < naive.axes.size(); ++a) {
    const auto& axis = naive.axes[a];
    if (axis.peak == 0) continue;
    Series steps{.name = axis.name, .x = {}, .y = {}, .color = kColors[a % std::size(kColors)]};
    for (std::size_t i = 0; i < axis.pulses.size(); ++i)
      for (const auto end : {i, i + 1}) {
        steps.x.push_back(naive.time[end]);
        steps.y.push_back(axis.pulses[i]);
      }
    out.series.push_back(std::move(steps));
  }
  std::set<std::int64_t> limits;
  for (const auto& axis : spec.machine.axes)
    if (axis.n_max) limits.insert(*axis.n_max);
  for (const auto most : limits) {
    const auto held = static_cast<double>(most);
    out.series.push_back({.name = std::to_string(most) + " at most",
                          .x = {0.0, naive.time.back()},
                          .y = {held, held},
                          .color = "#555555",
                          .dashed = true});
  }
  return out;
}

/// The same, a row a segment.
Columns naive_columns(const motion::Naive& naive) {
  Columns out;
  out.column("naive_end_s", std::vector(naive.time.begin() + 1, naive.time.end()));
  for (const auto& axis : naive.axes) out.column("naive_" + axis.name + "_pulses", axis.pulses);
  return out;
}

/// Marks of one cut's events; of a program's, which are many, the rapids between the cuts.
void tell_events(const motion::Schedule& s, Chart& chart) {
  using enum motion::EventKind;
  const auto at = [&](const motion::Event& e) { return s.period * static_cast<double>(e.period); };
  const bool program = std::ranges::count(s.events, rapid_start, &motion::Event::what) > 0;
  for (const auto& event : s.events) {
    if (!program) chart.marks.push_back({at(event), called(name_of(event.what), Term::value)});
    if (event.what == rapid_start) chart.bands.push_back({.from = at(event), .label = "rapid"});
    if (event.what == rapid_end) chart.bands.back().to = at(event);
  }
}

}  // namespace

std::string schedule_csv(const motion::Schedule& schedule, const Caption& caption) {
  std::vector<std::int64_t> period(static_cast<std::size_t>(schedule.periods));
  for (std::size_t i = 0; i < period.size(); ++i) period[i] = static_cast<std::int64_t>(i);
  Columns columns;
  columns.integers("period", period);
  for (const auto& axis : schedule.axes)
    if (!axis.idle()) columns.integers(axis.name + "_pulses", axis.counts);
  Csv csv(caption);
  csv.table(columns);
  if (schedule.comparison) csv.table(naive_columns(schedule.comparison->naive));
  return csv.print();
}

std::string schedule_svg(const motion::ScheduleSpec& spec, const motion::Schedule& s,
                         const Caption& caption) {
  Chart pulses{.title = "Pulses per period of " + number(s.period * 1e3) + " ms",
               .x_label = "time, s",
               .y_label = "pulses",
               .series = {}};
  for (std::size_t a = 0; a < s.axes.size(); ++a) {
    if (s.axes[a].idle()) continue;
    pulses.series.push_back({.name = s.axes[a].name,
                             .x = {},
                             .y = {s.axes[a].counts.begin(), s.axes[a].counts.end()},
                             .color = kColors[a % std::size(kColors)],
                             .every = s.period});
  }
  tell_events(s, pulses);
  std::vector<Chart> charts{std::move(pulses)};
  const auto* const contour = std::get_if<motion::CutPath>(&spec.cut);
  if (contour != nullptr && !contour->phi.empty()) {
    Chart speed{.title = std::string("Speed of the cut on the ") +
                         std::string(name_of(spec.motion.speed_on)) +
                         " surface, mean of 25 periods",
                .x_label = "time, s",
                .y_label = "mm/min",
                .series = {{.name = "tip", .x = {}, .y = tip_speed(spec, s), .every = s.period}},
                .y_from_zero = true};
    for (const auto& zone : s.report.slow)
      speed.bands.push_back({s.period * static_cast<double>(zone.from),
                             s.period * static_cast<double>(zone.to), "slow"});
    charts.push_back(std::move(speed));
  }
  if (s.comparison) charts.push_back(naive_chart(spec, s.comparison->naive));
  return print_charts(charts, caption);
}

}  // namespace tubecut::api
