#include "api/formats/feed_curve_formats.hpp"

#include <algorithm>

#include "api/formats/csv.hpp"
#include "api/formats/drawing/chart.hpp"
#include "api/formats/numbers.hpp"
#include "api/formats/text.hpp"
#include "api/stop.hpp"
#include "api/wire/tables.hpp"

namespace tubecut::api {
namespace {

/// sum c_k t^k by Horner.
double value(const std::vector<double>& coefficients, double t) {
  double out = 0.0;
  for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c) out = out * t + *c;
  return out;
}

/// A real literal of IEC 61131-3 needs its decimal point.
std::string literal(double v) {
  auto text = shown(v);
  const auto e = text.find('e');
  auto mantissa = text.substr(0, e);
  if (mantissa.find('.') == std::string::npos) mantissa += ".0";
  return e == std::string::npos ? mantissa : mantissa + "E" + text.substr(e + 1);
}

std::string verdict_comments(const Caption& caption) {
  std::string out;
  for (const auto& line : verdict_lines(caption.verdict))
    out += "(* " + structured_text_text(line) + " *)\n";
  return out;
}

}  // namespace

std::string feed_curve_csv(const cutoff::FeedCurveSpec&, const cutoff::FeedCurve& curve,
                           const Caption& caption) {
  if (caption.view == "samples" && curve.cycle) {
    const auto& s = curve.cycle->samples;
    Columns columns;
    const auto add = [&](std::string_view name, const std::vector<double>& values) {
      ask();  // a million numbers are copied
      columns.column(name, values);
    };
    add("t_s", s.time);
    add("stroke_mm", s.stroke);
    add("cylinder_speed_mm_s", s.speed);
    add("cylinder_acceleration_mm_s2", s.acceleration);
    add("feed_mm", s.feed);
    add("feed_speed_mm_s", s.feed_speed);
    return Csv(caption).table(columns).print();
  }
  std::vector<double> command;
  for (const double t : curve.table.time) command.push_back(value(curve.fit.seconds_rounded, t));
  return Csv(caption).table(feed_columns(curve).column("command_mm_s", std::move(command))).print();
}

std::string feed_curve_svg(const cutoff::FeedCurveSpec&, const cutoff::FeedCurve& curve,
                           const Caption& caption) {
  std::vector<double> command;
  for (const double t : curve.table.time) command.push_back(value(curve.fit.seconds_rounded, t));
  std::vector<Chart> charts{
      {.title = "Cylinder stroke over tool feed",
       .x_label = "tool feed, mm",
       .y_label = "stroke, mm",
       .series = {{.name = "stroke", .x = curve.table.feed, .y = curve.table.stroke}}},
      {.title = "Cylinder speed for a constant tool feed",
       .x_label = "time, s",
       .y_label = "speed, mm/s",
       .series = {{.name = "exact", .x = curve.table.time, .y = curve.table.speed}}},
      {.title = "Polynomial command over the exact speed, degree " +
                std::to_string(curve.fit.degree) + ", error " +
                measure(curve.fit.errors.max_relative_error * 100.0, Unit::percent),
       .x_label = "time, s",
       .y_label = "speed, mm/s",
       .series = {{.name = "exact", .x = curve.table.time, .y = curve.table.speed},
                  {.name = "command",
                   .x = curve.table.time,
                   .y = command,
                   .color = "#c2571a",
                   .dashed = true}}}};
  if (curve.cycle) {
    const auto& c = *curve.cycle;
    charts.push_back({.title = "Tool displacement over the cycle",
                      .x_label = "time, s",
                      .y_label = "tool feed, mm",
                      .series = {{.name = "tool", .x = c.samples.time, .y = c.samples.feed}},
                      .marks = {{c.work_start, "t1"}, {c.work_end, "t2"}, {c.end, "t3"}}});
  }
  return print_charts(charts, caption);
}

std::string feed_curve_structured_text(const cutoff::FeedCurveSpec&, const cutoff::FeedCurve& curve,
                                       const Caption& caption) {
  const auto& fit = curve.fit;
  std::string horner = literal(fit.seconds_rounded.back());
  for (auto i = fit.seconds_rounded.size() - 1; i-- > 0;)
    horner = literal(fit.seconds_rounded[i]) + " + t_s * (" + horner + ")";
  return verdict_comments(caption) + "(* Cylinder speed that keeps the tool feed constant. " +
         structured_text_text(job_line(caption)) +
         ".\n"
         "   Degree " +
         std::to_string(fit.degree) + ", largest relative error " +
         shown(fit.rounded_max_relative_error) +
         ".\n"
         "   t_s: seconds from the start of the work feed. Outside the window valid is FALSE and "
         "the speed 0. *)\n"
         "FUNCTION_BLOCK TubecutFeedCurve\n"
         "VAR_INPUT\n  t_s : LREAL;\nEND_VAR\n"
         "VAR_OUTPUT\n  cylinder_speed_mm_s : LREAL;\n  valid : BOOL;\nEND_VAR\n"
         "VAR CONSTANT\n  T_END_S : LREAL := " +
         literal(fit.duration) +
         ";\nEND_VAR\n\n"
         "valid := (t_s >= 0.0) AND (t_s <= T_END_S);\n"
         "IF valid THEN\n  cylinder_speed_mm_s := " +
         horner +
         ";\n"
         "ELSE\n  cylinder_speed_mm_s := 0.0;\nEND_IF;\n"
         "END_FUNCTION_BLOCK\n";
}

}  // namespace tubecut::api
