#include "api/formats/dxf/dstv_stated.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <variant>

#include "api/formats/dxf/dstv_text.hpp"
#include "api/formats/text.hpp"
#include "api/wire/bevel_names.hpp"
#include "api/wire/cutout_names.hpp"
#include "core/base/angle.hpp"

namespace tubecut::api {
namespace {

std::string stated(double value) {
  std::array<char, 32> digits{};
  const auto [end, error] =
      std::to_chars(digits.data(), digits.data() + digits.size(),
                    std::round(value * 1e9) * 1e-9 + 0.0, std::chars_format::general, 12);
  return error == std::errc() ? std::string(digits.data(), end) : std::string();
}
std::string stated(const cutout::Flat& at) { return stated(at.x()) + " " + stated(at.y()); }
std::string field(std::string_view name, double value) {
  return "; " + std::string(name) + " " + stated(value);
}

/// Empty for a table of zones.
std::optional<std::string> groove_words(const bevel::GrooveRule& rule) {
  if (const auto* half = std::get_if<bevel::HalfDihedral>(&rule))
    return "half the dihedral, cap " + stated(half->cap.deg());
  if (const auto* fixed = std::get_if<bevel::FixedGroove>(&rule))
    return "fixed " + stated(fixed->angle.deg());
  if (std::holds_alternative<bevel::NoGroove>(rule)) return "none";
  if (std::holds_alternative<bevel::SquareCut>(rule)) return "square";
  return std::nullopt;
}

/// The words of an end that one plane cuts; empty if they would not be all of it.
std::string plane_words(const bevel::TableSpec& cut, const joint::PlaneCutter& plane, double x,
                        bool finish) {
  const auto groove = groove_words(cut.groove);
  const bool joined =
      std::ranges::any_of(cut.stated, [](const auto& one) { return one.has_value(); });
  if (!groove || joined || cut.dihedral != bevel::Dihedral::weld_side ||
      !std::holds_alternative<bevel::NoSmoothing>(cut.smoothing))
    return {};
  const double back = finish ? -1.0 : 1.0;  // the finish's own frame has y and z in reverse
  const Eigen::Vector3d n = plane.normal.normalized();
  return "plane at x " + stated(x) + "; normal " + stated(n.x()) + " " + stated(back * n.y()) +
         " " + stated(back * n.z()) + "; groove " + *groove + "; contact " +
         std::string(name_of(cut.contact)) + "; root " + std::string(name_of(cut.root_surface)) +
         field("root face", cut.root_face) + field("root gap", cut.root_gap) +
         field("coating", cut.coating);
}

std::string shape_words(const cutout::Shape& shape) {
  if (const auto* circle = std::get_if<cutout::Circle>(&shape))
    return "circle " + stated(circle->diameter);
  if (const auto* slot = std::get_if<cutout::Slot>(&shape))
    return "slot " + stated(slot->length) + " x " + stated(slot->width);
  if (const auto* box = std::get_if<cutout::Rectangle>(&shape))
    return "rectangle " + stated(box->along) + " x " + stated(box->round) +
           field("corners", box->radius);
  if (const auto* slit = std::get_if<cutout::Slit>(&shape))
    return "slit " + stated(slit->length) + "; pierce " + std::string(name_of(slit->pierce)) +
           field("kerf", slit->width);
  const auto& drawing = std::get<cutout::Contour>(shape);
  return "contour of " + std::to_string(drawing.pieces.size()) + " pieces from " +
         stated(drawing.start) + (drawing.mirrored ? "; mirrored" : "");
}

std::string sink_words(const std::optional<cutout::Countersink>& sink) {
  if (!sink) return {};
  return field("countersink", sink->diameter) + field("sunk at", sink->angle * kDegPerRad);
}

std::string piece_words(const cutout::DrawnSegment& piece) {
  if (!piece.centre) return "line to " + stated(piece.to);
  return std::string("arc ") + (piece.clockwise ? "cw" : "ccw") + " to " + stated(piece.to) +
         " about " + stated(*piece.centre);
}

}  // namespace

std::string dstv_work_points(const cutout::Ground& ground) {
  return dstv_comment("work points: x " + stated(ground.start_work) + " and " +
                      stated(ground.finish_work));
}

std::string dstv_end(const bevel::TableSpec& cut, bool square, bool finish, double work) {
  if (cut.partners.size() != 1) return {};
  const auto* plane = std::get_if<joint::PlaneCutter>(&cut.partners.front());
  if (plane == nullptr) return {};
  const double height = plane->point.dot(plane->normal) / plane->normal.z();
  const double x = finish ? work - height : work + height;
  const auto words = square ? "square at x " + stated(x) : plane_words(cut, *plane, x, finish);
  if (words.empty()) return {};
  return dstv_comment(std::string("end ") + (finish ? "finish: " : "start: ") + words +
                      field("kerf", cut.kerf));
}

std::string dstv_corners(const section::Section& section) {
  return dstv_comment("corner radii: " + stated(section.corner) + " outside, " +
                      stated(section.inner_corner) + " inside");
}

std::string dstv_shape(const cutout::Spec& cutout, double x, double y) {
  auto out = dstv_comment("shape: " + shape_words(cutout.shape) +
                          (cutout.turn == 0.0 ? "" : field("turned", cutout.turn * kDegPerRad)) +
                          (cutout.as_cut ? "; as cut" : "") + sink_words(cutout.countersink) +
                          "; wall " + std::string(name_of(cutout.wall)) + "; tilt " +
                          std::string(name_of(cutout.tilt)) + field("at x", x) + field("y", y));
  if (const auto* drawing = std::get_if<cutout::Contour>(&cutout.shape))
    for (const auto& piece : drawing->pieces) out += dstv_comment(piece_words(piece));
  return out;
}

std::string dstv_countersink(const std::string& name, const cutout::Cone& cone) {
  return dstv_comment("countersink of " + dstv_text(name) +
                      " after its bore: " + stated(cone.diameter) + " mm outside, " +
                      stated(2.0 * cone.half * kDegPerRad) + " deg, " + stated(cone.depth()) +
                      " mm deep");
}

std::string dstv_lettering(const cutout::Lettering& text, std::string_view face, double y,
                           bool up) {
  const auto& spec = text.spec;
  if (spec.mirrored)
    throw UnfitOption{"format", "nc1 has no mirrored text, and a control would mark text " +
                                    spec.id + " as it is read: take dxf, step or gcode"};
  const double turn = spec.turn * kDegPerRad;
  return dstv_comment("text: at x " + stated(text.z) + field("girth", text.s) +
                      field("angle", turn) + field("height", spec.height) +
                      (spec.over_corner ? "; over corner" : "") + "; id " + dstv_text(spec.id)) +
         "SI\r\n  " + std::string(face) + dstv_field(text.z) + "u" + dstv_field(y) +
         dstv_field(up ? -turn : turn) + dstv_field(spec.height) + " " + spec.text + "\r\n";
}

}  // namespace tubecut::api
