#include <algorithm>

#include "api/endpoints/all.hpp"
#include "api/endpoints/bevel_table_codec.hpp"
#include "api/endpoints/frames/node_codec.hpp"
#include "api/endpoints/hole_codec.hpp"
#include "api/endpoints/joint_codec.hpp"
#include "api/endpoints/place_text.hpp"
#include "api/endpoints/section_bevel_table.hpp"
#include "api/limits.hpp"
#include "api/pipeline.hpp"
#include "api/wire/section_tables.hpp"
#include "core/base/try.hpp"
#include "core/bevel/table/end_tables.hpp"
#include "core/joint/node/end_curves.hpp"
#include "core/joint/node/overlap.hpp"

namespace tubecut::api {
namespace {

static_assert(limit::near_pairs_max == double{joint::kMostNearPairs} &&
              limit::overlaps_max == double{joint::kMostOverlaps});

struct NodesRequest {
  joint::NodeSpec node;
  std::vector<std::optional<SectionTarget>> sections;  // of each member that is not round
  bool profiles = false;
  joint::Sampling sampling;
  std::optional<bevel::TableSpec> tables;  // options, if requested
  std::vector<std::string> columns;        // of theirs that are printed; empty: all
  joint::Nodes solved;                     // once resolved
};
struct NodesAnswer {
  std::vector<joint::Overlap> overlaps;
  // One per end, if requested; else empty.
  std::vector<std::optional<joint::EndCurves>> profiles;
  std::vector<std::optional<bevel::EndTable>> tables;
};

struct Include {
  bool profiles = false, tables = false;
  bool understood = true;
};

Include decode_include(Reader& in) {
  Include out;
  in.note("include");
  if (!in.has("include")) return out;
  const auto parts = in.text_column("include", {.min = 1, .max = 2});
  out.understood = !parts.empty();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    bool* part = parts[i] == "profiles" ? &out.profiles
                 : parts[i] == "tables" ? &out.tables
                                        : nullptr;
    if (part == nullptr || *part) {
      out.understood = false;
      if (!parts[i].empty())
        in.issue({.code = ErrorCode::bad_choice,
                  .pointer = "include/" + std::to_string(i),
                  .got = Json{parts[i]},
                  .limit = Json{"profiles|tables"},
                  .hint = part == nullptr ? "" : "named twice"});
    } else {
      *part = true;
    }
  }
  return out;
}

/// Decodes `tables`, the options of the tables: requires "tables" in `include`.
std::optional<bevel::TableSpec> decode_tables(Reader& in, const Include& include,
                                              const joint::Sampling& sampling,
                                              std::vector<std::string>& columns) {
  in.note("tables");
  if (!include.understood) return std::nullopt;
  if (include.tables)
    return in.object("tables", [&](Reader& t) {
      bevel::TableSpec out;
      out.sampling = sampling;
      decode_table_options(t, Preset::none, out);
      columns = decode_table_columns(t, out);
      return out;
    });
  if (in.has("tables"))
    in.issue({.code = ErrorCode::missing_field,
              .pointer = in.has("include") ? "include/1" : "include",
              .limit = Json{"tables"},
              .hint = "requires tables in include"});
  return std::nullopt;
}

void encode_placement(const joint::TubeCutter& tube, Writer& p) {
  p.degrees("inclination_deg", tube.inclination.rad());
  p.degrees("clocking_deg", tube.clocking.rad());
  p.field("offset_mm", tube.offset);
  p.field("height_mm", tube.height);
}

/// Writes a section as the partner that /v1/intersections takes.
void encode_partner(const joint::RectangularTubeCutter& box, Writer& p) {
  p.field("kind", joint::RectangularTubeCutter::kName);
  p.field("width_mm", box.width);
  p.field("height_mm", box.height);
  p.field("corner_radius_mm", box.corner);
  p.object("axis", [&](Writer& a) {
    a.column("point_mm", components(box.point));
    a.column("direction", components(box.direction));
  });
  p.column("up", components(box.up));
}

void encode_cut(const joint::NodeSpec& spec, const joint::CutBy& cut, Writer& w) {
  w.field("member", spec.members[cut.member].name);
  if (cut.plane)
    w.object("plane", [&](Writer& p) {
      p.column("point_mm", components(cut.plane->point));
      p.column("normal", components(cut.plane->normal));
    });
  else
    w.object("placement", [&](Writer& p) { encode_placement(cut.placement.tube, p); });
  if (cut.box) w.object("partner", [&](Writer& p) { encode_partner(*cut.box, p); });
  w.object("joint", [&](Writer& j) { encode_joint_kind(cut.stated.value_or(joint::Joint{}), j); });
  w.field("gap_mm", cut.gap);
  w.field("eccentricity_mm", cut.eccentricity);
  w.field("ghost", cut.ghost);
  if (cut.ghost) w.field("missing_mm", cut.missing);
}

struct Nodes {
  using Spec = NodesRequest;
  using Out = NodesAnswer;
  static constexpr std::string_view kId = "nodes";
  static constexpr std::string_view kPath = "/v1/nodes";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_large_max_bytes);
  static constexpr double kBudgetS = kLongBudgetS;
  static constexpr std::array<std::string_view, 0> kAccepts{};
  static constexpr auto kOwnChecks = std::to_array<CheckLimit>({
      {"axis_in_world", "1e-12, of the lengths involved", ""},
      {"inclination", "1e-9", "deg"},
      {"eccentricity", "1e-12, of the lengths involved", ""},
      {"gap", "1e-12, of the lengths involved", ""},
      {"frame", "1e-12", ""},
      {"one_cuts_the_other", "0", ""},
  });
  static constexpr auto kSectionChecks = std::to_array<CheckLimit>(
      {{"on_section", "1e-12 of the section's reach; of a table 1e-9 mm", "mm"}});
  static constexpr auto kChecks = joined(kOwnChecks, kProfileChecks, kTableChecks, kSectionChecks);

