#include "api/endpoints/cutouts/text_answer.hpp"

#include <vector>

#include "api/wire/part_names.hpp"
#include "api/wire/tables.hpp"

namespace tubecut::api {
namespace {

void encode_stroke(Writer& each, const cutout::Stroke& stroke) {
  std::vector<double> z, girth;
  for (const auto& p : stroke) {
    z.push_back(p.x());
    girth.push_back(p.y());
  }
  each.object([&](Writer& o) {
    o.column("z_mm", z);
    o.column("girth_mm", girth);
  });
}

void encode_lettering(const cutout::Lettering& text, Writer& w) {
  const auto& spec = text.spec;
  w.object("lettering", [&](Writer& o) {
    o.field("id", spec.id);
    o.field("z_mm", text.z);
    if (text.face != 0) {
      o.field("face", text.face);
      o.field("offset_mm", text.offset);
    }
    o.degrees("angle_deg", spec.turn);
    o.field("height_mm", spec.height);
    o.field("mirrored", spec.mirrored);
    o.array("strokes", text.strokes, encode_stroke);
  });
}

}  // namespace

void encode_marks(const part::Part& part, double radius, Writer& w) {
  w.array("marks", part.marks, [&](Writer& each, const part::Mark& mark) {
    each.object([&](Writer& o) {
      o.field("kind", name_of(mark.kind));
      o.field("text", mark.text);
      o.degrees("phi_deg", mark.phi);
      o.field("girth_mm", radius * mark.phi);
      o.field("z_from_mm", mark.z_from);
      o.field("z_to_mm", mark.z_to);
      if (mark.lettering) encode_lettering(*mark.lettering, o);
    });
  });
}

void encode_marks(const part::SectionPart& part, Writer& w) {
  w.array("marks", part.marks, [&](Writer& each, const part::SectionMark& mark) {
    each.object([&](Writer& o) {
      o.field("kind", name_of(mark.kind));
      o.field("text", mark.text);
      o.field("girth_mm", mark.s);
      o.field("z_from_mm", mark.z_from);
      o.field("z_to_mm", mark.z_to);
      if (mark.lettering) encode_lettering(*mark.lettering, o);
    });
  });
}

}  // namespace tubecut::api
