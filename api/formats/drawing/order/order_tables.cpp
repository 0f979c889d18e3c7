#include "api/formats/drawing/order/order_tables.hpp"

#include <algorithm>
#include <set>

#include "api/formats/drawing/order/order_blocks.hpp"
#include "api/formats/drawing/order/order_cutouts.hpp"
#include "api/formats/drawing/part_edges.hpp"
#include "api/formats/drawing/part_marks.hpp"
#include "api/formats/numbers.hpp"
#include "api/wire/part_names.hpp"
#include "api/wire/words.hpp"
#include "core/part/notch.hpp"

namespace tubecut::api {
namespace {

constexpr Stroke kBox{.color = "#566370", .width = 0.25};
constexpr Lettering kSmall{.height = 2.3};
constexpr Lettering kGrey{.height = 2.2, .color = "#566370"};
constexpr std::string_view kGreen = "#1d7a46";

/// How many of the quantity each member is.
std::string each_of(const Caption& caption) {
  for (const auto& [name, text] : caption.reference)
    if (const auto frames = name == "quantity" ? std::stoull(text) / caption.members.size() : 1;
        frames > 1)
      return ": one piece each, for each of " + std::to_string(frames) + " frames";
  return ": one piece each";
}

}  // namespace

void draw_members(OrderSheets& sheets, const Caption& caption) {
  constexpr double kRow = 3.3, kMostLines = 3.0;
  const auto& all = caption.members;
  if (all.empty()) return;
  std::string text = all.size() == 1 ? "For member " : "For members ";
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto rest = " and " + std::to_string(all.size() - i) + " more, see the cut list";
    const auto next = (i == 0 ? "" : ", ") + all[i];
    const double room = (kMostLines - 0.7) * OrderSheets::kWide;  // lines break at blanks
    if (i > 0 && text_width(text + next + rest, kSmall.height) > room) {
      text += rest;
      break;
    }
    text += next;
  }
  const auto lines = wrapped(text + each_of(caption), kSmall.height, OrderSheets::kWide);
  double y = sheets.take(kRow * static_cast<double>(lines.size()) + 1.4);
  for (const auto& line : lines)
    sheets.canvas().text({OrderSheets::kLeft, y -= kRow}, line, kSmall);
}

void draw_holes(OrderSheets& sheets, const part::PartSpec& spec, const part::Part& part) {
  if (part.holes.empty()) return;
  constexpr double kRow = 6.4;
  draw_head(sheets, "Holes: outer edge, in mm",
            {{0.0, "hole"},
             {10.0, "for"},
             {38.0, "from the start's long point"},
             {74.0, "round from the datum line"},
             {108.0, "size along x round"},
             {136.0, "B"},
             {162.0, "measured"}},
            2.0 * kRow);
  for (std::size_t i = 0; i < part.holes.size(); ++i) {
    const auto& placed = part.holes[i];
    const auto range = surface_range(placed.hole);
    const double ro = spec.target.outer_radius, top = sheets.take(kRow), y = top - 4.2;
    auto& canvas = sheets.canvas();
    const auto put = [&](double x, const std::string& text, double room, bool bold = false) {
      canvas.label({OrderSheets::kLeft + x, y}, text, {.height = 2.4, .bold = bold}, room);
    };
    const auto between = [](double a, double b) {
      return number(a, Unit::mm) + " to " + number(b, Unit::mm);
    };
    const double middle = 0.5 * (range.phi_from + range.phi_to);
    const double turn = turned_from(0.0, middle) - middle;
    const auto b = std::ranges::minmax(placed.hole.b);
    const auto& name = spec.holes[placed.asked].name;
    put(0.0, hole_tag(i), 9.0, true);
    put(10.0,
        (name.empty() ? "branch " + std::to_string(placed.asked + 1) : name) +
            (placed.hole.far ? ", far side" : ""),
        27.0);
    put(38.0, between(range.z_from, range.z_to), 37.0);
    put(74.0, between(ro * (range.phi_from + turn), ro * (range.phi_to + turn)), 33.0);
    put(108.0,
        number(range.z_to - range.z_from, Unit::mm) + " x " +
            number(ro * (range.phi_to - range.phi_from), Unit::mm),
        27.0);
    put(136.0, degrees(b.min) + " to " + degrees(b.max), 25.0);
    draw_box(canvas, top, kRow);
    draw_row_line(canvas, top - kRow);
  }
}

