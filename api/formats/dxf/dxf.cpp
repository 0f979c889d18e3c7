#include "api/formats/dxf/dxf.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "api/formats/drawing/canvas.hpp"
#include "api/formats/dxf/dxf_writer.hpp"
#include "api/formats/numbers.hpp"
#include "api/verdict.hpp"
#include "api/wire/words.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

constexpr double kChord = 0.01;  // mm, of a chord in space off the wall
constexpr double kMargin = 20.0;
constexpr double kCross = 5.0;  // mm, half of a mark's cross

constexpr DxfWriter::Layer kCutOuter{"CUT_OUTER", 5}, kCutInner{"CUT_INNER", 3},
    kTorch{"TORCH", 30}, kSeam{"SEAM", 1}, kDatum{"DATUM", 8}, kText{"TEXT", 7}, kMark{"MARK", 6},
    kFace{"FACE", 9};

std::vector<Eigen::Vector2d> flat(const CylinderCurve& c) {
  std::vector<Eigen::Vector2d> out;
  for (std::size_t i = 0; i < c.phi.size(); ++i) out.emplace_back(c.radius * c.phi[i], c.z[i]);
  return out;
}

Eigen::Vector3d on_wall(double radius, double phi, double z) {
  const auto [sin, cos] = elementary::sincos(phi);
  return {radius * cos, radius * sin, z};
}

/// The closed curve on a section's outline in space. Between two places of one arc, further points
/// keep the chord within kChord.
std::vector<Eigen::Vector3d> in_space(const section::Curve& outline, const CylinderCurve& c,
                                      bool around = true) {
  std::vector<Eigen::Vector3d> out;
  if (!around) {  // a cut-out on a flat
    for (std::size_t i = 0; i < c.phi.size(); ++i) {
      const auto at = outline.at(c.radius * c.phi[i]);
      out.emplace_back(at.point.x(), at.point.y(), c.z[i]);
    }
    return out;
  }
  for (std::size_t i = 0; i + 1 < c.phi.size(); ++i) {
    const double from = c.radius * c.phi[i], by = c.radius * (c.phi[i + 1] - c.phi[i]);
    const double bent = outline.at(from + 0.5 * by).curvature;
    const double step = 2.0 * elementary::acos(1.0 - std::min(1.0, kChord * bent));  // rad
    const int parts = bent > 0.0 ? std::max(1, static_cast<int>(std::ceil(by * bent / step))) : 1;
    for (int k = 0; k < parts; ++k) {
      const double share = static_cast<double>(k) / parts;
      const auto at = outline.at(from + share * by);
      out.emplace_back(at.point.x(), at.point.y(), c.z[i] + share * (c.z[i + 1] - c.z[i]));
    }
  }
  return out;
}

/// The closed curve in space; a curve round the tube gives its last point only once.
std::vector<Eigen::Vector3d> in_space(const CylinderCurve& c, bool around) {
  std::vector<Eigen::Vector3d> out;
  const double step = 2.0 * elementary::acos(1.0 - std::min(1.0, kChord / c.radius));
  const auto n = c.phi.size();
  for (std::size_t i = 0; i + (around ? 1 : 0) < n; ++i) {
    const auto next = (i + 1) % n;
    const double dphi = c.phi[next] - c.phi[i], dz = c.z[next] - c.z[i];
    const int parts = std::max(1, static_cast<int>(std::ceil(std::abs(dphi) / step)));
    for (int k = 0; k < parts; ++k) {
      const double share = static_cast<double>(k) / parts;
      out.push_back(on_wall(c.radius, c.phi[i] + share * dphi, c.z[i] + share * dz));
    }
  }
  return out;
}

std::vector<Eigen::Vector3d> open_in_space(const CylinderCurve& c) {
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i < c.phi.size(); ++i) out.push_back(on_wall(c.radius, c.phi[i], c.z[i]));
  return out;
}

