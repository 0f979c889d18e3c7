#include "api/formats/drawing/order/order_blocks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "api/formats/drawing/part_edges.hpp"
#include "api/formats/numbers.hpp"
#include "api/verdict.hpp"
#include "api/wire/json.hpp"
#include "api/wire/words.hpp"

namespace tubecut::api {
namespace {

constexpr double kLeft = OrderSheets::kLeft, kWide = OrderSheets::kWide;
constexpr Stroke kLine{.color = "#7a8794", .width = 0.18};
constexpr Stroke kBox{.color = "#566370", .width = 0.25};
constexpr Lettering kHead{.height = 3.2, .bold = true};
constexpr Lettering kSmall{.height = 2.3};
constexpr Lettering kGrey{.height = 2.2, .color = "#566370"};

/// A small name over a value; without one a line to write on.
void draw_fact(Canvas& canvas, DrawingPoint at, double width, const Fact& fact) {
  canvas.label({at.x, at.y - 2.4}, fact.name, kGrey, width - 2.0);
  if (fact.value.empty())
    canvas.line({at.x, at.y - 6.2}, {at.x + width - 4.0, at.y - 6.2}, kLine);
  else
    canvas.label({at.x, at.y - 5.6}, fact.value, {.height = 2.7, .bold = true}, width - 2.0);
}

/// Returns the limits that the request accepts, and the distance of its points from the exact
/// curve.
std::string accepted(const Caption& caption) {
  std::string out;
  const auto* request = caption.request;
  const auto* accept = request != nullptr ? request->find("accept") : nullptr;
  if (const auto* limits = accept != nullptr ? accept->as<Json::Object>() : nullptr)
    for (const auto& [name, value] : *limits)
      if (const auto* limit = value.as<double>())
        out += (out.empty() ? "" : "; ") + called(name, Term::field) + " " +
               measure(*limit, unit_named(name));
  return out;
}

}  // namespace

void draw_facts(OrderSheets& sheets, const std::vector<Fact>& facts, std::size_t columns) {
  constexpr double kRow = 7.4;
  const double width = kWide / static_cast<double>(columns);
  struct GridCell {
    std::size_t row, column, span;
  };
  std::vector<GridCell> cells;
  std::size_t row = 0, column = 0;
  for (const auto& fact : facts) {
    const double wide =
        std::max(text_width(fact.value, kLeastText, true), text_width(fact.name, kLeastText)) + 2.0;
    const auto span = std::min(columns, static_cast<std::size_t>(std::ceil(wide / width)));
    if (column + std::max<std::size_t>(1, span) > columns) column = 0, ++row;
    cells.push_back({row, column, std::max<std::size_t>(1, span)});
    column += cells.back().span;
  }
  const double top = sheets.take(kRow * static_cast<double>(row + 1) + 2.0) - 0.6;
  for (std::size_t i = 0; i < facts.size(); ++i)
    draw_fact(sheets.canvas(),
              {kLeft + width * static_cast<double>(cells[i].column),
               top - kRow * static_cast<double>(cells[i].row)},
              width * static_cast<double>(cells[i].span), facts[i]);
}

void rule(OrderSheets& sheets) {
  const double y = sheets.take(0.6);
  sheets.canvas().line({OrderSheets::kBorder, y}, {OrderSheets::kWidth - OrderSheets::kBorder, y},
                       kLine);
}

std::vector<Fact> order_facts(const Caption& caption) {
  std::vector<Fact> out;
  for (const auto* name :
       {"order", "drawing", "revision", "customer_id", "material", "heat", "quantity"}) {
    std::string value;
    for (const auto& [key, text] : caption.reference)
      if (key == name) value = text;
    out.push_back({called(name, Term::field), value});
  }
  out.push_back({"machine", ""});
  return out;
}

std::string name_of_part(const std::string& name, const Caption& caption) {
  for (const auto& [key, text] : caption.reference)
    if (key == "part") return text;
  return name.empty() ? "Part" : name;
}

std::string bevel_range(const std::vector<const std::vector<double>*>& cuts,
                        const bevel::TorchRange& torch) {
  double low = 0.0, high = 0.0;
  bool any = false;
  for (const auto* all : cuts)
    for (const double b : *all) {
      low = any ? std::min(low, b) : b;
      high = any ? std::max(high, b) : b;
      any = true;
    }
  const auto range = degrees(low) == degrees(high)
                         ? "Bevel B " + degrees(low) + " throughout"
                         : "Bevel B from " + degrees(low) + " to " + degrees(high);
  return range + "; the torch leans from " + degrees(torch.min.rad()) + " to " +
         degrees(torch.max.rad()) + ". B above 0: the outer edge lies further towards the finish.";
}

void draw_verdict(OrderSheets& sheets, const std::string& bevels, const Caption& caption) {
  constexpr double kRow = 3.3;
  auto loud = kSmall;
  if (caption.verdict.status != "ok")
    loud = {.height = kSmall.height, .bold = true, .color = "#b3261e"};
  std::vector<std::pair<std::string, Lettering>> lines;
  const auto add = [&](const std::string& text, const Lettering& l) {
    for (auto& line : wrapped(text, l.height, kWide, l.bold))
      lines.emplace_back(std::move(line), l);
  };
  for (const auto& line :
       verdict_lines(caption.verdict, {.width = 125, .warnings = 8, .plain = true}))
    add(line, loud);
  add(bevels, kSmall);
  double y = sheets.take(kRow * static_cast<double>(lines.size()) + 2.0) - 0.4;
  for (const auto& [line, l] : lines) sheets.canvas().text({kLeft, y -= kRow}, line, l);
}

/// Draws the legend of the two cuts' colours, two lines of a sheet.
void draw_partners(OrderSheets& sheets, const EndPartners& start, const EndPartners& finish,
                   const Caption& caption) {
  constexpr std::size_t kColumns = 4;
  constexpr double kRow = 4.0;
  std::vector<std::pair<std::string_view, std::string>> all;
  const auto add = [&](const EndPartners& end, const std::vector<std::string>& names,
                       const std::string& which, std::size_t first) {
    if (!end.welded) return all.emplace_back("none", which + ": cut square"), void();
    for (std::size_t i = 0; i < end.count; ++i)
      all.emplace_back(partner_color(first + i),
                       which + " by " + (i < names.size() ? names[i] : std::to_string(i + 1)));
  };
  add(start, caption.partners, "start", 0);
  add(finish, caption.finish_partners, "finish", start.count);
  const std::size_t rows = (all.size() + kColumns - 1) / kColumns;
  const double top = sheets.take(kRow * static_cast<double>(rows) + 2.0), width = kWide / kColumns;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double x = kLeft + width * static_cast<double>(i % kColumns);
    const double y = top - kRow * static_cast<double>(i / kColumns) - 3.0;
    if (all[i].first != "none")
      sheets.canvas().line({x, y + 0.8}, {x + 5.0, y + 0.8}, {.color = all[i].first, .width = 0.9});
    sheets.canvas().label({x + 6.5, y}, all[i].second, kSmall, width - 8.0);
  }
}

