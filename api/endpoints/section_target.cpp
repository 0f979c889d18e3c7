#include "api/endpoints/section_target.hpp"

#include <algorithm>
#include <array>

#include "api/catalog/section_sizes.hpp"
#include "api/limits.hpp"

namespace tubecut::api {
namespace {

constexpr std::array kKinds{Option<SectionKind>{"rectangular_tube", SectionKind::rectangular_tube},
                            Option<SectionKind>{"flat_oval_tube", SectionKind::flat_oval_tube}};

const std::string* text_of(const Json& object, std::string_view name) {
  const auto* field = object.find(name);
  return field == nullptr ? nullptr : field->as<std::string>();
}

/// The three lengths, with a bore at least as wide as that of a round tube.
void decode_lengths(Reader& t, section::Section& out) {
  out.height = t.number("height_mm", kDiameter);
  out.width = t.number("width_mm", kDiameter);
  const bool sized = t.understood("height_mm") && t.understood("width_mm");
  const double smaller = std::min(out.height, out.width);
  out.wall = t.number("wall_mm", sized ? wall_of(0.5 * smaller) : kWall);
}

void decode_corners(Reader& t, SectionTarget& out) {
  auto& section = out.section;
  const auto which = t.exactly_one({"corners", "corner_radius_mm"});
  if (which != 0u) t.note("inner_corner_radius_mm");
  if (which == 0u) {
    const auto standard = t.choice("corners", kNames<section::Standard>);
    const auto radii = section::corner_radii(standard, section.wall);
    section.corner = radii.outer;
    section.inner_corner = radii.inner;
    out.nominal = true;
    if (t.has("inner_corner_radius_mm"))
      t.issue({.code = ErrorCode::exclusive_fields,
               .pointer = "inner_corner_radius_mm",
               .hint = "corners already defines both radii; remove this field"},
              t.find("inner_corner_radius_mm"));
    t.note("inner_corner_radius_mm");
  } else if (which == 1u) {
    const Range radius{.min = 0.0, .max = 0.5 * kDiameter.max};
    section.corner = t.number("corner_radius_mm", radius);
    section.inner_corner = std::max(section.corner - section.wall, 0.0);
    if (t.has("inner_corner_radius_mm"))
      section.inner_corner = t.number("inner_corner_radius_mm", radius);
  }
}

/// Corners that cannot be cut are an issue of the field that says them.
void check_corners(Reader& t, const SectionTarget& target) {
  for (const auto* field : {"height_mm", "width_mm", "wall_mm"})
    if (!t.understood(field)) return;
  const auto checked = section::check(target.section);
  if (checked) return;
  for (const auto& issue : checked.error().issues) {
    const std::string radius = issue.member + "_mm";
    const std::string field = t.has(radius)               ? radius
                              : t.has("corner_radius_mm") ? "corner_radius_mm"
                              : t.has("corners")          ? "corners"
                                                          : "wall_mm";
    const auto* got = std::get_if<double>(&issue.got);
    const auto* limit = std::get_if<double>(&issue.limit);
    t.issue({.code = issue.code,
             .pointer = field,
             .got = Json{got != nullptr ? *got : 0.0},
             .limit = Json{limit != nullptr ? *limit : 0.0},
             .unit = issue.unit,
             .hint = issue.member + ": " + issue.hint});
  }
}

void decode_size(Reader& t, SectionTarget& out) {
  const auto name = t.text("size");
  const auto* size = find_section_size(name);
  if (size == nullptr) {
    if (!name.empty())
      t.issue({.code = ErrorCode::unknown_size, .pointer = "size", .hint = section_size_hint(name)},
              t.find("size"));
  } else {
    out.section = size->section;
    out.nominal = true;
  }
  for (const auto* field : {"height_mm", "width_mm", "wall_mm", "corners", "corner_radius_mm",
                            "inner_corner_radius_mm"}) {
    if (t.has(field))
      t.issue({.code = ErrorCode::exclusive_fields,
               .pointer = field,
               .hint = "size already defines the section; remove this field"},
              t.find(field));
    t.note(field);
  }
}

}  // namespace

SectionKind decode_section_kind(Reader& t) {
  auto kind = SectionKind::rectangular_tube;
  if (t.has("kind"))
    kind = t.choice("kind", kKinds);
  else
    t.put("kind", Json{"rectangular_tube"});
  t.note("kind");
  return kind;
}

SectionTarget decode_section(Reader& t, SectionKind kind) {
  SectionTarget out;
  if (kind == SectionKind::flat_oval_tube) {
    decode_lengths(t, out.section);
    out.section.corner = 0.5 * std::min(out.section.height, out.section.width);
    out.section.inner_corner = out.section.corner - out.section.wall;
  } else if (t.has("size")) {
    decode_size(t, out);
  } else {
    t.note("size");
    decode_lengths(t, out.section);
    decode_corners(t, out);
    check_corners(t, out);
  }
  return out;
}

bool is_section(const Json& tube) {
  if (const auto* kind = text_of(tube, "kind"))
    return std::ranges::any_of(kKinds, [&](const auto& one) { return one.name == *kind; });
  if (tube.find("kind") != nullptr) return false;
  const auto* size = text_of(tube, "size");
  return size != nullptr && find_section_size(*size) != nullptr;
}

bool has_section_target(const Reader& in) {
  const auto* target = in.find("target");
  return target != nullptr && is_section(*target);
}

SectionTarget decode_section_target(Reader& in) {
  return in.object("target", [](Reader& t) {
    const auto kind = decode_section_kind(t);
    t.optional_text("id");
    auto out = decode_section(t, kind);
    out.length =
        t.optional_number("length_mm", {.min = 0.0, .max = limit::offset_max_mm, .open_min = true});
    return out;
  });
}

joint::Target target_of(const SectionTarget& section) {
  return {.outer_radius = 0.5 * std::max(section.section.height, section.section.width),
          .wall = section.section.wall,
          .length = section.length};
}

void encode_section(const SectionTarget& target, Writer& w) {
  const auto& s = target.section;
  w.object("section", [&](Writer& o) {
    o.field("height_mm", s.height);
    o.field("width_mm", s.width);
    o.field("wall_mm", s.wall);
    o.field("corner_radius_mm", s.corner);
    o.field("inner_corner_radius_mm", s.inner_corner);
    o.field("corners", target.nominal ? "nominal" : "stated");
    o.field("girth_mm", s.outer().girth());
    o.field("bore_girth_mm", s.bore().girth());
    o.field("area_mm2", section::area(s));
    o.field("mass_kg_per_m", section::mass_per_metre(s));
  });
}

}  // namespace tubecut::api