/// "z 12 to 96 mm, phi 40° to 140°", of the outer edge.
std::string extent_in_words(const CutOutline& hole, bool of_section) {
  const auto z = std::ranges::minmax(hole.outer.z), phi = std::ranges::minmax(hole.outer.phi);
  if (of_section)
    return "z " + number(z.min, Unit::mm) + " to " + mm(z.max) + ", girth " +
           number(hole.outer.radius * phi.min, Unit::mm) + " to " + mm(hole.outer.radius * phi.max);
  return "z " + number(z.min, Unit::mm) + " to " + mm(z.max) + ", phi " + degrees(phi.min) +
         " to " + degrees(phi.max);
}

/// Draws each hole's label, small, at the hole.
void name_holes(DxfWriter& w, const Development& d) {
  constexpr double kHeight = 3.0, kLeast = 0.8;
  for (const auto& cut : d.cuts) {
    if (cut.around || cut.sunk) continue;
    const auto [phi, z, room] = label_place(cut);
    const double share = std::min(1.0, room / text_width(cut.label, kHeight));
    const double height = std::max(kLeast, kHeight * share);
    w.text(kText, {d.outer_radius * phi - 0.5 * text_width(cut.label, height), z}, height,
           cut.label);
  }
}

std::vector<std::string> captions(const Development& d, const std::string& frame,
                                  const Caption& caption) {
  const auto chord = "openings of the chord" + (d.name.empty() ? "" : " " + d.name) + ", tube ";
  std::vector<std::string> out{
      (d.around() ? "tube " : chord) + tube_size(d),
      d.section ? "CUT_OUTER round the outside, " + mm(d.section->outer().girth()) +
                      ", CUT_INNER round the bore, " + mm(d.section->bore().girth())
                : "CUT_OUTER on radius " + mm(d.outer_radius) + ", CUT_INNER on radius " +
                      mm(d.outer_radius - d.wall),
      frame};
  if (std::ranges::any_of(d.cuts, [](const auto& cut) { return !cut.torch.empty(); }))
    out.emplace_back("TORCH: its axis on the outer surface, the kerf applied; no edge of the part");
  if (d.whole && !d.name.empty()) out.push_back("part " + d.name);
  for (const auto& cut : d.cuts)
    if (!cut.around) out.push_back(cut.label + ": " + extent_in_words(cut, d.section.has_value()));
  for (const auto& [name, text] : caption.reference)
    out.push_back(called(name, Term::field) + ": " + text);
  out.push_back(job_line(
      {.reference = {}, .input_sha256 = caption.input_sha256, .result_sha256 = {}, .view = {}}));
  auto verdict =
      verdict_lines(caption.verdict, {.plain = true});  // these are read from below upwards
  out.insert(out.end(), verdict.rbegin(), verdict.rend());
  return out;
}

/// The outside at one z in space.
std::vector<Eigen::Vector3d> all_round(const Development& d, double z) {
  if (!d.section)
    return in_space({.radius = d.outer_radius, .phi = {0.0, kTwoPi}, .z = {z, z}}, true);
  const auto outline = d.section->outer();
  CylinderCurve round{.radius = d.outer_radius, .phi = {0.0}, .z = {z}};
  for (const double s : outline.seams()) round.phi.push_back(s / d.outer_radius);
  round.phi.push_back(kTwoPi);
  round.z.resize(round.phi.size(), z);
  return in_space(outline, round);
}

void seams(DxfWriter& w, const Development& d, const Extent& e, double datum, bool space) {
  if (space) {
    const double seam = d.section ? 0.5 * d.section->height : d.outer_radius;  // x, at phi = 0
    w.polyline(kDatum, all_round(d, datum), true);
    w.polyline(kSeam, std::vector{on_wall(seam, 0.0, e.z_from), on_wall(seam, 0.0, datum)}, false);
    return;
  }
  const double from = d.around() ? 0.0 : d.outer_radius * e.phi_from - kMargin;
  const double to =
      d.outer_radius * (d.around() ? kTwoPi : e.phi_to) + (d.around() ? 0.0 : kMargin);
  w.polyline(kDatum, std::vector<Eigen::Vector2d>{{from, datum}, {to, datum}}, false);
  double foot = e.z_from;
  if (d.around() && !d.cuts.front().outer.empty()) foot = d.cuts.front().outer.z.front();
  if (d.section)
    for (const double s : d.section->outer().seams())
      w.polyline(kFace, std::vector<Eigen::Vector2d>{{s, e.z_from}, {s, datum}}, false);
  for (const double x : {0.0, kTwoPi * d.outer_radius})
    if (x >= from && x <= to)
      w.polyline(kSeam, std::vector<Eigen::Vector2d>{{x, foot}, {x, datum}}, false);
}

