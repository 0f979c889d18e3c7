#include "api/formats/drawing/development.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/formats/drawing/part_edges.hpp"
#include "api/formats/numbers.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

/// A table's column as a curve from the seam at phi = 0 to the seam at 2 pi.
CylinderCurve round_the_tube(double radius, std::vector<double> phi, std::vector<double> z) {
  if (phi.empty()) return {};
  const double ahead = phi.front() + kTwoPi - phi.back();
  const double share = ahead > 0.0 ? phi.front() / ahead : 0.0;  // of the step across the seam
  const double seam = z.front() + share * (z.back() - z.front());
  if (phi.front() > 0.0) {
    phi.insert(phi.begin(), 0.0);
    z.insert(z.begin(), seam);
  }
  if (phi.back() < kTwoPi) {
    phi.push_back(kTwoPi);
    z.push_back(seam);
  }
  return {.radius = radius, .phi = std::move(phi), .z = std::move(z)};
}

CylinderCurve profile_curve(const joint::Profile& p) {
  return round_the_tube(p.radius, p.phi, p.z);
}

/// Returns, of the edges on both walls, the points further in the scrap.
std::vector<double> scrap_side(const bevel::Table& t, bool finish) {
  std::vector<double> out;
  for (std::size_t i = 0; i < t.phi.size(); ++i)
    out.push_back(finish ? std::max(t.z_outer[i], t.z_inner[i])
                         : std::min(t.z_outer[i], t.z_inner[i]));
  return out;
}

/// Of a column of partners, row by row; a stretch across the seam is two.
std::vector<PartnerSpan> spans_of(const std::vector<double>& phi, const std::vector<double>& z,
                                  const std::vector<std::size_t>& partner, bool finish) {
  std::vector<PartnerSpan> out;
  for (std::size_t i = 0; i < phi.size(); ++i) {
    const double here = phi[i] - kTwoPi * std::floor(phi[i] / kTwoPi);
    const bool next = out.empty() || out.back().partner != partner[i] || here < out.back().phi_to;
    if (next) {
      out.push_back(
          {.phi_from = here, .phi_to = here, .z = z[i], .partner = partner[i], .finish = finish});
      continue;
    }
    auto& span = out.back();
    span.phi_to = here;
    span.z = finish ? std::max(span.z, z[i]) : std::min(span.z, z[i]);
  }
  return out;
}

}  // namespace

double CylinderCurve::developed_length(bool closing) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < phi.size(); ++i) {
    const auto next = i + 1 == phi.size() ? 0 : i + 1;
    if (next == 0 && !closing) break;
    sum += elementary::hypot(radius * (phi[next] - phi[i]), z[next] - z[i]);
  }
  return sum;
}

Development developed(const bevel::TableSpec& spec, const bevel::Table& t) {
  const double outer = spec.target.outer_radius, inner = spec.target.inner_radius();
  Development out{.outer_radius = outer, .wall = spec.target.wall, .cuts = {}, .junctions = {}};
  out.cuts.push_back({.name = "cut end",
                      .outer = round_the_tube(outer, t.phi, t.z_outer),
                      .inner = round_the_tube(inner, t.phi, t.z_inner),
                      .torch = round_the_tube(outer, t.phi, t.torch_outer)});
  out.spans = spans_of(t.phi, scrap_side(t, false), t.cutter, false);
  const bool outer_root = spec.root_surface == bevel::RootSurface::outer;
  for (const auto& event : outer_root ? t.outer_events : t.inner_events)
    out.junctions.push_back(event.phi);
  return out;
}

Development developed(const joint::IntersectionSpec& spec, const joint::Intersection& cut) {
  Development out{.outer_radius = spec.target.outer_radius,
                  .wall = spec.target.wall,
                  .cuts = {},
                  .junctions = {}};
  CutOutline outline{.name = "intersection", .outer = {}, .inner = {}, .torch = {}};
  for (const auto& profile : cut.profiles) {
    (profile.outer ? outline.outer : outline.inner) = profile_curve(profile);
    if (profile.outer)
      for (const auto& event : profile.events) out.junctions.push_back(event.phi);
    if (profile.outer || out.spans.empty())
      out.spans = spans_of(profile.phi, profile.z, profile.cutter, false);
  }
  out.cuts.push_back(std::move(outline));
  return out;
}

namespace {

/// A curve over places of an outline, or of the outside.
CylinderCurve round_the_section(double girth, std::vector<double> s, std::vector<double> z) {
  const double radius = girth / kTwoPi;
  // The first place may be just before the datum, by rounding.
  if (s.size() > 1 && s.front() > s[1]) s.front() -= girth;
  for (double& v : s) v = std::max(0.0, v) / radius;
  return round_the_tube(radius, std::move(s), std::move(z));
}

std::vector<double> shares(const std::vector<section::Station>& at, double radius) {
  std::vector<double> out;
  for (const auto& one : at) out.push_back(one.s / radius);
  return out;
}

Development of_section(const section::Section& section) {
  return {.outer_radius = section.outer().girth() / kTwoPi,
          .wall = section.wall,
          .cuts = {},
          .junctions = {},
          .section = section};
}

}  // namespace

