#include "api/formats/drawing/sheet.hpp"

#include <algorithm>

#include "api/api.hpp"
#include "api/formats/text.hpp"
#include "api/verdict.hpp"
#include "api/wire/words.hpp"

namespace tubecut::api {
namespace {

constexpr double kLine = 4.4, kVerdictLine = 3.3, kPad = 2.0;
constexpr Stroke kFrame{.width = 0.5};
constexpr Stroke kRule{.color = "#7a8794", .width = 0.18};

}  // namespace

Sheet::Sheet(const std::string& title, const SheetFacts& facts, const Caption& caption)
    : canvas_(kWidth, kHeight) {
  SheetFacts job;
  for (const auto& [name, value] : caption.reference)
    job.emplace_back(called(name, Term::field), value);
  job.emplace_back("engine", "tubecut " + std::string(version()));
  job.emplace_back("input", caption.input_sha256.substr(0, 32));
  job.emplace_back("result", caption.result_sha256.substr(0, 32));
  draw_block(title, facts, job);
  draw_verdict(caption);
}

void Sheet::draw_block(const std::string& title, const SheetFacts& facts, const SheetFacts& job) {
  constexpr double kText = 2.6, kAll = kWidth - 2.0 * kBorder, kHalf = 0.5 * kAll;
  std::vector<std::string> wide;  // lines that are too long for a half
  const auto within = [&](const SheetFacts& rows) {
    std::vector<std::string> out;
    for (const auto& [name, value] : rows) {
      auto line = name + ": " + value;
      if (text_width(line, kLeastText) <= kHalf - 2.0 * kPad)
        out.push_back(std::move(line));
      else
        for (auto& part : wrapped(line, kLeastText, kAll - 2.0 * kPad))
          wide.push_back(std::move(part));
    }
    return out;
  };
  const auto left = within(facts), right = within(job);
  const auto lines = static_cast<double>(std::max(left.size(), right.size()));
  const double below = kBorder + kLine * static_cast<double>(wide.size());
  low_ = below + kLine * (lines + 2.0) + kPad;
  canvas_.rectangle({kBorder, kBorder}, {kWidth - kBorder, kHeight - kBorder}, kFrame);
  canvas_.line({kBorder, low_}, {kWidth - kBorder, low_}, kFrame);
  canvas_.line({kBorder + kHalf, below}, {kBorder + kHalf, low_}, kRule);
  const auto column = [&](double x, std::string_view head, const std::vector<std::string>& rows) {
    double y = low_ - kLine;
    canvas_.label({x, y}, head, {.height = 3.6, .bold = true}, kHalf - 2.0 * kPad);
    for (const auto& line : rows)
      canvas_.label({x, y -= kLine}, line, {.height = kText}, kHalf - 2.0 * kPad);
  };
  column(kBorder + kPad, title, left);
  column(kBorder + kHalf + kPad, "Job", right);
  double y = below + 0.3 * kLine;
  if (!wide.empty()) canvas_.line({kBorder, below}, {kWidth - kBorder, below}, kRule);
  for (const auto& line : wide)
    canvas_.label({kBorder + kPad, y -= kLine}, line, {.height = kText}, kAll - 2.0 * kPad);
}

void Sheet::draw_verdict(const Caption& caption) {
  const auto l = verdict_lettering(caption, 2.3);
  high_ = kHeight - kBorder;
  for (const auto& line :
       verdict_lines(caption.verdict, {.width = 120, .warnings = 5, .plain = true}))
    for (const auto& part : wrapped(line, l.height, kWidth - 2.0 * (kBorder + kPad), l.bold))
      canvas_.text({kBorder + kPad, high_ -= kVerdictLine}, part, l);
  high_ -= kPad;
  canvas_.line({kBorder, high_}, {kWidth - kBorder, high_}, kRule);
}

Lettering verdict_lettering(const Caption& caption, double height) {
  if (caption.verdict.status == "ok") return {.height = height};
  return {.height = height, .bold = true, .color = "#b3261e"};
}

Cell cell(const Sheet& sheet, int columns, int rows, int index) {
  const auto low = sheet.low(), high = sheet.high();
  const double w = (high.x - low.x) / columns, h = (high.y - low.y) / rows;
  const int column = index % columns, row = index / columns;
  return {{low.x + w * column, high.y - h * (row + 1)},
          {low.x + w * (column + 1), high.y - h * row}};
}

DrawingScale drawing_scale(double size, double room) {
  for (const double up : {50.0, 20.0, 10.0, 5.0, 2.0, 1.0})
    if (size * up <= room) return {up, fixed(up, 0) + ":1"};
  double decade = 1.0;
  while (true) {
    for (const double down : {2.0, 5.0, 10.0})
      if (size <= room * down * decade || decade > 1e9)
        return {1.0 / (down * decade), "1:" + fixed(down * decade, 0)};
    decade *= 10.0;
  }
}

double draw_table(Canvas& canvas, DrawingPoint at, const std::vector<double>& widths,
                  const std::vector<std::vector<std::string>>& rows) {
  double width = 0.0, y = at.y;
  for (const double w : widths) width += w;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    double x = at.x;
    y -= kLine;
    for (std::size_t k = 0; k < rows[r].size() && k < widths.size(); ++k) {
      canvas.text({x + widths[k] - 1.0, y + 1.2}, rows[r][k],
                  {.height = 2.6, .anchor = Anchor::end, .bold = r == 0});
      x += widths[k];
    }
    canvas.line({at.x, y}, {at.x + width, y}, kRule);
  }
  return y;
}

}  // namespace tubecut::api