void draw_cuts(DxfWriter& w, const Development& d, bool space) {
  for (const auto& cut : d.cuts) {
    const auto draw = [&](const DxfWriter::Layer& layer, const CylinderCurve& c) {
      if (c.empty()) return;
      if (!space)
        w.polyline(layer, flat(c), !cut.around);
      else if (d.section)
        w.polyline(
            layer,
            in_space(&c == &cut.inner ? d.section->bore() : d.section->outer(), c, cut.around),
            true);
      else
        w.polyline(layer, in_space(c, cut.around), true);
    };
    if (!cut.sunk) {
      draw(kCutOuter, cut.outer);
      draw(kCutInner, cut.inner);
    }
    draw(kTorch, cut.torch);
  }
}

/// A line on the outside along the tube; across it, all round.
void along(DxfWriter& w, const DxfWriter::Layer& layer, const Development& d, bool space,
           double phi, double from, double to) {
  if (space)
    w.polyline(layer,
               std::vector{on_wall(d.outer_radius, phi, from), on_wall(d.outer_radius, phi, to)},
               false);
  else
    w.polyline(
        layer,
        std::vector<Eigen::Vector2d>{{d.outer_radius * phi, from}, {d.outer_radius * phi, to}},
        false);
}
void across(DxfWriter& w, const DxfWriter::Layer& layer, const Development& d, bool space,
            double z) {
  const CylinderCurve circle{.radius = d.outer_radius, .phi = {0.0, kTwoPi}, .z = {z, z}};
  if (space)
    w.polyline(layer, in_space(circle, true), true);
  else
    w.polyline(layer, flat(circle), false);
}

/// A stroke in space: further points keep its chords within kChord of the outside.
std::vector<Eigen::Vector3d> stroke_in_space(const Development& d, const cutout::Stroke& stroke) {
  const double bent = 1.0 / (d.section ? d.section->corner : d.outer_radius);
  const double step = 2.0 * elementary::acos(1.0 - std::min(1.0, kChord * bent)) / bent;  // mm
  const auto outline = d.section ? std::optional(d.section->outer()) : std::nullopt;
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i < stroke.size(); ++i) {
    const cutout::Flat from = stroke[i == 0 ? 0 : i - 1], way = stroke[i] - from;
    const bool round = !outline || outline->at(from.y() + 0.5 * way.y()).on_corner;
    const int parts =
        round ? std::max(1, static_cast<int>(std::ceil(std::abs(way.y()) / step))) : 1;
    for (int k = i == 0 ? parts : 1; k <= parts; ++k) {
      const cutout::Flat p = k == parts ? stroke[i] : from + static_cast<double>(k) / parts * way;
      if (!outline) {
        out.push_back(on_wall(d.outer_radius, p.y() / d.outer_radius, p.x()));
        continue;
      }
      const auto at = outline->at(p.y());
      out.emplace_back(at.point.x(), at.point.y(), p.x());
    }
  }
  return out;
}

void draw_lettering(DxfWriter& w, const Development& d, const cutout::Lettering& text, bool space) {
  for (const auto& stroke : text.strokes) {
    if (space) {
      w.polyline(kMark, stroke_in_space(d, stroke), false);
      continue;
    }
    std::vector<Eigen::Vector2d> points;
    for (const auto& p : stroke) points.emplace_back(p.y(), p.x());
    w.polyline(kMark, points, false);
  }
}

