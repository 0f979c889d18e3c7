#include "api/endpoints/cutouts/cutout_answer.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "api/formats/bevel_table_formats.hpp"
#include "api/wire/bevel_names.hpp"
#include "api/wire/cutout_names.hpp"
#include "api/wire/joint_names.hpp"
#include "api/wire/section_tables.hpp"
#include "api/wire/tables.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::api {
namespace {

/// How far a mould reaches from its anchor on the outside.
struct Reach {
  double phi_from, phi_to, z_from, z_to;
};
Reach reach_of(const bevel::Hole& rows) {
  const auto phi = std::ranges::minmax(rows.phi), z = std::ranges::minmax(rows.z);
  return {phi.min, phi.max, z.min, z.max};
}

void encode_instance(const CutoutsOfPart& part, const cutout::Instance& one, const Reach& reach,
                     Writer& o) {
  const double radius = part.radius;
  const double middle = one.phi + 0.5 * (reach.phi_from + reach.phi_to);
  const double turn = math::whole_turn(middle) - middle;
  o.field("id", one.name);
  if (part.section != nullptr) {
    o.field("face", one.face);
    o.field("offset_mm", one.offset);
    o.field("girth_mm", part.section->outer().on_face(one.face, one.offset));
  } else {
    o.degrees("phi_deg", one.phi);
    o.field("girth_mm", radius * one.phi);
  }
  o.field("z_mm", one.z);
  o.field("from_finish_mm", part.longest - one.z);
  o.field("z_from_mm", one.z + reach.z_from);
  o.field("z_to_mm", one.z + reach.z_to);
  o.field("girth_from_mm", radius * (one.phi + reach.phi_from + turn));
  o.field("girth_to_mm", radius * (one.phi + reach.phi_to + turn));
}

/// Writes the requested hole that a cut-out is, and how far its edges are from the branch.
void encode_hole_of(const part::HoleCutout& one, Writer& w) {
  const auto& branch = one.hole.branch;
  w.object("hole", [&](Writer& o) {
    o.field("index", one.hole.asked);
    o.field("branch", one.hole.name);
    o.field("kind", name_of(branch.kind));
    if (branch.kind == joint::JointKind::set_on) return;
    o.field("gap_mm", branch.gap);
    o.field("greatest_gap_mm", one.greatest_gap);
  });
}

void encode_cone(const cutout::Cone& cone, double wall, Writer& w) {
  w.object("countersink", [&](Writer& o) {
    o.field("diameter_mm", cone.diameter);
    o.degrees("angle_deg", 2.0 * cone.half);
    o.field("depth_mm", cone.depth());
    o.field("land_mm", std::max(0.0, wall - cone.depth()));
  });
}

Columns columns_of(const CutoutsOfPart& part, const cutout::Mould& mould, const bevel::Hole& rows) {
  if (part.section == nullptr) return cutout_columns(rows);
  return mould.laying.over() != nullptr ? corner_cutout_columns(rows, *part.section)
                                        : flat_cutout_columns(rows, *part.section);
}

void encode_group(const CutoutsOfPart& part, const std::vector<std::size_t>& group, Writer& o) {
  const auto& layout = part.layout;
  const auto& first = layout.instances[group.front()];
  const auto& mould = layout.mould_of(first);
  o.field("id", part.specs.all[first.asked].id);
  for (const auto& one : part.specs.holes)
    if (one.cutout == first.asked) encode_hole_of(one, o);
  o.field("side", mould.laying.far() ? "far" : "near");
  o.field("wall", mould.cone ? kCountersink : name_of(mould.laying.lay()));
  if (mould.cone) encode_cone(*mould.cone, mould.laying.wall(), o);
  o.object("points", [&](Writer& p) {
    const auto rows = cutout::placed(layout, first);
    columns_of(part, mould, rows).write(p);
  });
  o.field("b_sign", kBSignInPart);
  o.field("scrap", "inside");
  o.field("turns", 0);
  o.field("length_mm", mould.rows.length_total);
  o.field("area_outer_mm2", mould.taken.outer_area);
  o.field("area_inner_mm2", mould.taken.inner_area);
  o.field("volume_mm3", mould.taken.volume);
  o.field("mass_kg", mould.taken.volume * 1e-9 * part.density);
  const auto reach = reach_of(mould.rows);
  o.array("instances", group, [&](Writer& each, std::size_t i) {
    each.object([&](Writer& w) { encode_instance(part, layout.instances[i], reach, w); });
  });
}

/// The instances of one asked cut-out on one side are a group.
std::vector<std::vector<std::size_t>> groups_of(const cutout::Layout& layout) {
  std::vector<std::vector<std::size_t>> out;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> known;
  for (std::size_t i = 0; i < layout.instances.size(); ++i) {
    const auto& one = layout.instances[i];
    const auto [at, fresh] = known.try_emplace({one.asked, one.mould}, out.size());
    if (fresh) out.emplace_back();
    out[at->second].push_back(i);
  }
  return out;
}

void encode_web(std::string_view name, const part::CutoutWeb& web, const CutoutsOfPart& part,
                Writer& w) {
  using Beside = part::CutoutWeb::Beside;
  const auto& all = part.layout.instances;
  w.object(name, [&](Writer& o) {
    o.field("width_mm", web.width);
    if (part.section == nullptr)
      o.field("radius_mm", web.radius);
    else
      o.field("surface", name_of(web.radius == part.radius ? bevel::RootSurface::outer
                                                           : bevel::RootSurface::inner));
    o.field("cutout", all[web.cutout].name);
    o.field("beside", name_of(web.beside));
    if (web.beside == Beside::cutout) o.field("other", all[web.other].name);
    if (web.beside == Beside::hole) o.field("other_hole", web.other);
    const auto place = [&](std::string_view which, const part::EdgePoint& p) {
      o.object(which, [&](Writer& at) {
        if (part.section == nullptr)
          at.degrees("phi_deg", p.phi);
        else
          at.field("girth_mm", web.radius * p.phi);
        at.field("z_mm", p.z);
      });
    };
    place("from", web.from);
    place("to", web.to);
  });
}

}  // namespace