Development developed(const section::Section& section, const joint::SectionIntersection& cut,
                      BoreOn on) {
  const section::Wall wall(section);
  const bool outside = on == BoreOn::outside;
  const double bore_girth = (outside ? wall.outer() : wall.bore()).girth();
  auto out = of_section(section);
  CutOutline outline{.name = "intersection", .outer = {}, .inner = {}, .torch = {}};
  for (const auto& profile : cut.profiles) {
    std::vector<double> s;
    for (const auto& at : profile.at)
      s.push_back(!profile.outer && outside ? wall.outside_of(at) : at.s);
    auto& curve = profile.outer ? outline.outer : outline.inner;
    curve = round_the_section(profile.outer ? profile.girth : bore_girth, std::move(s), profile.z);
    if (profile.outer)
      for (const auto& event : profile.events)
        if (event.kind != joint::SectionEventKind::seam)
          out.junctions.push_back(event.s / out.outer_radius);
    if (profile.outer || out.spans.empty())
      out.spans =
          spans_of(shares(profile.at, profile.girth / kTwoPi), profile.z, profile.cutter, false);
  }
  out.cuts.push_back(std::move(outline));
  return out;
}

Development developed(const section::Section& section, const bevel::SectionTable& t, BoreOn on) {
  const section::Wall wall(section);
  auto out = of_section(section);
  std::vector<double> s, bore, scrap;
  for (std::size_t i = 0; i < t.at.size(); ++i) {
    s.push_back(t.at[i].s);
    bore.push_back(on == BoreOn::outside ? t.at[i].s : wall.across(t.at[i]).bore.s);
    scrap.push_back(std::min(t.z_outer[i], t.z_inner[i]));
  }
  const double bore_girth = (on == BoreOn::outside ? wall.outer() : wall.bore()).girth();
  out.cuts.push_back({.name = "cut end",
                      .outer = round_the_section(t.girth, s, t.z_outer),
                      .inner = round_the_section(bore_girth, std::move(bore), t.z_inner),
                      .torch = round_the_section(t.girth, s, t.torch_outer)});
  out.spans = spans_of(shares(t.at, out.outer_radius), scrap, t.cutter, false);
  for (const auto& event : t.outer_events)
    if (event.kind != joint::SectionEventKind::seam)
      out.junctions.push_back(event.s / out.outer_radius);
  return out;
}

std::string for_branch(const std::string& hole, const std::string& branch) {
  return branch.empty() ? hole : hole + " for " + branch;
}

Development developed(const NamedHole& spec, const bevel::HoleCut& cut) {
  Development out{.outer_radius = spec.chord.outer_radius,
                  .wall = spec.chord.wall,
                  .cuts = {},
                  .junctions = {},
                  .name = spec.chord_name};
  for (const auto& hole : cut.holes) {
    auto& one = out.cuts.emplace_back(outline(spec.chord, hole, hole.far ? "far hole" : "hole"));
    one.label = for_branch(one.name, spec.branch_name);
  }
  return out;
}

CutOutline outline(const joint::Target& chord, const bevel::Hole& hole, std::string name) {
  const double outer = chord.outer_radius, inner = chord.inner_radius();
  return {.name = std::move(name),
          .outer = {.radius = outer, .phi = hole.phi, .z = hole.z},
          .inner = {.radius = inner, .phi = hole.phi_inner, .z = hole.z_inner},
          .torch = {.radius = outer, .phi = hole.torch_phi, .z = hole.torch_z},
          .around = false};
}

Development developed(const part::PartSpec& spec, const part::Part& part) {
  Development out{.outer_radius = spec.target.outer_radius,
                  .wall = spec.target.wall,
                  .cuts = {},
                  .junctions = {}};
  for (const auto* end : {&part.start, &part.finish}) {
    auto one = developed(end->spec, end->table);
    const bool finish = end == &part.finish;
    one.cuts.front().name = joint::end_name(finish);
    if ((finish ? spec.finish : spec.start).welded) {
      const auto& t = end->table;
      const auto spans = spans_of(t.phi, scrap_side(t, finish), t.cutter, finish);
      out.spans.insert(out.spans.end(), spans.begin(), spans.end());
    }
    out.cuts.push_back(std::move(one.cuts.front()));
  }
  for (std::size_t i = 0; i < part.holes.size(); ++i) {
    const auto& [hole, asked] = part.holes[i];
    auto& one = out.cuts.emplace_back(outline(spec.target, hole, "hole " + std::to_string(i)));
    one.label = for_branch(hole_tag(i), spec.holes[asked].name);
  }
  const auto& layout = part.cutouts;
  for (std::size_t i = 0; i < layout.instances.size(); ++i) {
    const auto tag = cutout_tag(layout, i);
    auto& one = out.cuts.emplace_back(
        outline(spec.target, cutout::placed(layout, layout.instances[i]), "cut-out " + tag));
    one.label = tag;
    one.sunk = layout.instances[i].sunk;
  }
  out.marks = part.marks;
  out.whole = true;
  out.name = spec.name;
  return out;
}

