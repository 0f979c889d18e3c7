#include "api/formats/drawing/chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "api/formats/drawing/canvas.hpp"
#include "api/formats/text.hpp"
#include "api/verdict.hpp"
#include "api/wire/words.hpp"
#include "core/base/angle.hpp"

namespace tubecut::api {
namespace {

constexpr double kWidth = 960.0, kHeight = 360.0;  // px, of one chart
constexpr double kLeft = 78.0, kRight = 24.0, kTop = 56.0, kBottom = 56.0;
constexpr double kLegendLine = 18.0, kVerdictLine = 16.0;
constexpr double kFont = 12.0, kSmall = 11.0, kJob = 10.0,
                 kTitle = 15.0;  // px, of words, labels, the job, titles
constexpr double kPlot = kWidth - kLeft - kRight, kJobLine = 13.0, kTitleLine = 18.0;

/// Round ticks that cover [low, high]: steps of 1, 2 or 5 times a power of ten.
struct Scale {
  double low = 0.0, high = 1.0, step = 0.2;
  int digits = 1;
};

Scale scale(double low, double high, int ticks) {
  if (!(low < high)) {
    const double room = std::max(std::abs(low) * 1e-3, 1e-9);
    low -= room;
    high += room;
  }
  const double raw = (high - low) / ticks;
  double power = 1.0;
  int digits = 0;
  while (power > raw) {
    power /= 10.0;
    ++digits;
  }
  while (power * 10.0 <= raw) {
    power *= 10.0;
    --digits;
  }
  double step = power;
  for (const double factor : {2.0, 5.0, 10.0})
    if (step < raw) step = factor * power;
  if (step >= 10.0 * power) --digits;
  return {std::floor(low / step) * step, std::ceil(high / step) * step, step, std::max(0, digits)};
}

struct Frame {
  Scale x, y;
  double top = 0.0;      // of the plot area, px
  double unit_px = 0.0;  // of an undistorted chart, for both axes

