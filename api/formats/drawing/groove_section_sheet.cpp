#include "api/formats/drawing/groove_section_sheet.hpp"

#include <algorithm>
#include <cmath>

#include "api/formats/drawing/sheet.hpp"
#include "api/formats/numbers.hpp"
#include "api/stop.hpp"

namespace tubecut::api {
namespace {

constexpr int kSections = 8, kColumns = 4, kRows = 3;  // the lowest row holds the table
constexpr int kChordPoints = 60;
constexpr double kTable = 52.0;  // mm of paper, below a single section
constexpr Stroke kBranch{.color = "#38424d", .width = 0.3, .fill = "#dfe4e9"};
constexpr Stroke kChordStyle{.color = "#38424d", .width = 0.3, .fill = "#c9d2da"};
constexpr Stroke kFiller{.color = "#c2571a", .width = 0.35, .fill = "#f3d9c5"};
constexpr Stroke kLeader{.color = "#56626e", .width = 0.15};

using groove::GrooveSection;

/// A section's outlines, x from the branch axis and y along it, mm.
struct Outlines {
  std::vector<DrawingPoint> branch, chord, filler;
  DrawingPoint low, high;
};

DrawingPoint point(const Eigen::Vector2d& p) { return {p.x(), p.y()}; }
/// Returns the position of a point of a curve in its section.
DrawingPoint in_section(const Eigen::Vector3d& p) { return {std::hypot(p.x(), p.y()), p.z()}; }

Outlines outlines(const groove::JointGeometry& joint, const GrooveSection& s) {
  const auto c1 = in_section(s.curves.c1), c2 = in_section(s.curves.c2);
  const auto p1 = point(s.p1), p2 = point(s.p2), p3 = point(s.p3);
  const double margin = 0.6 * joint.weld_width;
  Outlines out{.branch = {},
               .chord = {},
               .filler = {},
               .low = {c1.x - margin, std::min({c1.y, p1.y, p2.y}) - margin},
               .high = {p2.x + margin, std::max(p3.y, p2.y) + margin}};
  out.branch = {{c1.x, out.high.y}, c1, c2, p1, p3, {p3.x, out.high.y}};
  const auto dir = groove::direction(s.omega);
  std::vector<DrawingPoint> between;  // P1 to P2 along the chord
  for (int k = 0; k <= kChordPoints; ++k) {
    const double x = p1.x + (out.high.x - p1.x) * k / kChordPoints;
    const auto y = groove::chord_height(joint, dir, x);
    if (!y) break;
    out.chord.push_back({x, *y});
    if (x > p1.x && x < p2.x) between.push_back({x, *y});
  }
  for (const auto& p : out.chord) out.low.y = std::min(out.low.y, p.y);
  // Nearer to the axis the chord is open, so it ends at the root face, whose height differs.
  out.chord.push_back({out.chord.back().x, out.low.y});
  out.chord.push_back({p1.x, out.low.y});
  out.filler = {p1, p3, p2};
  out.filler.insert(out.filler.end(), between.rbegin(), between.rend());
  return out;
}

/// From a section to the paper.
struct Placing {
  double scale = 1.0;
  DrawingPoint by;

