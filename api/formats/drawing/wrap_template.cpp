#include "api/formats/drawing/wrap_template.hpp"

#include <algorithm>

#include "api/formats/drawing/sheet.hpp"
#include "api/formats/drawing/template_drawing.hpp"
#include "api/formats/drawing/template_labels.hpp"
#include "api/formats/drawing/tiles.hpp"
#include "api/formats/numbers.hpp"
#include "api/verdict.hpp"
#include "api/wire/json.hpp"
#include "api/wire/words.hpp"

namespace tubecut::api {
namespace {

constexpr double kMargin = 12.0, kRuler = 100.0, kRulerRoom = 14.0;
constexpr double kLeastWidth = 190.0;  // of the sheet, so that the header fits
constexpr double kLine = 4.6;          // from one header line to the next

std::string way_up(const Development& d) {
  if (!d.around()) return "up: +z along the tube, kept outside the holes";
  return d.whole ? "up: the finish, kept between the cuts" : "up: the kept side";
}

/// The references come last.
std::vector<std::string> header(const Development& d, const TemplateField& field,
                                const Caption& c) {
  std::vector<std::string> lines{
      "Tube " + tube_size(d) + ", circumference " + mm(kTwoPi * d.outer_radius) +
          ", scale 1:1, wrap round the outside",
      way_up(d) + "; " +
          (c.options.mirror ? "MIRRORED: print side towards the tube" : "print side out"),
      "blue: outer edge; green dashed: inner edge, " +
          std::string(d.section ? "straight through the wall" : "at its phi") +
          "; red: torch line on the outer wall",
      "datum z = " + mm(field.z_datum) + " from " +
          (d.whole ? "the start's long point" : "the frame's origin"),
      job_line({.reference = {}, .input_sha256 = c.input_sha256, .result_sha256 = {}, .view = {}})};
  for (const auto& [name, text] : c.reference)
    lines.push_back(called(name, Term::field) + ": " + text);
  return lines;
}

std::string part_of(const Development& d, const Caption& c) {
  for (const auto& [name, text] : c.reference)
    if (name == "part") return text;
  if (!d.name.empty() || !d.around()) return d.name;
  const auto* target = c.request != nullptr ? c.request->find("target") : nullptr;
  const auto* id = target != nullptr ? target->find("id") : nullptr;
  const auto* text = id != nullptr ? id->as<std::string>() : nullptr;
  return text != nullptr ? *text : std::string{};
}

/// Returns "N-12: hole for B2": the subject of the sheet.
std::string subject(const Development& d, const Caption& c) {
  auto out = part_of(d, c);
  if (!d.around())
    for (const auto& cut : d.cuts)
      out += (out.empty() ? "" : &cut == &d.cuts.front() ? ": " : ", ") + cut.label;
  return out;
}

/// A line of the head, on as many lines as it takes.
struct HeadLine {
  std::string text;
  Lettering lettering;
};

std::vector<HeadLine> head_lines(const Development& d, const TemplateField& field, const Caption& c,
                                 double room) {
  std::vector<HeadLine> out;
  const auto add = [&](const std::string& line, const Lettering& l) {
    const auto small = fitted(line, l, room);
    for (auto& text : wrapped(line, small.height, room, l.bold))
      out.push_back({std::move(text), small});
  };
  for (const auto& line : verdict_lines(c.verdict, {.warnings = 12, .plain = true}))
    add(line, verdict_lettering(c, 2.8));
  for (const auto& line : header(d, field, c)) add(line, {.height = 2.8});
  return out;
}

Canvas one_sheet(const Development& d, const TemplateField& field, const TemplateDrawing& drawing,
                 const TemplateLabels& labels, const Caption& c) {
  const double width = std::max(kLeastWidth, field.width() + 2.0 * kMargin + kRulerRoom);
  const double room = width - 2.0 * kMargin;
  const auto lines = head_lines(d, field, c, room);
  const DrawingPoint origin{kMargin, kMargin + kRulerRoom};
  Canvas sheet(width, 2.0 * kMargin + kRulerRoom + std::max(field.height(), kRuler) + kScaleRoom +
                          kLine * (static_cast<double>(lines.size()) + 1.0));
  sheet.place(drawing.all, origin, {}, {{0.0, 0.0}, {sheet.width(), sheet.height()}});
  double y = sheet.height() - kMargin;
  const auto of = subject(d, c);
  sheet.label({kMargin, y}, of.empty() ? "Wrap template" : "Wrap template, " + of,
              {.height = 4.2, .bold = true}, room);
  for (const auto& line : lines) sheet.text({kMargin, y -= kLine}, line.text, line.lettering);
  labels.draw(sheet, {{0.0, 0.0}, {field.width(), field.height()}}, origin);
  draw_ruler(sheet, {kMargin, kMargin + 2.0}, kRuler, false, "ruler-x");
  draw_ruler(sheet, {kMargin + field.width() + 9.0, kMargin + kRulerRoom}, kRuler, true, "ruler-y");
  return sheet;
}

TileWords tile_words(const Development& d, const TemplateField& field, const Caption& c) {
  const auto of = subject(d, c);
  TileWords out{.title = of.empty() ? "Wrap template" : of,
                .lines = {"verdict: " + in_plain_words(verdict_in_short(c.verdict))},
                .x = c.options.mirror ? field.x_to + field.tab : field.x_from,
                .z = field.z_from,
                .mirrored = c.options.mirror};
  std::string references;  // on lines that they share
  for (const auto& [name, text] : c.reference)
    references += (references.empty() ? "" : "; ") + called(name, Term::field) + ": " + text;
  auto all = header(d, field, c);
  all.resize(all.size() - c.reference.size());
  out.lines.insert(out.lines.end(), all.begin(), all.end());
  if (!references.empty()) out.lines.push_back(std::move(references));
  return out;
}

}  // namespace

void refuse_paper(const Caption& caption) {
  if (caption.options.paper != Paper::sheet) throw UnfitOption{"paper", "goes with view=template"};
}

std::vector<Canvas> wrap_template(const Development& development, const Caption& caption) {
  const auto field = template_field(development, caption);
  const auto drawing = draw_template(development, field, caption);
  const TemplateLabels labels(development, field, caption, part_of(development, caption));
  if (caption.options.paper == Paper::sheet)
    return {one_sheet(development, field, drawing, labels, caption)};
  return tiles(drawing, labels, caption.options.paper, tile_words(development, field, caption));
}

}  // namespace tubecut::api
