#include "core/frame/alike_form.hpp"

#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"
#include "core/bevel/hole/hole.hpp"
#include "core/bevel/section/section_table.hpp"
#include "core/bevel/table/table.hpp"
#include "core/joint/intersection.hpp"

namespace tubecut::frame::detail {
namespace {

constexpr std::size_t kMeanOver = 256;  // phases
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Returns the mean height of the contour on the bore.
double mean_height(const FormEnd& end, double radius) {
  double sum = 0.0;
  for (std::size_t k = 0; k < kMeanOver; ++k) {
    const auto line = joint::generator_at(
        radius, kTwoPi * static_cast<double>(k) / static_cast<double>(kMeanOver));
    double top = -std::numeric_limits<double>::infinity();
    for (const auto& partner : end.partners)
      if (const auto z = joint::upper_sheet(partner, line)) top = std::max(top, *z);
    if (!std::isfinite(top)) return kNone;
    sum += top;
  }
  return sum / static_cast<double>(kMeanOver);
}

std::optional<FormEnd> end_of(const bevel::TableSpec& cut, double bore_radius) {
  const auto seats = bevel::grown_partners(cut);
  if (!seats) return std::nullopt;
  FormEnd out;
  for (std::size_t i = 0; i < seats->size(); ++i) {
    auto prepared = joint::prepare((*seats)[i]);
    if (!prepared) return std::nullopt;
    out.partners.push_back(*std::move(prepared));
    const auto to = joint::bearing(cut.partners[i]);
    out.perpendicular.push_back(to ? std::optional(to->perpendicular) : std::nullopt);
  }
  out.left = mean_height(out, bore_radius);
  return out;
}

/// Returns the cut on the phases of the comparison, without kerf, because the kerf does not affect
/// the finished part.
bevel::TableSpec on_phases(bevel::TableSpec cut, Angle turn) {
  for (auto& partner : cut.partners) partner = joint::turned(partner, turn);
  cut.sampling = {.uniform_points = kAlikePhases};
  cut.kerf = 0.0;
  return cut;
}

/// Returns the phases of a cut's events on both walls.
std::vector<double> events_of(const bevel::Table& table) {
  std::vector<double> out;
  for (const auto* events : {&table.inner_events, &table.outer_events})
    for (const auto& event : *events) out.push_back(event.phi);
  return out;
}
/// The same of a section: by the place outside that lies on the normal of an event's place.
std::vector<double> events_of(const bevel::SectionTable& table, const section::Section& section) {
  const auto outer = section.outer(), bore = section.bore();
  std::vector<double> out;
  for (const auto& event : table.inner_events) {
    const auto at = bore.at(event.s);
    const double s =
        at.on_corner ? outer.on_corner(at.face, at.along) : outer.on_face(at.face, at.along);
    out.push_back(kTwoPi * s / table.girth);
  }
  for (const auto& event : table.outer_events) out.push_back(kTwoPi * event.s / table.girth);
  return out;
}

/// Adds the edges of a table with these events; those of a finish in the start's frame.
template <class Table>
bool add_edges(const Table& table, const std::vector<double>& events, double radius,
               std::optional<double> length, FormWall& out) {
  if (table.z_outer.size() != kAlikePhases) return false;
  for (const auto* z : {&table.z_inner, &table.z_face, &table.z_outer}) {
    if (z->empty()) continue;  // if there is no land
    auto& line = out.ends.emplace_back(FormWall::Line{.events = events, .radius = radius});
    for (const double one : *z) line.z.push_back(length ? *length - one : one);
  }
  return true;
}

bool add_end(const Form& form, const bevel::TableSpec& cut, Angle turn,
             std::optional<double> length, FormWall& out) {
  const auto asked = on_phases(cut, turn);
  const double radius = form.part->target.outer_radius;
  if (form.section) {
    const auto table = bevel::section_table(*form.section, asked);
    return table && add_edges(*table, events_of(*table, *form.section), radius, length, out);
  }
  const auto table = bevel::table(asked);
  return table && add_edges(*table, events_of(*table), radius, length, out);
}

bool add_hole(bevel::HoleSpec asked, Angle turn, FormWall& out) {
  asked.branch = joint::turned(asked.branch, turn);
  asked.sampling = {.uniform_points = kAlikePhases / 2};
  asked.kerf = 0.0;
  const auto cut = bevel::hole(asked);
  if (!cut) return false;
  auto& lines = out.holes.emplace_back();
  for (const auto& hole : cut->holes) {
    if (hole.phi.size() != kAlikePhases / 2) return false;
    lines.push_back({.z = hole.z, .phi = hole.phi, .radius = asked.chord.outer_radius});
    lines.push_back(
        {.z = hole.z_inner, .phi = hole.phi_inner, .radius = asked.chord.inner_radius()});
  }
  return true;
}

}  // namespace

PartnerHeights FormEnd::heights(std::size_t partner, double radius, double turned_by) const {
  PartnerHeights out;
  for (std::size_t k = 0; k < kHeightPhases; ++k)
    out[k] = joint::upper_sheet(
        partners[partner], joint::generator_at(radius, kTwoPi * static_cast<double>(k) /
                                                               static_cast<double>(kHeightPhases) -
                                                           turned_by));
  return out;
}

double Form::middle() const { return part->target.outer_radius - 0.5 * part->target.wall; }

std::optional<Form> form_of(const AskedPart& asked) {
  const auto& part = *asked.part;
  auto start = end_of(part.start.cut, part.target.inner_radius());
  auto finish = end_of(part.finish.cut, part.target.inner_radius());
  if (!start || !finish || !part.target.length) return std::nullopt;
  Form out{.part = &part,
           .section = asked.section,
           .start = *std::move(start),
           .finish = *std::move(finish),
           .holes = {}};
  for (const auto& one : part.holes) {
    const auto branch = bevel::branch_tube(one.hole.branch);
    if (!branch) return std::nullopt;
    out.holes.push_back(*branch);
  }
  out.left = *part.target.length - out.start.left - out.finish.left;
  return out;
}

std::optional<FormWall> wall_of(const Form& form, Angle turn) {
  const auto& part = *form.part;
  FormWall out;
  if (!add_end(form, part.start.cut, turn, {}, out) ||
      !add_end(form, part.finish.cut, -turn, part.target.length, out))
    return std::nullopt;
  for (const auto& one : part.holes)
    if (!add_hole(one.hole, turn, out)) return std::nullopt;
  return out;
}

}  // namespace tubecut::frame::detail
