#include "api/endpoints/tube_laser.hpp"

#include <algorithm>
#include <string>

#include "api/wire/bevel_names.hpp"
#include "api/wire/joint_names.hpp"
#include "api/wire/part_names.hpp"

namespace tubecut::api {
namespace {

constexpr std::array kPresets{Option<Preset>{"tube_laser", Preset::tube_laser}};
constexpr std::string_view kUntilted = "preset tube_laser never tilts the head; omit this field";

/// Decodes the only choice that the preset permits, also if the field is absent.
template <class E, std::size_t N>
E only(Reader& in, std::string_view name, const std::array<Option<E>, N>& options, E fallback) {
  const auto out = in.choice(name, options, fallback);
  if (!in.understood(name)) in.silence();  // other fields belong to the other choice
  return out;
}

void encode_gap(std::string_view name, const bevel::Table& table, const bevel::EdgeGaps& gaps,
                Writer& w) {
  const auto most = bevel::greatest(gaps);
  w.object(name, [&](Writer& o) {
    o.field("greatest_mm", most.gap);
    o.degrees("phi_deg", table.phi[most.row]);
    o.field("edge", wall_name(most.outer));
  });
}

void encode_web(std::string_view name, const part::Web& web, Writer& w) {
  w.object(name, [&](Writer& o) {
    o.field("width_mm", web.width);
    o.field("radius_mm", web.radius);
    o.field("hole", web.hole);
    o.field("beside", name_of(web.beside));
    if (web.beside == part::Beside::hole) o.field("other_hole", web.other);
    const auto place = [&](std::string_view which, const part::EdgePoint& p) {
      o.object(which, [&](Writer& at) {
        at.degrees("phi_deg", p.phi);
        at.field("z_mm", p.z);
      });
    };
    place("from", web.from);
    place("to", web.to);
  });
}

}  // namespace

Preset decode_preset(Reader& in) {
  in.note("preset");
  return in.has("preset") ? in.tag("preset", kPresets).value_or(Preset::none) : Preset::none;
}

std::string_view missing_for(std::string_view limit, const Measured& of) {
  const auto in = [&](const auto& names) { return std::ranges::find(names, limit) != names.end(); };
  const bool laser = of.preset == Preset::tube_laser;
  if (in(kCutoutAccepts)) return of.cutouts ? "" : "requires cutouts";
  if (in(kEndAccepts)) {
    if (!laser) return "requires preset tube_laser";
    return limit == kEndAccepts.back() && !of.round ? "requires a round target" : "";
  }
  if (!in(kPartAccepts)) return {};
  if (!laser && !of.cutouts) return "requires preset tube_laser or cutouts";
  if (limit != kPartAccepts.back())
    return of.round || of.cutouts || of.holes ? "" : "requires cutouts or holes, or a round target";
  if (!of.round) return "requires a round target";
  return of.seam_known ? "" : "requires datum seam, which gives the seam's position";
}

void check_accepts(Reader& in, const Measured& of, const std::optional<Measured>& before) {
  const auto* accept = in.find("accept");
  const auto* limits = accept == nullptr ? nullptr : accept->as<Json::Object>();
  if (limits == nullptr) return;
  for (const auto& [name, value] : *limits)
    if (const auto hint = missing_for(name, of);
        !hint.empty() && !(before && !missing_for(name, *before).empty()))
      in.issue({.code = ErrorCode::unsupported_combination,
                .pointer = "accept/" + name,
                .hint = std::string(hint)},
               &value);
}

bevel::GrooveRule decode_square_groove(Reader& in) {
  static constexpr std::array kSquare{Option<int>{"square", 0}};
  in.defaulted_object("groove", [](Reader& g) { return only(g, "rule", kSquare, 0); });
  return bevel::SquareCut{};
}

void decode_no_smoothing(Reader& in, bevel::TableSpec& out) {
  static constexpr std::array kNone{Option<int>{"none", 0}};
  out.smoothing = bevel::NoSmoothing{};
  out.mutation_limit = in.defaulted_object("smoothing", [](Reader& m) {
    only(m, "method", kNone, 0);
    return m.angle("mutation_limit_deg", {.min = 0.0, .max = 180.0, .open_min = true},
                   Angle::deg(10));
  });
}

bevel::Contact decode_untilted_contact(Reader& in) {
  using bevel::Contact;
  return in.choice("contact", kOnly<Contact::automatic, Contact::outer, Contact::none>,
                   Contact::automatic);
}

bevel::Tilt decode_no_tilt(Reader& in) {
  return in.choice("tilt", kOnly<bevel::Tilt::none>, bevel::Tilt::none);
}

void check_torch_reaches_square(Reader& in, const bevel::TorchRange& torch) {
  const bool low = torch.min.rad() > 0.0;
  if (!low && torch.max.rad() >= 0.0) return;
  in.issue({.code = ErrorCode::unsupported_combination,
            .pointer = low ? "torch/min_deg" : "torch/max_deg",
            .got = Json{low ? torch.min.deg() : torch.max.deg()},
            .limit = Json{0.0},
            .unit = "deg",
            .hint = std::string(kUntilted)});
}

EndReport end_report(const bevel::TableSpec& spec, const bevel::Table& table, bool towards_plus_z) {
  return {.tongue = bevel::narrowest_tongue(spec.target, table, towards_plus_z),
          .reach = bevel::reach(table)};
}

void encode_end_report(const bevel::Table& table, const EndReport& report, Writer& w) {
  w.object("tube_laser", [&](Writer& o) {
    if (!table.gaps.square.inner.empty()) {
      encode_gap("gap", table, table.gaps.square, o);
      encode_gap("bevelled_gap", table, table.gaps.bevelled, o);
    }
    o.field("reach_mm", report.reach);
    if (!report.tongue) return;
    o.object("tongue", [&](Writer& t) {
      t.field("width_mm", report.tongue->width);
      t.degrees("phi_deg", report.tongue->phi);
      t.field("z_mm", report.tongue->z);
      t.field("radius_mm", report.tongue->radius);
    });
  });
}

std::vector<Measure> measures_of(const bevel::Table& table, const EndReport& report) {
  std::vector<Measure> out{{"max_reach_mm", report.reach}};
  if (!table.gaps.square.inner.empty())
    out.push_back({"max_gap_mm", bevel::greatest(table.gaps.square).gap});
  if (report.tongue) out.push_back({"min_tongue_mm", report.tongue->width});
  return out;
}

void add_worst(Measure one, std::vector<Measure>& to) {
  for (auto& other : to) {
    if (other.name != one.name) continue;
    const bool least = one.name.starts_with("min_");
    other.value = least ? std::min(other.value, one.value) : std::max(other.value, one.value);
    return;
  }
  to.push_back(one);
}

void encode_webs(const part::Webs& webs, bool seam_known, Writer& w) {
  w.object("tube_laser", [&](Writer& o) {
    if (const auto& web = webs.narrowest()) encode_web("web", *web, o);
    if (webs.to_end) encode_web("hole_to_end", *webs.to_end, o);
    if (!seam_known || !webs.to_seam) return;
    o.object("seam_to_hole", [&](Writer& s) {
      s.field("girth_mm", webs.to_seam->girth);
      s.field("hole", webs.to_seam->hole);
    });
  });
}

std::vector<Measure> measures_of(const part::Webs& webs, bool seam_known) {
  std::vector<Measure> out;
  if (const auto& web = webs.narrowest()) out.push_back({"min_web_mm", web->width});
  if (webs.to_end) out.push_back({"min_hole_to_end_mm", webs.to_end->width});
  if (seam_known && webs.to_seam) out.push_back({"min_seam_to_hole_mm", webs.to_seam->girth});
  return out;
}

}  // namespace tubecut::api
