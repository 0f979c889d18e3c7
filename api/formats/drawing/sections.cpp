#include "api/formats/drawing/sections.hpp"

#include <algorithm>
#include <cmath>

#include "api/formats/numbers.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

constexpr int kSectionCount = 8, kColumns = 4, kRows = 3;  // the lowest row holds the table
constexpr Stroke kMetalStyle{.color = "#38424d", .width = 0.3, .fill = "#dfe4e9"};
constexpr Stroke kCutStyle{.color = "#1f5fbf", .width = 0.5};

/// The rows nearest to 0, 45, 90 ... deg of a column of angles.
std::vector<std::size_t> spread(const std::vector<double>& phi) {
  std::vector<std::size_t> out;
  for (int k = 0; k < kSectionCount && !phi.empty(); ++k) {
    const double wanted = phi.front() + kTwoPi * k / kSectionCount;
    std::size_t best = 0;
    for (std::size_t i = 0; i < phi.size(); ++i)
      if (std::abs(phi[i] - wanted) < std::abs(phi[best] - wanted)) best = i;
    if (out.empty() || out.back() != best) out.push_back(best);
  }
  return out;
}

std::string diameter(double radius, double wall) {
  return number(2.0 * radius, Unit::mm) + " x " + mm(wall);
}

/// Shifted so that the lowest point of the cut is at y = 0.
WallSection based(WallSection s) {
  double low = s.cut.front().y;
  for (const auto& p : s.cut) low = std::min(low, p.y);
  for (auto& p : s.cut) p.y -= low;
  return s;
}

void draw_section(Canvas& canvas, const Cell& room, const WallSection& s, double wall, double scale,
                  double height) {
  const double x = room.low.x + (room.high.x - room.low.x - scale * wall) / 2.0;
  const double y = (room.low.y + room.high.y - scale * height) / 2.0 - 8.0;
  const double top = y + scale * height + 10.0;
  std::vector<DrawingPoint> metal, cut;
  for (const auto& p : s.cut) cut.push_back({x + scale * p.x, y + scale * p.y});
  metal = cut;
  metal.push_back({cut.back().x, top});
  metal.push_back({cut.front().x, top});
  canvas.polyline(metal, kMetalStyle, {}, true);
  canvas.polyline(cut, kCutStyle);
  canvas.text({(room.low.x + room.high.x) / 2.0, room.high.y - 5.0}, s.name,
              {.height = 2.8, .anchor = Anchor::middle, .bold = true});
  canvas.text({x - 1.0, top - 3.0}, "bore",
              {.height = 2.2, .anchor = Anchor::end, .color = "#56626e"});
  canvas.text({x + scale * wall + 1.0, top - 3.0}, "outside", {.height = 2.2, .color = "#56626e"});
}

}  // namespace

SectionSet sections_of(const bevel::TableSpec& spec, const bevel::Table& t) {
  const double wall = spec.target.wall;
  SectionSet out{.title = "Sections of the cut end",
                 .wall = wall,
                 .along = "z along the tube, kept side up",
                 .facts = {{"tube", diameter(spec.target.outer_radius, wall)},
                           {"cut length", mm(t.length_total) + " on the root surface"},
                           {"B", t.inward ? "positive inwards, as published"
                                          : "positive: outer edge further into the part"}},
                 .sections = {}};
  for (const auto i : spread(t.phi)) {
    WallSection s{
        .name = "phi " + degrees(t.phi[i]), .cut = {{0.0, t.z_inner[i]}}, .angle = degrees(t.b[i])};
    if (!t.z_face.empty()) s.cut.push_back({spec.root_face, t.z_face[i]});
    s.cut.push_back({wall, t.z_outer[i]});
    out.sections.push_back(std::move(s));
  }
  return out;
}