void draw_sign_off(OrderSheets& sheets, const joint::Sampling& sampling, const Caption& caption) {
  constexpr double kBoxes = 14.0, kRow = 3.3;
  const auto limits = accepted(caption);
  std::string line = limits.empty() ? "The request states no limits; general tolerance as agreed: "
                                      "................"
                                    : "As the request accepts: " + limits + ".";
  if (sampling.tolerance)
    line += " Drawn within " + mm(sampling.tolerance->value) + " of the exact curve.";
  const auto lines = wrapped(line, kSmall.height, kWide);
  const double tall = 26.7 + kRow * static_cast<double>(lines.size()), top = sheets.take(tall);
  auto& canvas = sheets.canvas();
  canvas.text({kLeft, top - 5.0}, "Tolerances and release", kHead);
  for (std::size_t i = 0; i < lines.size(); ++i)
    canvas.text({kLeft, top - 9.4 - kRow * static_cast<double>(i)}, lines[i], kSmall);
  const double width = kWide / 4.0;
  for (int i = 0; i < 4; ++i) {
    static constexpr std::array<std::string_view, 4> kSigned{"cut by", "measured by", "released by",
                                                             "parts measured"};
    const double x = kLeft + width * i;
    canvas.rectangle({x, top - tall + 3.0}, {x + width, top - tall + 3.0 + kBoxes}, kBox);
    canvas.text({x + 1.5, top - tall + kBoxes}, kSigned[static_cast<std::size_t>(i)], kGrey);
    if (i < 3) canvas.text({x + 0.62 * width, top - tall + kBoxes}, "on", kGrey);
  }
}

void draw_row_line(Canvas& canvas, double y) {
  canvas.line({OrderSheets::kLeft, y}, {OrderSheets::kRight, y}, kLine);
}
void draw_box(Canvas& canvas, double y, double height) {
  canvas.rectangle({OrderSheets::kRight - 22.0, y - height + 0.9}, {OrderSheets::kRight, y - 0.6},
                   kBox);
}

void draw_head(OrderSheets& sheets, const std::string& title,
               const std::vector<HeadColumn>& columns, double with) {
  constexpr double kTall = 10.0;
  sheets.keep_together(kTall + with);
  const double top = sheets.take(kTall);
  auto& canvas = sheets.canvas();
  canvas.text({OrderSheets::kLeft, top - 5.0}, title, kHead);
  for (const auto& column : columns)
    canvas.text({OrderSheets::kLeft + column.at, top - 9.0}, column.head, kGrey);
  draw_row_line(canvas, top - kTall);
}

}  // namespace tubecut::api