CutoutsOfPart cutouts_of(const part::PartSpec& spec, const part::Part& part) {
  return {spec.cutouts,     part.cutouts, part.cutout_report,   spec.target.outer_radius,
          spec.target.wall, spec.density, part.lengths.longest, nullptr};
}

CutoutsOfPart cutouts_of(const part::SectionPartSpec& spec, const part::SectionPart& part) {
  return {
      spec.cutouts,      part.cutouts, part.cutout_report,   spec.section.outer().girth() / kTwoPi,
      spec.section.wall, spec.density, part.lengths.longest, &spec.section};
}

void encode_cutouts(const CutoutsOfPart& part, bool seam_known, Writer& w) {
  const auto& layout = part.layout;
  if (layout.empty()) return;
  w.array("cutouts", groups_of(layout), [&](Writer& each, const std::vector<std::size_t>& group) {
    each.object([&](Writer& o) { encode_group(part, group, o); });
  });
  const auto& report = part.report;
  w.object("cutout_report", [&](Writer& o) {
    if (report.between) encode_web("web", *report.between, part, o);
    if (report.to_end) encode_web("to_end", *report.to_end, part, o);
    if (seam_known && report.to_seam)
      o.object("to_seam", [&](Writer& s) {
        s.field("girth_mm", report.to_seam->girth);
        s.field("cutout", layout.instances[report.to_seam->cutout].name);
      });
    o.object("net_section", [&](Writer& n) {
      n.field("z_mm", report.net.z);
      n.field("area_mm2", report.net.area);
      n.field("share", report.net.share);
    });
  });
}

std::vector<std::size_t> places_in_answer(const cutout::Layout& layout) {
  std::vector<std::size_t> out(layout.instances.size());
  std::size_t next = 0;
  for (const auto& group : groups_of(layout))
    for (const auto i : group) out[i] = next++;
  return out;
}

std::vector<Measure> measures_of_cutouts(const CutoutsOfPart& part, bool seam_known) {
  std::vector<Measure> out;
  if (part.layout.empty()) return out;
  const auto& report = part.report;
  for (const auto* web : {&report.between, &report.to_end})
    if (*web) out.push_back({"min_web_mm", (*web)->width});
  if (report.to_end) out.push_back({"min_hole_to_end_mm", report.to_end->width});
  if (seam_known && report.to_seam) out.push_back({"min_seam_to_hole_mm", report.to_seam->girth});
  for (const auto& one : part.specs.holes)
    if (one.hole.branch.kind != joint::JointKind::set_on)
      out.push_back({"max_root_gap_mm", one.greatest_gap});
  for (const auto& mould : part.layout.moulds)
    if (mould.cone) out.push_back({"max_b_deg", mould.cone->half * kDegPerRad});
  for (const auto& one : part.specs.all)
    if (const auto size = cutout::least_size(one.shape)) {
      out.push_back({"min_diameter_mm", *size});
      out.push_back({"min_diameter_per_wall", *size / part.wall});
    }
  return out;
}

}  // namespace tubecut::api