  [[nodiscard]] double px(double v) const {
    if (unit_px > 0.0) return kLeft + unit_px * (v - x.low);
    return kLeft + (v - x.low) / (x.high - x.low) * (kWidth - kLeft - kRight);
  }
  [[nodiscard]] double py(double v) const {
    return top + (y.high - v) / (y.high - y.low) * (kHeight - kTop - kBottom);
  }
};

std::size_t points(const Series& s) {
  return s.x.empty() ? s.y.size() : std::min(s.x.size(), s.y.size());
}

double x_of(const Series& s, std::size_t i) {
  return s.x.empty() ? s.every * static_cast<double>(i) : s.x[i];
}

Frame frame(const Chart& chart, double top) {
  double x0 = std::numeric_limits<double>::infinity(), x1 = -x0, y0 = x0, y1 = -x0;
  for (const auto& s : chart.series) {
    for (std::size_t i = 0; i < points(s); ++i) {
      x0 = std::min(x0, x_of(s, i));
      x1 = std::max(x1, x_of(s, i));
    }
    for (const double v : s.y) {
      y0 = std::min(y0, v);
      y1 = std::max(y1, v);
    }
  }
  if (chart.y_from_zero) y0 = std::min(y0, 0.0);
  for (const auto& limit : chart.limits) {
    y0 = std::min(y0, limit.y);
    y1 = std::max(y1, limit.y);
  }
  auto out = Frame{scale(x0, x1, 12), scale(y0, y1, 6), top};
  out.x.low = x0;  // the data fill the width
  out.x.high = x1 > x0 ? x1 : out.x.high;
  if (!chart.undistorted) return out;
  const double wide = kWidth - kLeft - kRight, tall = kHeight - kTop - kBottom;
  out.unit_px = std::min(tall / (out.y.high - out.y.low), wide / (out.x.high - out.x.low));
  constexpr double kTick = 50.0;  // px, from one tick to the next at least
  const double low = out.x.low, high = out.x.high;
  const double half = 0.5 * tall / out.unit_px, middle = 0.5 * (out.y.low + out.y.high);
  out.x = scale(low, high, std::max(1, static_cast<int>(out.unit_px * (high - low) / kTick)));
  out.y = scale(middle - half, middle + half, static_cast<int>(tall / kTick));
  out.x.low = low;
  out.x.high = high;
  out.y.low = middle - half;  // the plot is as tall as any
  out.y.high = middle + half;
  return out;
}

void text(std::string& out, double x, double y, const std::string& what, const char* extra = "") {
  out += "<text x=\"" + fixed(x) + "\" y=\"" + fixed(y) + "\" " + extra + ">" + xml_text(what) +
         "</text>\n";
}

void line(std::string& out, double x1, double y1, double x2, double y2, const char* look) {
  out += "<line x1=\"" + fixed(x1) + "\" y1=\"" + fixed(y1) + "\" x2=\"" + fixed(x2) + "\" y2=\"" +
         fixed(y2) + "\" " + look + "/>\n";
}

std::vector<std::string> title_lines(const Chart& chart) {
  return wrapped(chart.title, kTitle, kPlot, true);
}
/// Returns the additional height compared with a chart whose title has one line.
double more_title(const Chart& chart) {
  return kTitleLine * static_cast<double>(title_lines(chart).size() - 1);
}

void axes(std::string& out, const Chart& chart, const Frame& f) {
  constexpr const char* kGrid = "stroke=\"#d8dde3\" stroke-width=\"1\"";
  const double bottom = f.py(f.y.low), right = f.px(f.x.high);
  for (double v = std::ceil(f.x.low / f.x.step) * f.x.step; v <= f.x.high + 1e-9 * f.x.step;
       v += f.x.step) {
    line(out, f.px(v), f.top, f.px(v), bottom, kGrid);
    text(out, f.px(v), bottom + 16, fixed(v, f.x.digits), "text-anchor=\"middle\"");
  }
  for (double v = std::ceil(f.y.low / f.y.step - 1e-9) * f.y.step; v <= f.y.high + 1e-9 * f.y.step;
       v += f.y.step) {
    line(out, kLeft, f.py(v), right, f.py(v), kGrid);
    text(out, kLeft - 8, f.py(v) + 4, fixed(v, f.y.digits), "text-anchor=\"end\"");
  }
  constexpr const char* kAxis = "stroke=\"#38424d\" stroke-width=\"1.2\"";
  line(out, kLeft, f.top, kLeft, bottom, kAxis);
  line(out, kLeft, bottom, right, bottom, kAxis);
  text(out, (kLeft + right) / 2, bottom + 36, chart.x_label, "text-anchor=\"middle\"");
  const double middle = (f.top + bottom) / 2;
  out += "<text transform=\"translate(18," + fixed(middle) +
         ") rotate(-90)\" text-anchor=\"middle\">" + xml_text(chart.y_label) + "</text>\n";
  const auto title = title_lines(chart);
  for (std::size_t i = 0; i < title.size(); ++i)
    text(out, kLeft, f.top - 34 - kTitleLine * static_cast<double>(title.size() - 1 - i), title[i],
         "font-size=\"15\" font-weight=\"600\"");
}

void legend(std::string& out, const Chart& chart, const Frame& f) {
  double x = kLeft;
  for (const auto& s : chart.series) {
    if (s.name.empty()) continue;
    line(out, x, f.top - 14, x + 24, f.top - 14,
         ("stroke=\"" + s.color + "\" stroke-width=\"2\"" +
          (s.dashed ? " stroke-dasharray=\"6 4\"" : ""))
             .c_str());
    text(out, x + 30, f.top - 10, s.name);
    x += 46 + text_width(s.name, kFont);
  }
}

/// Points that follow one another in one column of pixels, and those of them that are drawn.
class Column {
 public:
  Column(const Series& s, const Frame& f) : s_(s), f_(f) {}