  DrawingPoint operator()(const DrawingPoint& p) const {
    return {by.x + scale * p.x, by.y + scale * p.y};
  }
  std::vector<DrawingPoint> operator()(std::vector<DrawingPoint> points) const {
    for (auto& p : points) p = (*this)(p);
    return points;
  }
};

Placing placing(const Cell& room, const Outlines& o, double scale) {
  return {scale,
          {(room.low.x + room.high.x - scale * (o.low.x + o.high.x)) / 2.0,
           (room.low.y + room.high.y - scale * (o.low.y + o.high.y)) / 2.0}};
}

void draw(Canvas& canvas, const Outlines& o, const Placing& at) {
  canvas.polyline(at(o.chord), kChordStyle, {}, true);
  canvas.polyline(at(o.branch), kBranch, {}, true);
  canvas.polyline(at(o.filler), kFiller, {}, true);
}

DrawingScale usual_scale(const Cell& room, const std::vector<Outlines>& all, double beside,
                         double above) {
  double wide = 1e-9, tall = 1e-9;
  for (const auto& o : all) {
    wide = std::max(wide, o.high.x - o.low.x);
    tall = std::max(tall, o.high.y - o.low.y);
  }
  const auto across = drawing_scale(wide, room.high.x - room.low.x - beside);
  const auto up = drawing_scale(tall, room.high.y - room.low.y - above);
  return up.factor < across.factor ? up : across;
}

std::string name_of(const GrooveSection& s) { return "omega " + degrees(s.omega.rad()); }

std::vector<std::string> row_of(const GrooveSection& s) {
  return {name_of(s), number(s.height, Unit::mm), degrees(s.groove_angle.rad()), number(s.areas.d),
          degrees(s.ruling.twist.rad())};
}

SheetFacts facts_of(const groove::GrooveSpec& spec) {
  const auto pipe = [](const groove::Pipe& p) {
    return number(p.outer_diameter, Unit::mm) + " x " + mm(p.wall);
  };
  return {{"branch", pipe(spec.branch)},
          {"chord", pipe(spec.chord)},
          {"between the axes",
           degrees(spec.inclination.rad()) + ", off centre by " + mm(spec.eccentricity)},
          {"root face", number(spec.root_face.width, Unit::mm) + " wide, " +
                            mm(spec.root_face.height) + " high"}};
}

void name_points(Canvas& canvas, const GrooveSection& s, const Placing& at) {
  constexpr double kOff = 7.0;  // mm of paper
  const auto name = [&](const Eigen::Vector2d& p, double x, double y, std::string_view what) {
    const auto from = at(point(p));
    const DrawingPoint to{from.x + kOff * x, from.y + kOff * y};
    canvas.line(from, to, kLeader);
    canvas.text({to.x + (x < 0.0 ? -0.8 : 0.8), to.y}, what,
                {.height = 3.0, .anchor = x < 0.0 ? Anchor::end : Anchor::start});
  };
  name(s.p1, -2.4, -1.2, "P1: root, " + number(s.p1.x(), Unit::mm) + ", " + mm(s.p1.y()));
  name(s.p2, 1.0, 0.6, "P2: " + number(s.p2.x(), Unit::mm) + ", " + mm(s.p2.y()));
  name(s.p3, 1.0, 1.0, "P3: " + number(s.p3.x(), Unit::mm) + ", " + mm(s.p3.y()));
}

Canvas one_section(const groove::GrooveSpec& spec, const groove::JointGeometry& joint,
                   const GrooveSection& s, const Caption& caption) {
  constexpr double kNames = 90.0, kAbove = 30.0;  // mm of paper, next to and above the section
  const std::string title = "Section of the groove at " + name_of(s);
  const auto o = outlines(joint, s);
  auto facts = facts_of(spec);
  const auto room_of = [&](const Sheet& sheet) {
    auto room = cell(sheet, 1, 1, 0);
    room.low.y += kTable;
    return room;
  };
  facts.emplace_back("up", "along the branch axis, which is to the left");
  facts.emplace_back("scale", "");
  const Sheet blank(title, facts, caption);
  const auto scale = usual_scale(room_of(blank), {o}, kNames, kAbove);
  facts.back().second = scale.name;
  Sheet sheet(title, facts, caption);
  const auto room = room_of(sheet);
  const auto at = placing(room, o, scale.factor);
  draw(sheet.canvas(), o, at);
  name_points(sheet.canvas(), s, at);
  draw_table(sheet.canvas(), {room.low.x + 4.0, room.low.y}, {50.0, 50.0},
             {{"of the section", ""},
              {"height of the groove", mm(s.height)},
              {"groove angle", degrees(s.groove_angle.rad())},
              {"filler area D", measure(s.areas.d, Unit::mm2)},
              {"areas A, B, C, E", number(s.areas.a) + ", " + number(s.areas.b) + ", " +
                                       number(s.areas.c) + ", " + number(s.areas.e)},
              {"phi in the bevel table", degrees(s.phi.rad())},
              {"twist of the ruling", degrees(s.ruling.twist.rad())}});
  return std::move(sheet.canvas());
}

/// Of those reported the nearest to 0, 45, 90 ... deg, each once.
std::vector<const GrooveSection*> spread(const groove::Groove& g) {
  std::vector<const GrooveSection*> out;
  const auto n = g.sections.size();
  for (std::size_t k = 0; k < kSections; ++k) {
    const auto* s = &g.sections[(k * n + kSections / 2) / kSections % n];
    if (std::ranges::find(out, s) == out.end()) out.push_back(s);
  }
  return out;
}

Canvas all_round(const groove::GrooveSpec& spec, const groove::JointGeometry& joint,
                 const groove::Groove& g, const Caption& caption) {
  const std::string title = "Sections of the groove";
  const auto shown = spread(g);
  std::vector<Outlines> drawn;
  for (const auto* s : shown) drawn.push_back(outlines(joint, *s));
  auto facts = facts_of(spec);
  facts.emplace_back(
      "filler area",
      measure(g.area, Unit::mm2) + " in every section" +
          (spec.area_in == groove::AreaIn::normal ? " square to the seam" : " through the axis"));
  facts.emplace_back("scale", "");
  const Sheet blank(title, facts, caption);
  const auto scale = usual_scale(cell(blank, kColumns, kRows, 0), drawn, 4.0, 14.0);
  facts.back().second = scale.name;
  Sheet sheet(title, facts, caption);
  std::vector<std::vector<std::string>> rows{
      {"section", "height, mm", "groove angle", "filler, mm²", "twist"}};
  for (std::size_t i = 0; i < shown.size(); ++i) {
    ask();
    const auto room = cell(sheet, kColumns, kRows, static_cast<int>(i));
    draw(sheet.canvas(), drawn[i], placing(room, drawn[i], scale.factor));
    sheet.canvas().text({(room.low.x + room.high.x) / 2.0, room.high.y - 5.0}, name_of(*shown[i]),
                        {.height = 2.8, .anchor = Anchor::middle, .bold = true});
    rows.push_back(row_of(*shown[i]));
  }
  const auto below = cell(sheet, 1, kRows, kRows - 1);
  draw_table(sheet.canvas(), {below.low.x + 4.0, below.high.y - 2.0},
             {35.0, 30.0, 30.0, 30.0, 30.0}, rows);
  return std::move(sheet.canvas());
}

}  // namespace

Canvas groove_section_sheet(const groove::GrooveSpec& spec, const groove::Groove& groove,
                            const Caption& caption) {
  const auto joint = groove::joint_geometry(spec);
  ask();
  if (!caption.options.omega) return all_round(spec, *joint, groove, caption);
  const auto s = groove::section_at(spec, Angle::deg(*caption.options.omega));
  ask();
  if (!s) throw UnfitOption{"omega_deg", "the groove has no section there"};
  return one_section(spec, *joint, *s, caption);
}

}  // namespace tubecut::api