void draw_notches(OrderSheets& sheets, const part::PartSpec& spec, const part::Part& part,
                  const Caption& caption) {
  const auto all = part::notches(spec, part);
  if (all.empty()) return;
  constexpr double kRow = 4.4;
  draw_head(sheets, "Settings of a tube notcher, in mm",
            {{0.0, "end"},
             {44.0, "hole saw"},
             {64.0, "angle from perpendicular"},
             {100.0, "offset"},
             {138.0, "depth"},
             {156.0, "rotation"}},
            kRow * static_cast<double>(all.size()));
  for (const auto& notch : all) {
    const double y = sheets.take(kRow) - 3.2;
    const auto put = [&](double x, const std::string& text, double room) {
      sheets.canvas().label({OrderSheets::kLeft + x, y}, text, {.height = 2.4}, room);
    };
    const auto& names = notch.finish ? caption.finish_partners : caption.partners;
    put(0.0,
        std::string(joint::end_name(notch.finish)) + " by " +
            (notch.partner < names.size() ? names[notch.partner]
                                          : std::to_string(notch.partner + 1)),
        43.0);
    put(44.0, number(notch.saw_diameter, Unit::mm), 19.0);
    put(64.0, degrees(notch.angle), 35.0);
    put(100.0,
        number(notch.offset, Unit::mm) +
            (notch.offset < 0.005 ? "" : " towards phi " + degrees(notch.offset_towards)),
        37.0);
    put(138.0, number(notch.depth, Unit::mm), 17.0);
    put(156.0, degrees(notch.rotation), 26.0);
  }
  constexpr std::string_view kNote =
      "Depth: along the tube from the end's long point to the throat, outside. Rotation: of the "
      "tube "
      "from the first notch on, the way phi grows.";
  for (const auto& line : wrapped(kNote, kGrey.height, OrderSheets::kWide))
    sheets.canvas().text({OrderSheets::kLeft, sheets.take(3.2) - 2.8}, line, kGrey);
}

namespace {

std::string said(part::Mistake mistake) {
  switch (mistake) {
    case part::Mistake::diameter:
      return "another diameter";
    case part::Mistake::wall:
      return "another wall";
    case part::Mistake::clocking:
      return "an end turned";
    case part::Mistake::mirror:
      return "an end mirrored";
    case part::Mistake::b_sign:
      return "B the wrong way";
    case part::Mistake::pivot_length:
      return "pivot length off";
    case part::Mistake::height:
      return "another height";
    case part::Mistake::width:
      return "another width";
    case part::Mistake::swapped:
      return "on the wrong side";
    case part::Mistake::quarter_turn:
      return "an end turned by 90°";
    case part::Mistake::corner:
      return "another corner radius";
  }
  return {};
}

std::string joined(const std::vector<part::Mistake>& mistakes) {
  std::string out;
  for (const auto one : mistakes) out += (out.empty() ? "" : ", ") + said(one);
  return out.empty() ? "no mistake changes it by more than 1 mm" : out;
}

}  // namespace

