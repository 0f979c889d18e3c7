#include "core/joint/section/section_intersection.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/joint/height_proof.hpp"
#include "core/joint/section/section_sampling.hpp"
#include "core/joint/solid.hpp"

namespace tubecut::joint {
namespace {

Result<SectionProfile> profile(const SectionContour& contour, const Sampling& sampling, bool outer,
                               std::span<const double> also) {
  TRY(const auto samples, sample(contour, sampling, also));
  SectionProfile out{.outer = outer,
                     .at = {},
                     .z = {},
                     .cutter = {},
                     .events = contour.events,
                     .length = samples.true_length,
                     .girth = contour.curve.girth()};
  for (const auto& node : samples.nodes) {
    out.at.push_back(contour.curve.at(node.s));
    out.z.push_back(node.z);
    out.cutter.push_back(node.after);
  }
  return out;
}

/// The seams of the other surface, as places of this one.
std::vector<double> other_seams(const section::Wall& wall, bool outer) {
  std::vector<double> out;
  if (outer)
    for (const double s : wall.bore().seams()) out.push_back(wall.outside_of(wall.bore().at(s)));
  else
    for (const double s : wall.outer().seams())
      out.push_back(wall.across(wall.outer().at(s)).bore.s);
  return out;
}

constexpr double kOnOutline = 1e-12;  // of the outline's size
constexpr double kHere = 1e-9;        // of the girth: a row at an event

/// On the outline, and no further from the row before than the girth between them.
double off_outline(const section::Section& section, const SectionProfile& p, std::size_t i) {
  const auto& place = p.at[i].point;
  const double off = std::abs(outline_distance(section, p.outer, place));
  if (i == 0) return off;
  return std::max(off, (place - p.at[i - 1].point).norm() - (p.at[i].s - p.at[i - 1].s));
}

void see_events(const section::Section& section, const SectionProfile& p, HeightProof& proof) {
  const auto outline = p.outer ? section.outer() : section.bore();
  for (const auto& event : p.events) {
    const auto place = outline.at(event.s).point;
    const Eigen::Vector3d at(place.x(), place.y(), event.z_from);
    if (event.kind == SectionEventKind::seam)
      proof.see_seam(at, event.from);
    else if (event.kind == SectionEventKind::junction)
      proof.see_junction(at, event.from, event.to);
    else
      proof.see_touch(at, event.from, event.to, event.z_from > event.z_to ? event.from : event.to);
  }
}

}  // namespace

double outline_distance(const section::Section& section, bool outer, const Eigen::Vector2d& place) {
  const double less = outer ? 0.0 : section.wall;
  const double corner = outer ? section.corner : section.inner_corner;
  const double x = std::abs(place.x()) - 0.5 * section.height + less + corner;
  const double y = std::abs(place.y()) - 0.5 * section.width + less + corner;
  if (x > 0.0 && y > 0.0) return elementary::hypot(x, y) - corner;
  return std::max(x, y) - corner;
}

std::vector<Warning> partner_warnings(const SectionContour& contour) {
  std::vector<Warning> out;
  for (const auto i : contour.missed)
    out.push_back({.code = WarningCode::cutter_missed, .member = "cutters/" + std::to_string(i)});
  for (const auto i : contour.near_parallel)
    out.push_back({.code = WarningCode::near_parallel, .member = "cutters/" + std::to_string(i)});
  return out;
}

Result<SectionIntersection> intersect(const section::Section& section,
                                      const IntersectionSpec& spec) {
  TRY(const auto cutters, resolve(spec.partners));
  const section::Wall wall(section);
  SectionIntersection out;
  for (const bool outer : {false, true}) {
    if (spec.surfaces == (outer ? Surfaces::inner : Surfaces::outer)) continue;
    TRY(const auto contour, trace(cutters, outer ? wall.outer() : wall.bore()));
    TRY(auto curve, profile(contour, spec.sampling, outer, other_seams(wall, outer)));
    TRY(check_length(spec.target, curve.z));
    out.profiles.push_back(std::move(curve));
    out.warnings = partner_warnings(contour);  // of the outer surface when both are asked for
  }
  return out;
}

std::vector<Check> verify(const section::Section& section, const IntersectionSpec& spec,
                          const SectionIntersection& answer) {
  std::vector<Solid> solids;
  if (const auto cutters = resolve(spec.partners))
    for (const auto& cutter : *cutters) solids.emplace_back(cutter);
  const double wide = section.outer().reach();
  Worst on_section("on_section", "mm");
  HeightProof proof(solids);
  proof.see_surface(wide);
  for (const auto& p : answer.profiles) {
    for (std::size_t i = 0; i < p.z.size() && !stopped(); ++i) {
      on_section.see(off_outline(section, p, i), kOnOutline * wide);
      const Eigen::Vector3d at(p.at[i].point.x(), p.at[i].point.y(), p.z[i]);
      proof.see_row(at, p.cutter[i], p.events, [&](const SectionEvent& e) {
        const double d = std::abs(e.s - p.at[i].s);
        return std::min(d, p.girth - d) < kHere * p.girth;
      });
    }
    see_events(section, p, proof);
  }
  auto out = proof.checks();
  out.insert(out.begin(), on_section.check());
  return out;
}

}  // namespace tubecut::joint