SectionSet sections_of(const joint::IntersectionSpec& spec, const joint::Intersection& cut) {
  const double wall = spec.target.wall;
  SectionSet out{.title = "Sections of the intersection",
                 .wall = wall,
                 .along = "z along the tube, kept side up",
                 .facts = {{"tube", diameter(spec.target.outer_radius, wall)},
                           {"drawn", "straight from the inner curve to the outer one"}},
                 .sections = {}};
  const joint::Profile *inner = nullptr, *outer = nullptr;
  for (const auto& p : cut.profiles) (p.outer ? outer : inner) = &p;
  const auto& lead = outer != nullptr ? *outer : *inner;
  for (const auto i : spread(lead.phi)) {
    const auto height = [&](const joint::Profile* p) {
      if (p == nullptr) return lead.z[i];
      const auto after = std::ranges::lower_bound(p->phi, lead.phi[i]) - p->phi.begin();
      const auto b = std::min(static_cast<std::size_t>(after), p->phi.size() - 1);
      if (b == 0 || !(p->phi[b] > p->phi[b - 1])) return p->z[b];
      const double share = (lead.phi[i] - p->phi[b - 1]) / (p->phi[b] - p->phi[b - 1]);
      return p->z[b - 1] + std::clamp(share, 0.0, 1.0) * (p->z[b] - p->z[b - 1]);
    };
    const double zi = height(inner), zo = height(outer);
    out.sections.push_back({.name = "phi " + degrees(lead.phi[i]),
                            .cut = {{0.0, zi}, {wall, zo}},
                            .angle = degrees(elementary::atan2(zo - zi, wall))});
  }
  return out;
}

SectionSet sections_of(const NamedHole& spec, const bevel::HoleCut& cut) {
  const double wall = spec.chord.wall, radius = spec.chord.outer_radius;
  const auto chord = (spec.chord_name.empty() ? "" : spec.chord_name + ", ");
  SectionSet out{.title = "Sections of the hole's edge",
                 .wall = wall,
                 .along = "square to the edge, from the hole into the wall",
                 .angle = "bevel",  // B is in the plane through the chord's axis
                 .facts = {{"chord", chord + diameter(radius, wall)}},
                 .sections = {}};
  if (!spec.branch_name.empty()) out.facts.emplace_back("hole for", spec.branch_name);
  const auto& hole = cut.holes.front();
  const auto n = hole.phi.size();
  for (const auto i : spread(hole.branch_phi)) {
    const auto a = (i + n - 1) % n, b = (i + 1) % n;
    const double tx = radius * (hole.phi[b] - hole.phi[a]), tz = hole.z[b] - hole.z[a];
    const double length = elementary::hypot(tx, tz);
    const double dx = radius * (hole.phi[i] - hole.phi_inner[i]), dz = hole.z[i] - hole.z_inner[i];
    const double out_of_hole = length > 0.0 ? (dx * tz - dz * tx) / length : 0.0;
    out.sections.push_back({.name = "branch phi " + degrees(hole.branch_phi[i]),
                            .cut = {{0.0, 0.0}, {wall, out_of_hole}},
                            .angle = degrees(elementary::atan2(out_of_hole, wall))});
  }
  return out;
}

Canvas section_sheet(const SectionSet& set, const Caption& caption) {
  auto based_set = set;
  for (auto& s : based_set.sections) s = based(std::move(s));
  const auto room = [](const Sheet& sheet) { return cell(sheet, kColumns, kRows, 0); };
  const Sheet blank(set.title, set.facts, caption);
  const double w = room(blank).high.x - room(blank).low.x - 22.0;
  const double h = room(blank).high.y - room(blank).low.y - 26.0;
  double tallest = 0.0;
  for (const auto& s : based_set.sections)
    for (const auto& p : s.cut) tallest = std::max(tallest, p.y);
  auto scale = drawing_scale(set.wall, w);
  if (const auto by_height = drawing_scale(std::max(tallest, 1e-9), h);
      by_height.factor < scale.factor)
    scale = by_height;
  auto facts = set.facts;
  facts.emplace_back("scale", scale.name);
  facts.emplace_back("up", set.along);
  Sheet sheet(set.title, facts, caption);
  std::vector<std::vector<std::string>> rows{
      {"section", set.angle, "inner edge, mm", "outer edge, mm"}};
  for (std::size_t i = 0; i < set.sections.size(); ++i) {
    draw_section(sheet.canvas(), cell(sheet, kColumns, kRows, static_cast<int>(i)),
                 based_set.sections[i], set.wall, scale.factor, tallest);
    rows.push_back({set.sections[i].name, set.sections[i].angle,
                    number(set.sections[i].cut.front().y, Unit::mm),
                    number(set.sections[i].cut.back().y, Unit::mm)});
  }
  const auto below = cell(sheet, 1, kRows, kRows - 1);
  draw_table(sheet.canvas(), {below.low.x + 4.0, below.high.y - 2.0}, {50.0, 25.0, 30.0, 30.0},
             rows);
  return std::move(sheet.canvas());
}

}  // namespace tubecut::api
