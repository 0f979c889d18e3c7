#include "api/wire/section_bevel_tables.hpp"

#include <algorithm>

#include "api/wire/joint_names.hpp"
#include "api/wire/section_tables.hpp"

namespace tubecut::api {
namespace {

double reach(const bevel::SectionTable& t) {
  return std::max(std::ranges::max(t.z_inner), std::ranges::max(t.z_outer)) -
         std::min(std::ranges::min(t.z_inner), std::ranges::min(t.z_outer));
}

void encode_gap(std::string_view name, const bevel::SectionTable& t, const bevel::EdgeGaps& gaps,
                Writer& w) {
  const auto most = bevel::greatest(gaps);
  w.object(name, [&](Writer& o) {
    o.field("greatest_mm", most.gap);
    o.field("girth_mm", t.at[most.row].s);
    o.field("edge", wall_name(most.outer));
  });
}

void encode_events(const bevel::SectionTable& t, Writer& w) {
  struct Placed {
    const joint::SectionEvent* event;
    bool outer;
  };
  std::vector<Placed> events;
  for (const auto& event : t.inner_events) events.push_back({&event, false});
  for (const auto& event : t.outer_events) events.push_back({&event, true});
  w.array("events", events, [](Writer& each, const Placed& placed) {
    encode_event(*placed.event, placed.outer, each);
  });
  w.array("mutations", t.mutations, [](Writer& each, const bevel::SectionTable::Step& m) {
    each.object([&](Writer& o) {
      o.field("girth_mm", m.s);
      o.degrees("step_deg", m.step);
    });
  });
}

void encode_limits(const bevel::TableSpec& spec, Writer& o) {
  o.degrees("mutation_limit_deg", spec.mutation_limit.rad());
  const auto* envelope = std::get_if<bevel::EnvelopeSmoothing>(&spec.smoothing);
  if (envelope == nullptr) return;
  o.degrees("max_slope_deg_per_mm", envelope->limits.slope);
  o.degrees("max_curvature_deg_per_mm2", envelope->limits.curvature);
}

void encode_proof(const bevel::SectionTable& t, Writer& w) {
  w.array("torch_binds", t.torch_binds, [](Writer& each, const bevel::SectionTable::Binding& v) {
    each.object([&](Writer& o) {
      o.field("from_girth_mm", v.from);
      o.field("to_girth_mm", v.to);
      o.degrees("groove_lost_deg", v.groove_lost);
      o.field("root_gap_mm", v.root_gap);
    });
  });
  w.object("penetration", [&](Writer& o) {
    o.field("depth_mm", t.penetration.depth);
    o.field("girth_mm", t.penetration.s);
    o.field("z_mm", t.penetration.z);
    o.field("cutter", t.penetration.solid);
  });
  w.object("torch_line", [&](Writer& o) {
    o.field("gouge_mm", t.torch_line.gouge);
    o.field("gouge_girth_mm", t.torch_line.gouge_s);
    o.field("left_mm", t.torch_line.left);
    o.field("left_girth_mm", t.torch_line.left_s);
  });
}

}  // namespace

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

std::vector<std::string> section_column_names(const bevel::TableSpec& spec) {
  bevel::TableSpec with;  // what decides which there are, and no rows
  with.root_face = spec.root_face;
  with.groove = spec.groove;
  with.untilted = spec.untilted;
  std::vector<std::string> out;
  for (const auto& column : bevel_columns(with, {}).all()) out.push_back(column.name);
  return out;
}

void encode_table(const bevel::TableSpec& spec, const bevel::SectionTable& t, Writer& w) {
  w.object("points", [&](Writer& p) { bevel_columns(spec, t).write(p); });
  w.field("b_sign", "outer_edge_into_part");
  encode_events(t, w);
  w.object("limits", [&](Writer& o) { encode_limits(spec, o); });
  encode_proof(t, w);
  w.field("length_mm", t.length_total);
  w.field("developed_length_mm", t.developed_total);
  if (!spec.untilted) return;
  w.object("tube_laser", [&](Writer& o) {
    encode_gap("gap", t, t.gaps.square, o);
    encode_gap("bevelled_gap", t, t.gaps.bevelled, o);
    o.field("reach_mm", reach(t));
  });
}

}  // namespace tubecut::api