  static Spec decode(Reader& in) {
    Spec out;
    const auto node = decode_named_node(in);
    out.node = node.spec;
    for (std::size_t i = 0; i < node.spec.members.size(); ++i)
      out.sections.push_back(section_of(node, i));
    const auto include = decode_include(in);
    out.profiles = include.profiles;
    out.sampling = decode_sampling(in);
    out.tables = decode_tables(in, include, out.sampling, out.columns);
    return out;
  }

  static Result<Spec> resolve(Spec spec) {
    TRY(spec.solved, joint::solve(spec.node));
    return spec;
  }
  static Result<Out> compute(const Spec& spec, const ParallelFor& parallel_for) {
    Out out;
    TRY(out.overlaps, joint::overlaps(spec.node, spec.solved, {}));
    if (spec.profiles) {
      TRY(out.profiles, joint::profiles(spec.node, spec.solved, spec.sampling));
    }
    if (!spec.tables) return out;
    auto tables = bevel::end_tables(spec.node, spec.solved, *spec.tables, parallel_for);
    if (!tables) return tl::unexpected(in_tables(tables.error()));
    out.tables = *std::move(tables);
    return out;
  }

  /// Moves an error in the options of the tables to `tables`.
  static Error in_tables(Error error) {
    for (auto& issue : error.issues)
      if (issue.member.starts_with("groove")) issue.member = "tables/" + issue.member;
    return error;
  }

  static std::vector<Check> verify(const Spec& spec, const Out& out,
                                   const ParallelFor& parallel_for) {
    auto checks = joint::verify(spec.node, spec.solved);
    for (std::size_t i = 0; i < out.profiles.size(); ++i)
      if (out.profiles[i]) {
        const auto joint = joint::joint_of(spec.node, spec.solved.ends[i]);
        keep_worst(checks, joint::verify(joint::IntersectionSpec{.target = joint.target,
                                                                 .partners = joint::seats(joint),
                                                                 .surfaces = joint::Surfaces::both,
                                                                 .sampling = spec.sampling},
                                         joint.section, *out.profiles[i]));
      }
    std::vector<std::vector<Check>> of_tables(out.tables.size());
    parallel_for(of_tables.size(), [&](std::size_t i) {
      const auto& end = out.tables[i];
      if (end && end->table) of_tables[i] = bevel::verify(end->spec, *end->table);
      if (end && end->of_section)
        of_tables[i] = bevel::verify(*end->section, end->spec, *end->of_section);
    });
    for (const auto& table : of_tables) keep_worst(checks, table);
    return checks;
  }

  static std::vector<Warning> warnings(const Spec& spec, const Out& out) {
    auto all = joint::once_a_pair(spec.node, spec.solved);
    for (auto& warning : joint::warnings_of(spec.node, out.overlaps))
      all.push_back(std::move(warning));
    for (std::size_t i = 0; i < out.profiles.size(); ++i)
      if (const auto& end = spec.solved.ends[i]; end.overhangs && !out.profiles[i])
        all.push_back(
            {.code = WarningCode::end_open, .member = joint::place_of(end.member, end.end)});
    for (std::size_t i = 0; i < out.tables.size(); ++i) {
      if (!out.tables[i]) continue;
      const auto at = joint::place_of(spec.solved.ends[i].member, spec.solved.ends[i].end);
      if (const auto& why = out.tables[i]->refused)
        all.push_back({.code = WarningCode::no_table,
                       .member = at,
                       .detail = std::string(info(why->code).code) +
                                 (why->hint.empty() ? "" : ": " + why->hint)});
      else
        for (const auto& warning : table_warnings(*out.tables[i]))
          if (warning.code != WarningCode::near_parallel)  // the node reports it too
            all.push_back({.code = warning.code, .member = at, .detail = warning.detail});
    }
    return all;
  }
  static std::vector<Measure> measure(const Spec&, const Out&) { return {}; }