/// Returns the phase of a mark, plus full turns if it lies in the contour of a hole that is drawn
/// there: a hole across the seam is one contour.
double shown_phi(const Development& d, const part::Mark& mark) {
  for (const auto& cut : d.cuts) {
    if (cut.around || cut.outer.empty()) continue;
    const auto [low, high] = std::ranges::minmax(cut.outer.phi);
    const auto [bottom, top] = std::ranges::minmax(cut.outer.z);
    if (mark.z_from < bottom || mark.z_to > top) continue;
    for (const double turn : {-kTwoPi, kTwoPi})
      if (mark.phi + turn >= low && mark.phi + turn <= high) return mark.phi + turn;
  }
  return mark.phi;
}

}  // namespace

std::string print_dxf(const Development& d, const Caption& caption) {
  const bool space = caption.view == "tube";
  const auto e = extent(d);
  const double datum = 10.0 * std::ceil((e.z_to + 15.0) / 10.0);
  auto layers = std::vector{kCutOuter, kCutInner, kTorch, kSeam, kDatum, kText};
  if (d.section) layers.push_back(kFace);
  DxfWriter w(layers, verdict_lines(caption.verdict));
  draw_cuts(w, d, space);
  seams(w, d, e, datum, space);
  const double left = d.around() || space ? 0.0 : d.outer_radius * e.phi_from - kMargin;
  double y = datum;
  const auto frame = "DATUM z = " + mm(datum) +
                     (d.section ? "; SEAM girth 0, the middle of face 1; FACE where a corner "
                                  "begins and ends; y = z, "
                                : "; SEAM phi = 0 and 360°; y = z, ") +
                     (d.around() ? "kept side up" : "kept outside the contour");
  if (!space) name_holes(w, d);
  for (const auto& line : captions(d, frame, caption)) w.text(kText, {left, y += 5.0}, 3.0, line);
  return w.print();
}

std::string print_dxf(const Development& d, const std::vector<part::Mark>& marks,
                      const Caption& caption) {
  const bool space = caption.view == "tube";
  DxfWriter w({kCutOuter, kCutInner, kTorch, kSeam, kDatum, kText, kMark},
              verdict_lines(caption.verdict));
  draw_cuts(w, d, space);
  const double from = d.cuts[0].outer.z.front(), to = d.cuts[1].outer.z.front();
  along(w, kSeam, d, space, 0.0, from, to);
  if (!space) along(w, kSeam, d, space, kTwoPi, from, to);
  across(w, kDatum, d, space, 0.0);
  for (const auto& mark : marks) {
    if (mark.lettering) {
      draw_lettering(w, d, *mark.lettering, space);
      continue;
    }
    const double phi = shown_phi(d, mark);
    if (mark.z_to > mark.z_from) {
      along(w, kMark, d, space, phi, mark.z_from, mark.z_to);
    } else {  // a cross on its place
      along(w, kMark, d, space, phi, mark.z_from - kCross, mark.z_from + kCross);
      const double reach = kCross / d.outer_radius;
      const CylinderCurve bar{.radius = d.outer_radius,
                              .phi = {phi - reach, phi, phi + reach},
                              .z = {mark.z_from, mark.z_from, mark.z_from}};
      if (space)
        w.polyline(kMark, open_in_space(bar), false);
      else
        w.polyline(kMark, flat(bar), false);
    }
    if (!space && !mark.text.empty())
      w.text(kMark, {d.outer_radius * phi + 1.0, mark.z_from}, 3.0, mark.text);
  }
  if (!space) name_holes(w, d);
  double y = extent(d).z_to + 10.0;
  const std::string frame =
      "DATUM z = 0, the start's long point; SEAM phi = 0 and 360°; y = z, the finish up";
  auto lines = captions(d, frame, caption);
  for (const auto& mark : marks)
    if (!mark.text.empty())
      lines.push_back("MARK " + mark.text + ": phi " + degrees(mark.phi) + ", z " +
                      mm(mark.z_from));
  for (const auto& line : lines) w.text(kText, {0.0, y += 5.0}, 3.0, line);
  return w.print();
}

}  // namespace tubecut::api
