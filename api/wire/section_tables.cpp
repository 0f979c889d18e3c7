#include "api/wire/section_tables.hpp"

#include "api/wire/joint_names.hpp"

namespace tubecut::api {

Columns station_columns(std::span<const section::Station> at) {
  std::vector<double> girth, normal;
  std::vector<int> face;
  std::vector<bool> on_corner;
  for (const auto& one : at) {
    girth.push_back(one.s);
    normal.push_back(one.nu);
    face.push_back(one.face);
    on_corner.push_back(one.on_corner);
  }
  Columns out;
  out.column("girth_mm", std::move(girth))
      .degrees("normal_deg", std::move(normal))
      .integers("face", face)
      .flags("on_corner", std::move(on_corner));
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