namespace {

/// A cut-out on a flat. Outside, the edge of the bore is the edge itself.
CutOutline flat_outline(const section::Section& section, const cutout::Layout& layout,
                        std::size_t i, BoreOn on) {
  const auto rows = cutout::placed(layout, layout.instances[i]);
  const auto tag = cutout_tag(layout, i);
  const double outer = section.outer().girth() / kTwoPi, inner = section.bore().girth() / kTwoPi;
  CutOutline out{.name = "cut-out " + tag,
                 .outer = {.radius = outer, .phi = rows.phi, .z = rows.z},
                 .inner = {},
                 .torch = {.radius = outer, .phi = rows.torch_phi, .z = rows.torch_z},
                 .around = false,
                 .label = tag,
                 .sunk = layout.instances[i].sunk};
  if (on == BoreOn::bore) out.inner = {.radius = inner, .phi = rows.phi_inner, .z = rows.z_inner};
  return out;
}

}  // namespace

Development developed(const part::SectionPartSpec& spec, const part::SectionPart& part, BoreOn on) {
  auto out = of_section(spec.section);
  for (const auto* end : {&part.start, &part.finish}) {
    auto one = developed(spec.section, end->table, on);
    const bool finish = end == &part.finish;
    one.cuts.front().name = joint::end_name(finish);
    out.cuts.push_back(std::move(one.cuts.front()));
    if (!(finish ? spec.finish : spec.start).welded) continue;
    const auto& t = end->table;
    std::vector<double> scrap;
    for (std::size_t i = 0; i < t.at.size(); ++i)
      scrap.push_back(finish ? std::max(t.z_outer[i], t.z_inner[i])
                             : std::min(t.z_outer[i], t.z_inner[i]));
    for (const auto& span : spans_of(shares(t.at, out.outer_radius), scrap, t.cutter, finish))
      out.spans.push_back(span);
  }
  for (std::size_t i = 0; i < part.cutouts.instances.size(); ++i)
    out.cuts.push_back(flat_outline(spec.section, part.cutouts, i, on));
  for (const auto& mark : part.marks)
    out.marks.push_back(
        {mark.kind, mark.text, mark.s / out.outer_radius, mark.z_from, mark.z_to, mark.lettering});
  out.whole = true;
  out.name = spec.name;
  return out;
}

std::string tube_size(const Development& d) {
  if (!d.section) return number(2.0 * d.outer_radius, Unit::mm) + " x " + mm(d.wall);
  return number(d.section->height, Unit::mm) + " x " + number(d.section->width, Unit::mm) + " x " +
         mm(d.wall) + ", corner radius " + mm(d.section->corner);
}

LabelPlace label_place(const CutOutline& hole) {
  constexpr double kLeast = 14.0, kBelow = 5.0, kShare = 0.22, kFree = 30.0;  // mm; of its height
  const auto z = std::ranges::minmax(hole.outer.z), phi = std::ranges::minmax(hole.outer.phi);
  const double tall = z.max - z.min, wide = hole.outer.radius * (phi.max - phi.min);
  LabelPlace out{.phi = 0.5 * (phi.min + phi.max), .z = z.max + 1.5, .room = kFree};
  if (std::min(tall, wide) < kLeast) return out;
  out.z = z.max - std::max(kBelow, kShare * tall);
  out.room = 0.7 * wide;
  return out;
}

bool Development::around() const {
  return std::ranges::any_of(cuts, [](const CutOutline& cut) { return cut.around; });
}

Extent extent(const Development& development) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Extent e{kInfinity, -kInfinity, kInfinity, -kInfinity};
  for (const auto& cut : development.cuts)
    for (const auto* curve : {&cut.outer, &cut.inner, &cut.torch})
      for (std::size_t i = 0; i < curve->phi.size(); ++i) {
        e.phi_from = std::min(e.phi_from, curve->phi[i]);
        e.phi_to = std::max(e.phi_to, curve->phi[i]);
        e.z_from = std::min(e.z_from, curve->z[i]);
        e.z_to = std::max(e.z_to, curve->z[i]);
      }
  return e;
}

}  // namespace tubecut::api