  /// Takes the next point; if a pixel column ends before it, the lines of that column go to `out`.
  void take(std::size_t i, std::string& out) {
    const double at = std::floor(f_.px(x_of(s_, i)));
    if (open_ && at != at_) draw(out);
    if (!open_) first_ = low_ = high_ = i;
    open_ = true;
    at_ = at;
    last_ = i;
    if (s_.y[i] < s_.y[low_]) low_ = i;
    if (s_.y[i] > s_.y[high_]) high_ = i;
  }
  void draw(std::string& out) {
    open_ = false;
    std::array kept{first_, std::min(low_, high_), std::max(low_, high_), last_};
    const auto end = std::unique(kept.begin(), kept.end());
    for (auto i = kept.begin(); i != end; ++i) point(out, *i);
  }

 private:
  void point(std::string& out, std::size_t i) {
    out += fixed(f_.px(x_of(s_, i))) + "," + fixed(f_.py(s_.y[i])) + " ";
  }

  const Series& s_;
  const Frame& f_;
  bool open_ = false;
  double at_ = 0.0;
  std::size_t first_ = 0, last_ = 0, low_ = 0, high_ = 0;
};

void curve(std::string& out, const Series& s, const Frame& f) {
  out += "<polyline fill=\"none\" stroke=\"" + s.color + "\" stroke-width=\"1.8\"" +
         (s.dashed ? " stroke-dasharray=\"6 4\"" : "") + " points=\"";
  Column column(s, f);
  for (std::size_t i = 0; i < points(s); ++i) column.take(i, out);
  if (points(s) > 0) column.draw(out);
  out += "\"/>\n";
}

constexpr double kRibbon = 7.0, kLabelLine = 13.0;  // px

bool has_ribbon(const Chart& chart) { return std::ranges::any_of(chart.bands, &Band::ribbon); }

/// The lowest baseline of labels: over a ribbon, and over a limit that is drawn down there.
double foot_of_labels(const Chart& chart, const Frame& f, double bottom) {
  constexpr double kRoom = 4.0 * kLabelLine;
  double foot = bottom - 5.0 - (has_ribbon(chart) ? kRibbon : 0.0);
  for (const auto& limit : chart.limits)
    if (const double y = f.py(limit.y); bottom - y < kRoom)
      foot = std::min(foot, y - kLabelLine - 4.0);
  return foot;
}

/// Named over its line, at the right edge.
void draw_limits(std::string& out, const Chart& chart, const Frame& f) {
  for (const auto& limit : chart.limits) {
    const double y = f.py(limit.y);
    line(out, kLeft, y, f.px(f.x.high), y,
         "stroke=\"#b3261e\" stroke-width=\"1.2\" stroke-dasharray=\"6 4\"");
    text(out, f.px(f.x.high) - 3.0, y - 4.0, limit.label,
         "font-size=\"11\" fill=\"#b3261e\" text-anchor=\"end\"");
  }
}

/// Labels that would lie on each other go one above the other; near the right edge they end at
/// their line.
void draw_marks(std::string& out, const Chart& chart, const Frame& f, double bottom, double foot) {
  constexpr double kLine = kLabelLine;
  double before = 0.0, y = foot;  // end of the previous label
  for (const auto& mark : chart.marks) {
    const auto label = shortened(mark.label, kSmall, kPlot - 6.0);
    const double x = f.px(mark.x), width = text_width(label, kSmall) + 6.0;
    line(out, x, f.top, x, bottom,
         "stroke=\"#7a8794\" stroke-width=\"1\" stroke-dasharray=\"3 3\"");
    const bool last = x + width > kWidth - kRight;
    const double from = last ? std::max(kLeft, x - width) : x;
    y = from < before ? y - kLine : foot;
    before = std::max(before, from + width);
    text(out, last ? from + width - 3.0 : x + 3.0, y, label,
         last ? "font-size=\"11\" fill=\"#56626e\" text-anchor=\"end\""
              : "font-size=\"11\" fill=\"#56626e\"");
  }
}

void draw_band(std::string& out, const Band& band, std::pair<double, double> x,
               std::pair<double, double> y) {
  const auto rectangle = [&](double top, const char* look) {
    out += "<rect x=\"" + fixed(x.first) + "\" y=\"" + fixed(top) + "\" width=\"" +
           fixed(std::max(1.0, x.second - x.first)) + "\" height=\"" + fixed(y.second - top) +
           "\" fill=\"" + band.color + "\"" + look + "/>\n";
  };
  rectangle(y.first, " fill-opacity=\"0.12\"");
  if (band.ribbon) rectangle(y.second - kRibbon, "");
}

/// Within the axis. Labels that would lie on each other go one below the other from the top, over a
/// ribbon one above the other from `foot`; near the right edge they end at it. Returns the lowest
/// baseline that is left for others.
double draw_bands(std::string& out, const Chart& chart, const Frame& f, double bottom,
                  double foot) {
  const bool ribbon = has_ribbon(chart);
  const double first = ribbon ? foot : f.top + 12.0, step = ribbon ? -kLabelLine : kLabelLine;
  double before = 0.0, y = first, left = foot;
  for (const auto& band : chart.bands) {
    const double from = f.px(std::clamp(band.from, f.x.low, f.x.high));
    const double to = f.px(std::clamp(band.to, f.x.low, f.x.high));
    draw_band(out, band, {from, to}, {f.top, bottom});
    const auto label = shortened(band.label, kSmall, kPlot - 6.0);
    const double width = text_width(label, kSmall) + 6.0;
    const double at = std::min(from, kWidth - kRight - width);
    y = at < before ? y + step : first;
    before = std::max(before, at + width);
    text(out, at + 3.0, y, label, "font-size=\"11\"");
    if (ribbon) left = std::min(left, y - kLabelLine);
  }
  return left;
}

void plot(std::string& out, const Chart& chart, double top) {
  const auto f = frame(chart, top + kTop);
  const double bottom = f.py(f.y.low);
  const double foot = draw_bands(out, chart, f, bottom, foot_of_labels(chart, f, bottom));
  axes(out, chart, f);
  draw_limits(out, chart, f);
  draw_marks(out, chart, f, bottom, foot);
  for (const auto& s : chart.series) curve(out, s, f);
  legend(out, chart, f);
}

std::string job_in_words(Caption caption) {
  std::string references;
  for (const auto& [name, text] : caption.reference)
    references += ", " + called(name, Term::field) + " " + text;
  caption.reference.clear();
  return job_line(caption) + references;
}

}  // namespace

std::vector<double> closed(std::vector<double> values, double turn) {
  if (!values.empty()) values.push_back(values.front() + turn);
  return values;
}

std::vector<double> in_degrees(std::vector<double> radians) {
  for (auto& v : radians) v *= kDegPerRad;
  return radians;
}

std::string print_charts(const std::vector<Chart>& charts, const Caption& caption) {
  const bool loud = caption.verdict.status != "ok";
  std::vector<std::string> verdict;
  for (const auto& line :
       verdict_lines(caption.verdict, {.width = 130, .warnings = 12, .plain = true}))
    for (auto& part : wrapped(line, kFont, kPlot, loud)) verdict.push_back(std::move(part));
  const auto job = wrapped(job_in_words(caption), kJob, kPlot);
  const double head = kVerdictLine * static_cast<double>(verdict.size()) + 8.0;
  double foot = head;
  for (const auto& chart : charts) foot += kHeight + more_title(chart);
  const double height = foot + kLegendLine + kJobLine * static_cast<double>(job.size() - 1);
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + fixed(kWidth, 0) +
                    " " + fixed(height, 0) + "\" width=\"" + fixed(kWidth, 0) + "\" height=\"" +
                    fixed(height, 0) +
                    "\" font-family=\"system-ui, sans-serif\" font-size=\"12\" fill=\"#1d242b\">\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  double top = 0.0;
  for (const auto& line : verdict)
    text(out, kLeft, top += kVerdictLine, line,
         loud ? "fill=\"#b3261e\" font-weight=\"600\"" : "fill=\"#56626e\"");
  top = head;
  for (const auto& chart : charts) {
    top += more_title(chart);
    plot(out, chart, top);
    top += kHeight;
  }
  for (std::size_t i = 0; i < job.size(); ++i)
    text(out, kLeft, foot + 10.0 + kJobLine * static_cast<double>(i), job[i],
         "font-size=\"10\" fill=\"#56626e\"");
  return out + "</svg>\n";
}

}  // namespace tubecut::api