  static const std::vector<Warning>& table_warnings(const bevel::EndTable& end) {
    return end.of_section ? end.of_section->warnings : end.table->warnings;
  }

  /// Returns the columns of a section's table by those asked of a round one, whose places are
  /// phi_deg.
  static std::vector<std::string> section_columns(const bevel::TableSpec& spec,
                                                  const std::vector<std::string>& asked) {
    const auto there = section_bevel_column_names(spec);
    std::vector<std::string> out;
    for (const auto& name : asked) {
      const auto& own = name == "phi_deg" ? std::string("girth_mm") : name;
      if (std::ranges::find(there, own) != there.end()) out.push_back(own);
    }
    if (out.empty() && !asked.empty()) out.emplace_back("girth_mm");
    return out;
  }

  static void encode_section_profiles(const joint::EndCurves& curves, Writer& w) {
    w.array("profiles", curves.of_section->profiles,
            [](Writer& each, const joint::SectionProfile& profile) {
              each.object([&](Writer& o) { encode_profile(profile, o); });
            });
  }

  static void encode_table_of(const Spec& spec, const joint::MemberEnd& end,
                              const bevel::EndTable& made, Writer& w) {
    if (made.table)
      w.object("table", [&](Writer& o) { encode_table(made.spec, *made.table, spec.columns, o); });
    if (made.of_section)
      w.object("table", [&](Writer& o) {
        encode_section(*spec.sections[end.member], o);
        encode_table(made.spec, *made.of_section, section_columns(made.spec, spec.columns), o);
      });
  }

  static void encode_end(const Spec& spec, const Out& out, const joint::MemberEnd& end, Writer& w) {
    const bool start = end.end == joint::End::start;
    w.field("member", spec.node.members[end.member].name);
    w.field("end", name_of(end.end));
    w.array("cut_by", end.cut_by, [&](Writer& each, const joint::CutBy& cut) {
      each.object([&](Writer& o) { encode_cut(spec.node, cut, o); });
    });
    w.object("frame", [&](Writer& o) { write_place(end.frame.origin, end.frame.rows, o); });
    w.field("free", end.free);
    w.field("open", end.open || end.overhangs);
    w.field("consumed", end.consumed);
    if (const auto& section = spec.sections[end.member]) encode_section(*section, w);
    const auto index = 2 * end.member + (start ? 0U : 1U);
    static const std::vector<joint::Profile> kNone;
    const bool there = index < out.profiles.size() && out.profiles[index];
    if (there && out.profiles[index]->of_section)
      encode_section_profiles(*out.profiles[index], w);
    else
      w.array("profiles", there ? out.profiles[index]->profiles : kNone,
              [&](Writer& each, const joint::Profile& profile) {
                each.object([&](Writer& o) { encode_profile(profile, spec.sampling, o); });
              });
    if (index < out.tables.size() && out.tables[index])
      encode_table_of(spec, end, *out.tables[index], w);
  }

  static void encode(const Spec& spec, const Out& out, Writer& w, const ParallelFor& parallel_for) {
    constexpr std::size_t kAtOnce = 16;  // number of ends whose text is held in addition to the
                                         // answer's
    const auto& ends = spec.solved.ends;
    std::vector<Writer> parts;
    w.array("ends", ends, [&](Writer& each, const joint::MemberEnd& end) {
      const auto i = static_cast<std::size_t>(&end - ends.data());
      if (i % kAtOnce == 0) {
        parts.clear();
        while (parts.size() < std::min(kAtOnce, ends.size() - i)) parts.push_back(each.part());
        parallel_for(parts.size(), [&](std::size_t k) {
          parts[k].object([&](Writer& o) { encode_end(spec, out, ends[i + k], o); });
        });
      }
      each.put(std::move(parts[i % kAtOnce]));
    });
    w.array("overlaps", out.overlaps, [&](Writer& each, const joint::Overlap& one) {
      each.object([&](Writer& o) {
        const auto& members = spec.node.members;
        o.column("between", std::vector{members[one.a].name, members[one.b].name});
        o.field("depth_mm", one.depth);
        o.column("at_mm", components(one.at));
      });
    });
  }

  static const std::vector<Format<Spec, Out>>& formats() {
    static const std::vector<Format<Spec, Out>> kNone;
    return kNone;
  }
};

}  // namespace

Endpoint nodes() { return endpoint<Nodes>(); }

}  // namespace tubecut::api
