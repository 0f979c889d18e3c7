#include "api/endpoints/parts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/endpoints/all.hpp"
#include "api/endpoints/bevel_table_codec.hpp"
#include "api/endpoints/cutouts/cutout_answer.hpp"
#include "api/endpoints/cutouts/text_answer.hpp"
#include "api/endpoints/frames/node_codec.hpp"
#include "api/endpoints/hole_codec.hpp"
#include "api/endpoints/joint_codec.hpp"
#include "api/endpoints/part_codec.hpp"
#include "api/endpoints/part_request.hpp"
#include "api/endpoints/place_text.hpp"
#include "api/endpoints/section_part.hpp"
#include "api/formats/drawing/partner_names.hpp"
#include "api/formats/gcode/gcode.hpp"
#include "api/formats/part_formats.hpp"
#include "api/formats/section_part_formats.hpp"
#include "api/formats/step/step.hpp"
#include "api/limits.hpp"
#include "api/pipeline.hpp"
#include "api/wire/bevel_names.hpp"
#include "api/wire/motion_names.hpp"
#include "api/wire/part_names.hpp"
#include "api/wire/tables.hpp"
#include "core/part/member.hpp"

namespace tubecut::api {
namespace {

using part::Step;

Parts::Laser laser_of(const PartRequest& spec, const part::Part& p) {
  return {.start = end_report(p.start.spec, p.start.table, false),
          .finish = end_report(p.finish.spec, p.finish.table, true),
          .webs = part::webs(spec.part, p)};
}

void add_laser(const PartRequest& spec, const Parts::Out& out, std::vector<Measure>& all) {
  const auto add = [&](const std::vector<Measure>& more) {
    for (const auto& one : more) add_worst(one, all);
  };
  add(measures_of(out.start.table, out.laser->start));
  add(measures_of(out.finish.table, out.laser->finish));
  for (const auto& placed : out.holes)
    add({{"max_reach_mm", bevel::reach(placed.hole.torch_z_inner, placed.hole.torch_z)}});
  add(measures_of(out.laser->webs, spec.seam_known()));
}

void encode_end(const PartRequest& spec, const Parts::Out& out, bool finish, Writer& w) {
  const auto& end = finish ? out.finish : out.start;
  w.object("points", [&](Writer& p) { bevel_columns(end.spec, end.table).write(p); });
  w.field("b_sign", kBSignInPart);
  w.field("scrap", name_of(finish ? motion::Scrap::plus_z : motion::Scrap::minus_z));
  w.field("surface", name_of(end.spec.root_surface));
  encode_bevel_lists(end.table, w);
  encode_torch_binds(end.table, w);
  encode_penetration(end.table.penetration, w);
  encode_torch_line(end.table.torch_line, w);
  const auto point = [&](std::string_view name, const part::EdgePoint& p) {
    w.object(name, [&](Writer& o) {
      o.degrees("phi_deg", p.phi);
      o.field("girth_mm", spec.part.target.outer_radius * p.phi);
      o.field("z_mm", p.z);
    });
  };
  point("long_point", end.longest);
  point("short_point", end.shortest);
  w.field("length_mm", end.table.length_total);
  w.field("developed_length_mm", end.table.developed_total);
  w.field("weld_mm", end.weld_length);
  w.field("groove_mm3", end.groove_volume);
  w.column("cutter_ids", finish ? spec.finish_ids : spec.start_ids);
  if (out.laser) encode_end_report(end.table, finish ? out.laser->finish : out.laser->start, w);
}

template <auto Print, auto PrintSection>
std::string print(const PartRequest& spec, const Parts::Out& out, const Caption& caption) {
  auto named = caption;
  const auto* ends = caption.request != nullptr ? caption.request->find("ends") : nullptr;
  const auto of = [&](const char* end, const std::vector<std::string>& ids, std::size_t count) {
    return partner_names(ends != nullptr ? ends->find(end) : nullptr, ids, count);
  };
  const auto count = [&](bool finish) {
    if (out.of_section)
      return (finish ? out.of_section->finish : out.of_section->start).spec.partners.size();
    return (finish ? out.finish : out.start).spec.partners.size();
  };
  named.partners = of("start", spec.start_ids, count(false));
  named.finish_partners = of("finish", spec.finish_ids, count(true));
  if (out.of_section) return PrintSection(spec.of_section, *out.of_section, named);
  return Print(spec.part, out, named);
}

}  // namespace

void encode_lengths(const part::Lengths& lengths, Writer& o) {
  o.field("work_point_mm", lengths.work_point);
  o.field("long_mm", lengths.longest);
  o.field("short_mm", lengths.shortest);
  o.field("blank_mm", lengths.blank);
  o.field("weld_mm", lengths.weld);
  o.field("volume_mm3", lengths.volume);
  o.field("mass_kg", lengths.mass);
}

void encode_sequence(const std::vector<Step>& sequence, const cutout::Layout& cutouts, Writer& w) {
  const auto places = places_in_answer(cutouts);
  w.array("sequence", sequence, [&](Writer& each, const Step& step) {
    each.object([&](Writer& o) {
      o.field("what", name_of(step.what));
      o.field("index", step.what == Step::What::cutout ? places[step.index] : step.index);
      o.field("z_from_mm", step.z_from);
      o.field("z_to_mm", step.z_to);
    });
  });
}

void encode_dimension(Writer& each, const part::CheckDimension& d) {
  each.object([&](Writer& o) {
    std::vector<std::string> mistakes;
    for (const auto m : d.changes_with) mistakes.emplace_back(name_of(m));
    o.field("name", d.name);
    o.field("value_mm", d.value);
    o.field("tool", name_of(d.tool));
    o.field("measured_from", d.measured_from);
    o.column("changes_with", mistakes);
  });
}

Parts::Spec Parts::decode(Reader& in) { return decode_part_request(in); }

Result<Parts::Spec> Parts::resolve(Spec spec) { return api::resolve(std::move(spec)); }

Result<Parts::Out> Parts::compute(const Spec& spec) {
  if (spec.section) {
    auto made = part::section_part(spec.of_section);
    if (!made) return tl::unexpected(on_request(spec, made.error()));
    Out out;
    out.of_section = *std::move(made);
    return out;
  }
  auto part = part::part(spec.part);
  if (!part) return tl::unexpected(on_request(spec, part.error()));
  Out out{*std::move(part)};
  if (spec.preset == Preset::tube_laser) out.laser = laser_of(spec, out);
  return out;
}

std::vector<Check> Parts::verify(const Spec& spec, const Out& out) {
  if (out.of_section) return part::verify(spec.of_section, *out.of_section);
  return part::verify(spec.part, out);
}

std::vector<Warning> Parts::warnings(const Spec& spec, const Out& out) {
  auto all = on_request(spec, out.of_section ? out.of_section->warnings : out.warnings);
  all.insert(all.end(), spec.warnings.begin(), spec.warnings.end());
  return all;
}

std::vector<Measure> Parts::measure(const Spec& spec, const Out& out) {
  if (out.of_section) return measures_of(spec, *out.of_section);
  double gap = 0.0, extra = 0.0, b = 0.0;
  for (const auto* end : {&out.start, &out.finish}) {
    const auto& t = end->own;
    for (std::size_t i = 0; i < t.b.size(); ++i) {
      gap = std::max(gap, t.gap[i]);
      extra = std::max(extra, t.b[i] - t.b_raw[i]);
      b = std::max(b, std::abs(t.b[i]));
    }
  }
  for (const auto& placed : out.holes) {
    gap = std::max(gap, placed.hole.fit.greatest_root_between);
    for (const double one : placed.hole.b) b = std::max(b, std::abs(one));
  }
  std::vector<Measure> all{{"max_root_gap_mm", gap},
                           {"max_extra_bevel_deg", extra * kDegPerRad},
                           {"max_b_deg", b * kDegPerRad}};
  if (out.laser) add_laser(spec, out, all);
  for (const auto& one : measures_of_cutouts(cutouts_of(spec.part, out), spec.seam_known()))
    add_worst(one, all);
  return all;
}

void Parts::encode(const Spec& spec, const Out& out, Writer& w) {
  if (out.of_section) return encode_part(spec, *out.of_section, w);
  w.object("frame", [&](Writer& o) {
    write_place(out.frame.origin, out.frame.rows, o);
    o.field("in", spec.member ? "world" : "start");
  });
  w.object("ends", [&](Writer& ends) {
    ends.object("start", [&](Writer& o) { encode_end(spec, out, false, o); });
    ends.object("finish", [&](Writer& o) { encode_end(spec, out, true, o); });
  });
  w.array("holes", out.holes, [&](Writer& each, const part::PlacedHole& placed) {
    each.object([&](Writer& o) {
      const auto& asked = spec.part.holes[placed.asked];
      o.field("branch", asked.name);
      encode_hole(asked.hole, placed.hole, o);
    });
  });
  encode_cutouts(cutouts_of(spec.part, out), spec.seam_known(), w);
  w.degrees("clocking_between_ends_deg", out.clocking);
  w.object("lengths", [&](Writer& o) { encode_lengths(out.lengths, o); });
  w.array("check_dimensions", out.check_dimensions, encode_dimension);
  encode_marks(out, spec.part.target.outer_radius, w);
  encode_sequence(out.sequence, out.cutouts, w);
  if (out.laser) encode_webs(out.laser->webs, spec.seam_known(), w);
}

const std::vector<Format<Parts::Spec, Parts::Out>>& Parts::formats() {
  static const std::vector<Format<Spec, Out>> kFormats{
      {"csv", "text/csv", &print<part_csv, section_part_csv>, {"cuts", "check_dimensions"}},
      {"svg",
       "image/svg+xml",
       &print<part_svg, section_part_svg>,
       {"work_order", "template"},
       {"mirror", "paper"}},
      {"pdf",
       "application/pdf",
       &print<part_pdf, section_part_pdf>,
       {"work_order", "template"},
       {"mirror", "paper"}},
      {"dxf", "image/vnd.dxf", &print<part_dxf, section_part_dxf>, {"template", "tube"}},
      {"step", "model/step", &print<part_step, section_part_step>, {"smooth", "straight"}},
      {"nc1", "application/x-dstv", &print<part_dstv, section_part_dstv>, {}, {}, false, true},
      {"gcode",
       "text/x-gcode",
       &print<part_gcode, section_part_gcode>,
       {},
       gcode_options(),
       true,
       true}};
  return kFormats;
}

Endpoint parts() { return endpoint<Parts>(); }

}  // namespace tubecut::api
