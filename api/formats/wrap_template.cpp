#include "api/formats/wrap_template.hpp"

#include <algorithm>

#include "api/formats/numbers.hpp"
#include "api/formats/sheet.hpp"
#include "api/formats/template_drawing.hpp"
#include "api/formats/tiles.hpp"
#include "api/verdict.hpp"
#include "api/words.hpp"

namespace tubecut::api {
namespace {

constexpr double kMargin = 12.0, kRuler = 100.0, kRulerRoom = 14.0;
constexpr double kLeastWidth = 190.0;  // of the sheet, so that the header fits
constexpr double kLine = 4.6;          // from one header line to the next

std::string way_up(const Development& d) {
  if (!d.around()) return "z upwards";
  return d.whole ? "start below, finish above, kept between" : "kept side up";
}

std::vector<std::string> header(const Development& d, const TemplateField& field,
                                const Caption& c) {
  std::vector<std::string> lines{
      "Tube " + number(2.0 * d.outer_radius, Unit::mm) + " x " + mm(d.wall) + ", " +
          (d.around() ? "circumference " : "full circumference ") + mm(kTwoPi * d.outer_radius) +
          "; 1:1, wrap round the outside, " + way_up(d),
      c.options.mirror ? "MIRRORED: print side towards the tube" : "print side out",
      "blue: outer edge; green dashed: inner edge, at its phi; red: torch line on the outer wall",
      "datum z = " + mm(field.z_datum) + " from " +
          (d.whole ? "the start's long point" : "the frame's origin")};
  for (const auto& [name, text] : c.reference)
    lines.push_back(called(name, Term::field) + ": " + text);
  lines.push_back(
      job_line({.reference = {}, .input_sha256 = c.input_sha256, .result_sha256 = {}, .view = {}}));
  return lines;
}

std::string part_of(const Development& d, const Caption& c) {
  for (const auto& [name, text] : c.reference)
    if (name == "part") return text;
  return d.name;
}

/// "N-12: hole for B2": of what the sheet is.
std::string subject(const Development& d, const Caption& c) {
  auto out = part_of(d, c);
  if (!d.around())
    for (const auto& cut : d.cuts)
      out += (out.empty() ? "" : &cut == &d.cuts.front() ? ": " : ", ") + cut.label;
  return out;
}

void mark_part(Canvas& sheet, const Development& d, const TemplateField& field, const Caption& c,
               DrawingPoint corner) {
  const double room = field.x_to - field.x_from - 6.0;
  if (!d.around() || room < 54.0) return;
  const auto part = part_of(d, c);
  const auto mark = part.empty() ? std::string("KEEP") : part + "  KEEP";
  sheet.text(corner, mark, fitted(mark, {.height = 4.0, .bold = true}, room));
}

Canvas one_sheet(const Development& d, const TemplateField& field, const TemplateDrawing& drawing,
                 const Caption& c) {
  const auto lines = header(d, field, c);
  const auto verdict = verdict_lines(c.verdict, {.warnings = 12, .plain = true});
  Canvas sheet(std::max(kLeastWidth, field.width() + 2.0 * kMargin + kRulerRoom),
               2.0 * kMargin + kRulerRoom + std::max(field.height(), kRuler) + kScaleRoom +
                   kLine * (static_cast<double>(lines.size() + verdict.size()) + 1.0));
  sheet.place(drawing.all, {kMargin, kMargin + kRulerRoom}, {}, c.stop);
  double y = sheet.height() - kMargin;
  const double room = sheet.width() - 2.0 * kMargin;
  const auto of = d.around() && !d.whole ? std::string{} : subject(d, c);
  const auto title = of.empty() ? std::string("Wrap template") : "Wrap template, " + of;
  sheet.text({kMargin, y}, title, fitted(title, {.height = 4.2, .bold = true}, room));
  for (const auto& line : verdict)
    sheet.text({kMargin, y -= kLine}, line, fitted(line, verdict_lettering(c, 2.8), room));
  for (const auto& line : lines)
    sheet.text({kMargin, y -= kLine}, line, fitted(line, {.height = 2.8}, room));
  const double left = c.options.mirror ? field.tab : 0.0;
  mark_part(sheet, d, field, c,
            {kMargin + left + 3.0, kMargin + kRulerRoom + field.height() - 5.5});
  draw_ruler(sheet, {kMargin, kMargin + 2.0}, kRuler, false, "ruler-x");
  draw_ruler(sheet, {kMargin + field.width() + 9.0, kMargin + kRulerRoom}, kRuler, true, "ruler-y");
  return sheet;
}

TileWords tile_words(const Development& d, const TemplateField& field, const Caption& c) {
  const auto of = subject(d, c);
  TileWords out{.title = of.empty() ? "Wrap template" : of,
                .lines = {verdict_in_short(c.verdict)},
                .x = c.options.mirror ? field.x_to + field.tab : field.x_from,
                .z = field.z_from,
                .mirrored = c.options.mirror};
  out.lines.front() = "verdict: " + in_plain_words(out.lines.front());
  for (auto& line : header(d, field, c)) out.lines.push_back(std::move(line));
  constexpr std::size_t kFirst = 5;  // the rest are references, which have a line of their own
  std::string references;
  for (std::size_t i = kFirst; i < out.lines.size(); ++i)
    references += (references.empty() ? "" : "; ") + out.lines[i];
  out.lines.resize(kFirst);
  out.lines.push_back(std::move(references));
  return out;
}

}  // namespace

void refuse_paper(const Caption& caption) {
  if (caption.options.paper != Paper::sheet) throw UnfitOption{"paper", "goes with view=template"};
}

std::vector<Canvas> wrap_template(const Development& development, const Caption& caption) {
  const auto field = template_field(development);
  const auto drawing = draw_template(development, field, caption);
  if (caption.options.paper == Paper::sheet)
    return {one_sheet(development, field, drawing, caption)};
  return tiles(drawing.all, drawing.cuts, caption.options.paper,
               tile_words(development, field, caption), caption.stop);
}

}  // namespace tubecut::api
