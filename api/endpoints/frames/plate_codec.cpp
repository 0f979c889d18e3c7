#include "api/endpoints/frames/plate_codec.hpp"

#include <array>
#include <set>
#include <string>
#include <utility>

#include "api/endpoints/cutouts/anchor_codec.hpp"
#include "api/endpoints/cutouts/cutout_codec.hpp"
#include "api/endpoints/joint_codec.hpp"
#include "api/endpoints/section_bevel_table.hpp"
#include "api/limits.hpp"

namespace tubecut::api {
namespace {

constexpr Range kPlateSize{.min = 0.1, .max = 1e5};
constexpr Range kPlateCorner{.min = 0.0, .max = 5e4};
constexpr Range kPlatePlace{.min = -1e5, .max = 1e5};
constexpr Range kPlateThickness{.min = 0.5, .max = 500.0};
constexpr Range kPlateWeb{.min = 0.0, .max = 1e4};
constexpr Range kPlateTurnDeg{.min = -360.0, .max = 360.0};
constexpr Range kVectorComponent{.min = -1e6, .max = 1e6};
constexpr int kMostInRow = static_cast<int>(plate::kMostOpenings);

enum class PlateShape { circle, slot, rectangle, contour, dxf };
constexpr std::array kPlateShapes{
    Option<PlateShape>{"circle", PlateShape::circle}, Option<PlateShape>{"slot", PlateShape::slot},
    Option<PlateShape>{"rectangle", PlateShape::rectangle},
    Option<PlateShape>{"contour", PlateShape::contour}, Option<PlateShape>{"dxf", PlateShape::dxf}};

/// A drawing of a tube's wall has y against growing phi; on a plate y is up.
cutout::Contour upright(cutout::Contour contour) {
  contour.mirrored = !contour.mirrored;
  return contour;
}

/// Decodes an outline, or with `turn` the shape of an opening.
cutout::Shape decode_plate_shape(Reader& in, double* turn) {
  const auto kind = in.tag("kind", kPlateShapes);
  if (!kind) return cutout::Circle{1.0};
  if (turn != nullptr && *kind != PlateShape::circle)
    *turn = in.angle("angle_deg", kPlateTurnDeg, Angle{}).rad();
  switch (*kind) {
    case PlateShape::circle:
      return cutout::Circle{in.number("diameter_mm", kPlateSize)};
    case PlateShape::slot: {
      const double length = in.number("length_mm", kPlateSize);
      return cutout::Slot{length, in.number("width_mm", kPlateSize)};
    }
    case PlateShape::rectangle: {
      cutout::Rectangle out{.along = in.number("width_mm", kPlateSize)};
      out.round = in.number("height_mm", kPlateSize);
      out.radius = in.number("corner_radius_mm", kPlateCorner, 0.0);
      return out;
    }
    case PlateShape::contour:
      return upright(decode_contour_shape(in));
    case PlateShape::dxf:
      return upright(decode_dxf_shape(in));
  }
  return cutout::Circle{1.0};
}

/// Decodes a pitch; it may be absent for a single row.
double decode_pitch(Reader& in, const char* name, int count) {
  in.note(name);
  if (count == 1 && !in.has(name)) return 0.0;
  const double pitch = in.number(name, kPlatePlace);
  if (pitch == 0.0 && count > 1 && in.understood(name))
    in.issue({.code = ErrorCode::out_of_range,
              .pointer = name,
              .got = Json{0.0},
              .hint = "a step of 0 puts them on each other"});
  return pitch;
}

plate::Pattern decode_plate_pattern(Reader& in) {
  enum class Kind { grid, ring };
  static constexpr std::array kKinds{Option<Kind>{"grid", Kind::grid},
                                     Option<Kind>{"ring", Kind::ring}};
  const auto kind = in.tag("kind", kKinds);
  if (!kind) return plate::Once{};
  if (*kind == Kind::grid) {
    plate::Grid out{.columns = in.integer("columns", 1, kMostInRow)};
    out.rows = in.integer("rows", 1, kMostInRow);
    out.column_pitch = decode_pitch(in, "column_pitch_mm", out.columns);
    out.row_pitch = decode_pitch(in, "row_pitch_mm", out.rows);
    return out;
  }
  plate::Ring out{.count = in.integer("count", 2, kMostInRow)};
  out.diameter = in.number("diameter_mm", kPlateSize);
  out.angle = in.angle("angle_deg", kPlateTurnDeg, Angle{}).rad();
  return out;
}

plate::Opening decode_opening(Reader& in, std::set<std::string>& ids) {
  plate::Opening out{.id = decode_own_id(in, ids, "another cut-out has it")};
  out.shape = in.object("shape", [&](Reader& s) { return decode_plate_shape(s, &out.turn); });
  const auto at = in.column("at_mm", {.min = 2, .max = 2}, kPlatePlace);
  if (at.size() == 2) out.at = {at[0], at[1]};
  in.note("pattern");
  if (in.has("pattern")) out.pattern = in.object("pattern", decode_plate_pattern);
  return out;
}

plate::PlateSpec decode_plate(Reader& in) {
  plate::PlateSpec out{.name = in.text("id"), .outline = cutout::Circle{1.0}};
  out.point = in.vector3("point_mm", kOffset);
  out.normal = in.vector3("normal", kVectorComponent);
  out.up = in.vector3("up", kVectorComponent);
  out.thickness = in.number("thickness_mm", kPlateThickness);
  out.outline = in.object("outline", [](Reader& s) { return decode_plate_shape(s, nullptr); });
  in.note("cutouts");
  std::set<std::string> ids;
  if (in.has("cutouts"))
    out.openings = in.array("cutouts", {.min = 0, .max = plate::kMostOpenings},
                            [&](Reader& c) { return decode_opening(c, ids); });
  out.least_web = in.number("min_web_mm", kPlateWeb, 0.0);
  return out;
}

}  // namespace

std::vector<plate::PlateSpec> decode_plates(Reader& in) {
  in.note("plates");
  if (!in.has("plates")) return {};
  return in.array("plates", {.min = 0, .max = kMostPlates}, decode_plate);
}

void check_plate_joint(Reader& in, bool known_kind, const frame::StatedJoint& joint) {
  using Kind = frame::How::Kind;
  if (!known_kind) return;
  const auto kind = joint.how.kind;
  if (kind == Kind::mitre || kind == Kind::butt || kind == Kind::tab_slot) {
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "kind",
              .limit = Json{"set_on, set_in or through"},
              .hint = "a tube is set on a plate, set in it, or passes through it"},
             in.find("kind"));
    return;
  }
  const bool enters = kind != Kind::set_on;
  if (joint.how.hole != enters)
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "hole",
              .limit = Json{enters ? "cut" : "none"},
              .hint = enters ? "the tube is within the plate, so the plate has its hole"
                             : "a vent under a tube is one of the plate's cutouts"},
             in.find("hole"));
  if (enters)
    refuse_fields(in, {"groove", "contact", "root_face_mm", "tilt"},
                  "the hole in a plate is cut square to it, and the end in it flush");
  if (kind == Kind::through)
    refuse_fields(in, {"end"}, "a member that passes through has no end at the plate");
}

}  // namespace tubecut::api
