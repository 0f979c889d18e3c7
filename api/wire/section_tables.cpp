#include "api/wire/section_tables.hpp"

#include <algorithm>
#include <utility>

#include "api/wire/joint_names.hpp"

namespace tubecut::api {

namespace {

/// Adds the columns of places but their way round.
void add_places(std::span<const section::Station> at, Columns& out) {
  std::vector<double> normal;
  std::vector<int> face;
  std::vector<bool> on_corner;
  for (const auto& one : at) {
    normal.push_back(one.nu);
    face.push_back(one.face);
    on_corner.push_back(one.on_corner);
  }
  out.degrees("normal_deg", std::move(normal))
      .integers("face", face)
      .flags("on_corner", std::move(on_corner));
}

}  // namespace

Columns station_columns(std::span<const section::Station> at) {
  std::vector<double> girth;
  for (const auto& one : at) girth.push_back(one.s);
  Columns out;
  out.column("girth_mm", std::move(girth));
  add_places(at, out);
  return out;
}

Columns profile_columns(const joint::SectionProfile& p) {
  std::vector<double> x, y;
  for (const auto& one : p.at) {
    x.push_back(one.point.x());
    y.push_back(one.point.y());
  }
  auto out = station_columns(p.at);
  out.column("x_mm", std::move(x))
      .column("y_mm", std::move(y))
      .column("z_mm", p.z)
      .integers("cutter", p.cutter);
  return out;
}

Columns bevel_columns(const bevel::TableSpec& spec, const bevel::SectionTable& t) {
  auto out = station_columns(t.at);
  out.column("wall_mm", t.wall)
      .column("developed_mm", t.developed)
      .column("length_mm", t.length)
      .integers("cutter", t.cutter)
      .column("z_inner_mm", t.z_inner)
      .column("z_outer_mm", t.z_outer)
      .degrees("dihedral_deg", t.dihedral)
      .degrees("groove_deg", t.groove)
      .degrees("gamma_deg", t.gamma)
      .degrees("flush_deg", t.flush)
      .degrees("b_raw_deg", t.b_raw)
      .degrees("b_required_deg", t.b_required)
      .degrees("b_deg", t.b)
      .column("gap_mm", t.gap)
      .column("beam_mm", t.beam)
      .column("torch_inner_mm", t.torch_inner)
      .column("torch_outer_mm", t.torch_outer)
      .flags("corner", t.corner);
  if (spec.root_face > 0.0) out.column("z_face_mm", t.z_face).degrees("b_face_deg", t.b_face);
  if (const auto* zoned = std::get_if<bevel::ZonedGroove>(&spec.groove)) {
    std::vector<std::string> names;
    for (const auto i : t.zone) names.push_back(zoned->zones[i].id);
    out.texts("zone", std::move(names));
  }
  if (spec.untilted)
    out.column("gap_inner_mm", t.gaps.square.inner)
        .column("gap_outer_mm", t.gaps.square.outer)
        .column("bevelled_gap_inner_mm", t.gaps.bevelled.inner)
        .column("bevelled_gap_outer_mm", t.gaps.bevelled.outer);
  return out;
}

std::vector<std::string> section_bevel_column_names(const bevel::TableSpec& spec) {
  bevel::TableSpec with;  // the options that determine the columns, without rows
  with.root_face = spec.root_face;
  with.groove = spec.groove;
  with.untilted = spec.untilted;
  std::vector<std::string> out;
  const auto columns = bevel_columns(with, {});
  for (const auto& column : columns.all()) out.push_back(column.name);
  return out;
}

Columns flat_cutout_columns(const bevel::Hole& rows, const section::Section& section) {
  const auto girth = [](std::vector<double> phi, const section::Curve& curve) {
    for (double& one : phi) one *= curve.girth() / kTwoPi;
    return phi;
  };
  const auto outer = section.outer(), bore = section.bore();
  const bool leans = std::ranges::any_of(rows.a, [](double a) { return a != 0.0; });
  Columns out;
  out.column("girth_mm", girth(rows.phi, outer))
      .column("z_mm", rows.z)
      .column("developed_mm", rows.developed);
  if (leans)
    out.column("girth_inner_mm", girth(rows.phi_inner, bore)).column("z_inner_mm", rows.z_inner);
  out.degrees("b_deg", rows.b);
  if (leans) out.degrees("a_deg", rows.a);
  out.column("torch_girth_mm", girth(rows.torch_phi, outer)).column("torch_z_mm", rows.torch_z);
  if (leans)
    out.column("torch_girth_inner_mm", girth(rows.torch_phi_inner, bore))
        .column("torch_z_inner_mm", rows.torch_z_inner);
  return out;
}

Columns corner_cutout_columns(const bevel::Hole& rows, const section::Section& section) {
  const auto girth = [](std::vector<double> phi, const section::Curve& curve) {
    for (double& one : phi) one *= curve.girth() / kTwoPi;
    return phi;
  };
  const auto outer = section.outer(), bore = section.bore();
  std::vector<section::Station> at;
  for (const double phi : rows.phi) at.push_back(outer.at(phi / kTwoPi * outer.girth()));
  Columns out;
  out.column("girth_mm", girth(rows.phi, outer));
  add_places(at, out);
  out.column("z_mm", rows.z)
      .column("developed_mm", rows.developed)
      .column("girth_inner_mm", girth(rows.phi_inner, bore))
      .column("z_inner_mm", rows.z_inner)
      .degrees("b_deg", rows.b)
      .degrees("a_deg", rows.a)
      .column("torch_girth_mm", girth(rows.torch_phi, outer))
      .column("torch_z_mm", rows.torch_z)
      .column("torch_girth_inner_mm", girth(rows.torch_phi_inner, bore))
      .column("torch_z_inner_mm", rows.torch_z_inner);
  return out;
}

std::string_view event_name(joint::SectionEventKind kind) {
  switch (kind) {
    case joint::SectionEventKind::junction:
      return "junction";
    case joint::SectionEventKind::jump:
      return "jump";
    case joint::SectionEventKind::kink:
      return "kink";
    case joint::SectionEventKind::seam:
      return "tangent_line";
  }
  return {};
}

void encode_event(const joint::SectionEvent& event, bool outer, Writer& w) {
  w.object([&](Writer& o) {
    o.field("kind", event_name(event.kind));
    o.field("surface", wall_name(outer));
    o.field("girth_mm", event.s);
    o.field("z_from_mm", event.z_from);
    o.field("z_to_mm", event.z_to);
    o.field("from", event.from);
    o.field("to", event.to);
  });
}

void encode_profile(const joint::SectionProfile& profile, Writer& w) {
  w.field("surface", wall_name(profile.outer));
  w.object("points", [&](Writer& c) { profile_columns(profile).write(c); });
  w.array("events", profile.events, [&](Writer& e, const joint::SectionEvent& event) {
    encode_event(event, profile.outer, e);
  });
  w.field("length_mm", profile.length);
  w.field("developed_length_mm", profile.girth);
}

}  // namespace tubecut::api