void draw_checks(OrderSheets& sheets, const std::vector<part::CheckDimension>& dimensions) {
  constexpr double kRow = 7.6, kMore = 3.0, kWithin = 158.0, kMistakes = 63.0;
  draw_head(sheets, "Check dimensions, in mm",
            {{0.0, "dimension, and its datum"},
             {88.0, "by"},
             {100.0, "changes with"},
             {162.0, "measured"}},
            kRow * static_cast<double>(dimensions.size()) + 3.0 * kMore);
  for (const auto& d : dimensions) {
    const auto from = wrapped(in_plain_words(d.measured_from), kGrey.height, kWithin);
    const auto mistakes = joined(d.changes_with);
    // Many of them take a line of their own below their column's head.
    const bool many = text_width(mistakes, kGrey.height) > kMistakes;
    const double below = kMore * ((many ? 1.0 : 0.0) + static_cast<double>(from.size() - 1));
    const double tall = kRow + below, top = sheets.take(tall);
    auto& canvas = sheets.canvas();
    canvas.label({OrderSheets::kLeft, top - 3.3}, called(d.name, Term::value),
                 {.height = 2.5, .bold = true}, 66.0);
    canvas.text({OrderSheets::kLeft + 85.0, top - 3.3}, number(d.value, Unit::mm),
                {.height = 2.8, .anchor = Anchor::end, .bold = true, .color = kGreen});
    canvas.text({OrderSheets::kLeft + 88.0, top - 3.3}, name_of(d.tool), kSmall);
    auto grey = kGrey;
    if (many) grey.anchor = Anchor::end;
    canvas.text({OrderSheets::kLeft + (many ? kWithin : 100.0), top - (many ? 6.3 : 3.3)}, mistakes,
                grey);
    double y = top - (many ? 6.3 + kMore : 6.3);
    for (const auto& line : from) canvas.text({OrderSheets::kLeft, y}, line, kGrey), y -= kMore;
    draw_box(canvas, top, tall);
    draw_row_line(canvas, top - tall);
  }
}

namespace {

std::string words(const part::PartSpec& spec, const part::Part& part, const part::Step& step) {
  const auto from = number(step.z_from, Unit::mm), to = number(step.z_to, Unit::mm);
  const auto range = from == to ? " at " + from : " from " + from + " to " + to;
  switch (step.what) {
    case part::Step::What::mark: {
      const auto& mark = part.marks[step.index];
      const auto what = mark.kind == part::Mark::Kind::datum_line ? "the datum line"
                        : mark.lettering ? text_in_words(*mark.lettering) + ", its base line"
                                         : mark.text;
      return "mark " + what + " at " + degrees(mark.phi) + "," + range;
    }
    case part::Step::What::hole: {
      const auto& name = spec.holes[part.holes[step.index].asked].name;
      return "cut hole " + hole_tag(step.index) + (name.empty() ? "" : ", " + name) + "," + range;
    }
    case part::Step::What::cutout:
      return "cut " + cutout_tag(part.cutouts, step.index) + "," + range;
    case part::Step::What::finish:
      return "cut the finish, scrap towards the free end," + range;
    case part::Step::What::start:
      return "cut the start, scrap towards the clamp," + range;
  }
  return {};
}

}  // namespace

std::vector<std::string> step_texts(const part::PartSpec& spec, const part::Part& part) {
  const auto& all = part.sequence;
  std::vector<std::string> out;
  for (std::size_t i = 0; i < all.size();) {
    if (auto run = cutout_run(all, i, spec.cutouts, part.cutouts)) {
      out.push_back(std::move(run->text));
      i += run->count;
    } else {
      out.push_back(words(spec, part, all[i++]));
    }
  }
  return out;
}

void draw_steps(OrderSheets& sheets, const part::PartSpec& spec, const part::Part& part) {
  constexpr double kRow = 4.4;
  draw_head(sheets, "Sequence, in mm from the start's long point", {}, 3.0 * kRow);
  const auto all = step_texts(spec, part);
  constexpr double kRoom = 0.5 * OrderSheets::kWide - 6.0, kLine = 3.2;
  std::vector<std::vector<std::string>> lines;
  for (std::size_t k = 0; k < all.size(); ++k)
    lines.push_back(wrapped(std::to_string(k + 1) + "  " + all[k], kSmall.height, kRoom));
  for (std::size_t i = 0; i < all.size(); i += 2) {
    const auto after = std::min(i + 2, all.size());
    std::size_t most = 1;
    for (std::size_t k = i; k < after; ++k) most = std::max(most, lines[k].size());
    const double tall = kRow + kLine * static_cast<double>(most - 1);
    const double y = sheets.take(tall) - 3.4;
    for (std::size_t k = i; k < after; ++k) {
      const double x = OrderSheets::kLeft + (k == i ? 0.0 : 0.5 * OrderSheets::kWide);
      sheets.canvas().rectangle({x, y - 0.4}, {x + 2.4, y + 2.0}, kBox);
      for (std::size_t n = 0; n < lines[k].size(); ++n)
        sheets.canvas().text({x + 4.0, y - kLine * static_cast<double>(n)}, lines[k][n], kSmall);
    }
  }
}

}  // namespace tubecut::api
