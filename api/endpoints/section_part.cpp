#include "api/endpoints/section_part.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "api/endpoints/cutouts/cutout_answer.hpp"
#include "api/endpoints/cutouts/text_answer.hpp"
#include "api/endpoints/part_codec.hpp"
#include "api/endpoints/place_text.hpp"
#include "api/endpoints/section_bevel_table.hpp"
#include "api/formats/bevel_table_formats.hpp"
#include "api/wire/bevel_names.hpp"
#include "api/wire/motion_names.hpp"
#include "api/wire/part_names.hpp"
#include "api/wire/section_tables.hpp"
#include "api/wire/tables.hpp"

namespace tubecut::api {
namespace {

void encode_faces(const section::Curve& outer, const part::SectionEnd& end, Writer& w) {
  struct Face {
    int number;
    const part::FaceCut* cut;
    double corner_z;
  };
  std::vector<Face> faces;
  for (std::size_t i = 0; i < end.faces.size(); ++i)
    faces.push_back({static_cast<int>(i) + 1, &end.faces[i], end.corners[i]});
  w.array("faces", faces, [&](Writer& each, const Face& face) {
    each.object([&](Writer& o) {
      o.field("face", face.number);
      o.field("girth_mm", outer.on_face(face.number, 0.0));
      o.field("z_mm", face.cut->z);
      if (face.cut->angle) o.degrees("angle_deg", *face.cut->angle);
      if (face.cut->tilt) o.degrees("saw_tilt_deg", *face.cut->tilt);
      o.field("corner_z_mm", face.corner_z);
    });
  });
}

void encode_end(const PartRequest& spec, const part::SectionPart& part, bool finish, Writer& w) {
  const auto& end = finish ? part.finish : part.start;
  w.object("points", [&](Writer& p) { bevel_columns(end.spec, end.table).write(p); });
  w.field("b_sign", kBSignInPart);
  w.field("scrap", name_of(finish ? motion::Scrap::plus_z : motion::Scrap::minus_z));
  w.field("surface", name_of(end.spec.root_surface));
  encode_section_lists(end.table, w);
  encode_section_proof(end.table, w);
  const auto point = [&](std::string_view name, const part::GirthPoint& p) {
    w.object(name, [&](Writer& o) {
      o.field("girth_mm", p.s);
      o.field("z_mm", p.z);
    });
  };
  point("long_point", end.longest);
  point("short_point", end.shortest);
  encode_faces(spec.section->section.outer(), end, w);
  w.field("length_mm", end.table.length_total);
  w.field("developed_length_mm", end.table.developed_total);
  w.field("weld_mm", end.weld_length);
  w.field("groove_mm3", end.groove_volume);
  w.column("cutter_ids", finish ? spec.finish_ids : spec.start_ids);
  if (spec.preset == Preset::tube_laser) encode_section_laser(end.table, w);
}

}  // namespace

std::vector<Measure> measures_of(const PartRequest& spec, const part::SectionPart& part) {
  std::vector<Measure> out;
  for (const auto* end : {&part.start, &part.finish})
    for (const auto& one : measures_of(end->spec, end->own)) add_worst(one, out);
  for (const auto& one : measures_of_cutouts(cutouts_of(spec.of_section, part), false))
    add_worst(one, out);
  // A square end of the preset has a reach too.
  if (spec.preset == Preset::tube_laser)
    for (const auto* end : {&part.start, &part.finish})
      add_worst({"max_reach_mm", std::abs(end->longest.z - end->shortest.z)}, out);
  return out;
}

void encode_part(const PartRequest& spec, const part::SectionPart& part, Writer& w) {
  encode_section(*spec.section, w);
  w.object("frame", [&](Writer& o) {
    write_place(part.frame.origin, part.frame.rows, o);
    o.field("in", spec.member ? "world" : "start");
  });
  w.object("ends", [&](Writer& ends) {
    ends.object("start", [&](Writer& o) { encode_end(spec, part, false, o); });
    ends.object("finish", [&](Writer& o) { encode_end(spec, part, true, o); });
  });
  encode_cutouts(cutouts_of(spec.of_section, part), false, w);
  w.degrees("clocking_between_ends_deg", part.clocking);
  w.object("lengths", [&](Writer& o) { encode_lengths(part.lengths, o); });
  std::vector<double> lengths, corners;
  for (const auto& face : part.faces) {
    lengths.push_back(face.length);
    corners.push_back(face.corner);
  }
  w.object("side_lengths", [&](Writer& o) {
    o.column("face_mm", lengths);
    o.column("corner_mm", corners);
  });
  w.array("check_dimensions", part.check_dimensions, encode_dimension);
  encode_marks(part, w);
  encode_sequence(part.sequence, part.cutouts, w);
}

}  // namespace tubecut::api
