#include "api/endpoints/section_bevel_table.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "api/wire/column_choice.hpp"
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

/// Every column that a section's table may have.
std::vector<std::string> all_names() {
  bevel::TableSpec all;
  all.root_face = 1.0;
  all.groove = bevel::ZonedGroove{};
  all.untilted = true;
  return section_bevel_column_names(all);
}

}  // namespace

void refuse_fields(Reader& in, std::initializer_list<const char*> fields, std::string_view hint) {
  for (const auto* field : fields) {
    in.note(field);
    if (in.has(field))
      in.issue(
          {.code = ErrorCode::unsupported_combination, .pointer = field, .hint = std::string(hint)},
          in.find(field));
  }
}

void refuse_round_only(Reader& in, const bevel::TableSpec& spec) {
  const auto refuse = [&](std::string pointer, Json got, Json limit, std::string hint) {
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = std::move(pointer),
              .got = std::move(got),
              .limit = std::move(limit),
              .hint = std::move(hint)});
  };
  if (spec.dihedral != bevel::Dihedral::weld_side)
    refuse("dihedral", *in.find("dihedral"), Json{"weld_side"},
           "inside and as_published require a round target");
  if (std::holds_alternative<bevel::HermiteSmoothing>(spec.smoothing))
    refuse("smoothing/method", Json{"hermite"}, Json{"envelope|none"},
           "hermite requires a round target");
  if (const auto* zoned = std::get_if<bevel::ZonedGroove>(&spec.groove))
    for (std::size_t i = 0; i < zoned->zones.size(); ++i)
      if (const auto& gap = zoned->zones[i].root_gap)
        refuse("groove/zones/" + std::to_string(i) + "/root_gap_mm", Json{*gap}, Json{},
               "root gaps of zones require a round target; root_gap_mm of the request applies to "
               "all zones");
}

void encode_section_lists(const bevel::SectionTable& t, Writer& w) {
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

void encode_section_proof(const bevel::SectionTable& t, Writer& w) {
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
    o.field("below_outside_mm", t.penetration.below);
    o.field("z_mm", t.penetration.z);
    o.field("cutter", t.penetration.solid);
  });
  w.object("torch_line", [&](Writer& o) {
    o.field("gouge_mm", t.torch_line.gouge);
    o.field("gouge_girth_mm", t.torch_line.gouge_s);
  });
}

void encode_section_laser(const bevel::SectionTable& t, Writer& w) {
  w.object("tube_laser", [&](Writer& o) {
    if (!t.gaps.square.inner.empty()) {
      encode_gap("gap", t, t.gaps.square, o);
      encode_gap("bevelled_gap", t, t.gaps.bevelled, o);
    }
    o.field("reach_mm", reach(t));
  });
}

bool cuts_section(const Reader& in) { return has_section_target(in) || has_section_end(in); }

SectionCutRequest decode_section_cut_request(Reader& in) {
  SectionCutRequest out;
  out.table.preset = decode_preset(in);
  check_accepts(in, {.preset = out.table.preset, .round = false});
  out.section = decode_section_cut(in, out.table);
  return out;
}

SectionTarget decode_section_cut(Reader& in, BevelTableRequest& out) {
  SectionTarget section;
  if (has_section_target(in)) {
    in.exactly_one({"target", "node"});
    section = decode_section_target(in);
    out.source.target = target_of(section);
    out.source.partners = decode_cutters(in);
  } else {
    out.source = decode_joint(in, Targets::any);
    if (out.source.node && out.source.node->section) section = *out.source.node->section;
  }
  out.sampling = decode_sampling(in);
  decode_table_options(in, out.preset, out);
  refuse_round_only(in, out);
  out.columns = decode_columns(in, all_names(), section_bevel_column_names(out));
  return section;
}

std::vector<Measure> measures_of(const bevel::TableSpec& spec, const bevel::SectionTable& t) {
  double gap = 0.0, extra = 0.0, b = 0.0;
  for (std::size_t i = 0; i < t.b.size(); ++i) {
    gap = std::max(gap, t.gap[i]);
    extra = std::max(extra, t.b[i] - t.b_raw[i]);
    b = std::max(b, std::abs(t.b[i]));
  }
  std::vector<Measure> out{{"max_root_gap_mm", gap},
                           {"max_extra_bevel_deg", extra * kDegPerRad},
                           {"max_b_deg", b * kDegPerRad}};
  if (!spec.untilted) return out;
  out.push_back({"max_reach_mm", reach(t)});
  out.push_back({"max_gap_mm", bevel::greatest(t.gaps.square).gap});
  return out;
}

void encode_table(const bevel::TableSpec& spec, const bevel::SectionTable& t,
                  const std::vector<std::string>& columns, Writer& w) {
  w.object("points", [&](Writer& p) { bevel_columns(spec, t).only(columns).write(p); });
  w.field("b_sign", "outer_edge_into_part");
  encode_section_lists(t, w);
  w.object("limits", [&](Writer& o) { encode_limits(spec, o); });
  encode_section_proof(t, w);
  w.field("length_mm", t.length_total);
  w.field("developed_length_mm", t.developed_total);
  if (spec.untilted) encode_section_laser(t, w);
}

}  // namespace tubecut::api
