#include "api/endpoints/cutouts/cutout_codec.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "api/endpoints/cutouts/anchor_codec.hpp"
#include "api/endpoints/cutouts/dxf_contour.hpp"
#include "api/endpoints/cutouts/text_codec.hpp"
#include "api/endpoints/section_bevel_table.hpp"
#include "api/limits.hpp"
#include "api/wire/bevel_names.hpp"
#include "api/wire/cutout_names.hpp"
#include "api/wire/problem.hpp"
#include "core/cutout/rows.hpp"
#include "core/cutout/sizes.hpp"

namespace tubecut::api {
namespace {

using cutout::Flat;

constexpr int kMost = static_cast<int>(cutout::kMostCutouts);
constexpr std::size_t kMostPieces = 500;
constexpr Range kSize{.min = 0.1, .max = 1e5};  // mm; no beam cuts a smaller one
constexpr Range kCorner{.min = 0.0, .max = 5e4};
constexpr Range kPlace{.min = -1e5, .max = 1e5};
constexpr Range kTurnDeg{.min = -360.0, .max = 360.0};
constexpr Range kSinkDeg{.min = 30.0, .max = 150.0};
constexpr double kTolerance = 0.01;  // mm, where the sampling has none

/// What a part's cut-outs have in common, as far as it is known.
struct Common {
  Preset preset;
  const bevel::TableSpec& once;
  const section::Section* section;  // nullptr of a round tube
  bool sure;                        // the request's tube was understood
  bool on_each_face = false;        // within a pattern over faces

  [[nodiscard]] AnchorTube tube() const { return {once.target.outer_radius, section, sure}; }
  [[nodiscard]] double radius() const { return tube().radius(); }
};

constexpr std::string_view kRoundTube = "requires a round target; ";

Flat decode_place(Reader& in, std::string_view name) {
  const auto xy = in.column(name, {.min = 2, .max = 2}, kPlace);
  return xy.size() == 2 ? Flat(xy[0], xy[1]) : Flat(0.0, 0.0);
}

bool decode_as_cut(Reader& in) {
  static constexpr std::array kCorners{Option<bool>{"rounded", false},
                                       Option<bool>{"as_cut", true}};
  return in.choice("corners", kCorners, false);
}

/// The least corner that the kerf allows, or 0 with corners as_cut or if a side is refused.
double default_radius(const Common& common, const cutout::Spec& spec, const cutout::Rectangle& r) {
  const auto& tube = common.once.target;
  const bool sides = r.along > 0.0 && r.round > 0.0;
  if (spec.as_cut || !sides) return 0.0;
  const double most = 0.5 * std::min(r.along, r.round), kerf = common.once.kerf;
  const auto chain =
      turned(cutout::rectangle(r.along, r.round, std::min(0.5 * kerf, most)), spec.turn);
  if (common.section != nullptr)
    return std::min(cutout::least_corner(spec, chain, section::Wall(*common.section), kerf), most);
  if (!(tube.inner_radius() > 0.0)) return 0.0;
  const cutout::Laying laying(tube, cutout::lay_of(spec.wall, spec.tilt), false);
  const double b = std::min(bounds(chain).most.y(), 0.999 * tube.inner_radius());
  return std::min(cutout::least_radius(laying, kerf, b), most);
}

/// Decodes `shape`, once the wall, the place and the pattern are known. `placed`: they and the tube
/// were understood, so that a default may be calculated from them.
void decode_shape(Reader& in, const Common& common, bool placed, cutout::Spec& out) {
  enum class Kind { circle, slot, rectangle, contour, dxf, slit };
  static constexpr std::array kKinds{Option<Kind>{"circle", Kind::circle},
                                     Option<Kind>{"slot", Kind::slot},
                                     Option<Kind>{"rectangle", Kind::rectangle},
                                     Option<Kind>{"contour", Kind::contour},
                                     Option<Kind>{"dxf", Kind::dxf},
                                     Option<Kind>{"slit", Kind::slit}};
  const auto kind = in.tag("kind", kKinds);
  if (!kind) return;
  out.turn = in.angle("angle_deg", kTurnDeg, Angle{}).rad();
  switch (*kind) {
    case Kind::circle:
      out.shape = cutout::Circle{in.number("diameter_mm", kSize)};
      return;
    case Kind::slot: {
      const double length = in.number("length_mm", kSize);
      out.shape = cutout::Slot{length, in.number("width_mm", kSize)};
      return;
    }
    case Kind::rectangle: {
      out.as_cut = decode_as_cut(in);
      cutout::Rectangle shape{.along = in.number("along_mm", kSize)};
      shape.round = in.number("round_mm", kSize);
      shape.radius =
          in.number("corner_radius_mm", kCorner, placed ? default_radius(common, out, shape) : 0.0);
      out.shape = shape;
      return;
    }
    case Kind::contour:
      out.as_cut = decode_as_cut(in);
      out.shape = decode_contour_shape(in);
      return;
    case Kind::dxf:
      out.as_cut = decode_as_cut(in);
      out.shape = decode_dxf_shape(in);
      return;
    case Kind::slit: {
      const double length = in.number("length_mm", kSize);
      out.shape = cutout::Slit{.length = length,
                               .width = common.once.kerf,
                               .pierce = in.choice("pierce", cutout::Slit::Pierce::middle)};
      return;
    }
  }
}

/// A step round the tube, by its angle or its way on the outside; on a section, by its way.
std::optional<double> decode_turn(Reader& in, const Common& common, bool required) {
  in.note("pitch_round_mm");
  const bool round = !common.on_each_face && (common.section == nullptr || !common.sure);
  if (round)
    in.note("pitch_deg");
  else
    refuse_fields(in, {"pitch_deg"},
                  std::string(kRoundTube) + "give pitch_round_mm, or pattern faces");
  if (!round && in.has("pitch_deg")) return std::nullopt;
  const bool by_angle = round && in.has("pitch_deg");
  if (!required && !by_angle && !in.has("pitch_round_mm")) return std::nullopt;
  const auto which =
      round ? in.exactly_one({"pitch_deg", "pitch_round_mm"}) : std::optional<std::size_t>(1);
  if (!which) return 0.0;
  const double turn = *which == 0 ? in.angle("pitch_deg", kTurnDeg).rad()
                                  : in.number("pitch_round_mm", kPlace) / common.radius();
  if (turn == 0.0 && in.understood(*which == 0 ? "pitch_deg" : "pitch_round_mm"))
    in.issue({.code = ErrorCode::out_of_range,
              .pointer = *which == 0 ? "pitch_deg" : "pitch_round_mm",
              .got = Json{0.0},
              .hint = "a step of 0 puts them on each other"});
  return turn;
}

cutout::Grid decode_grid(Reader& in, const Common& common) {
  using Stagger = cutout::Grid::Stagger;
  cutout::Grid out;
  std::tie(out.along, out.pitch) = in.object("along", [](Reader& a) {
    const int count = a.integer("count", 1, kMost);
    return std::pair{count, a.number("pitch_mm", kPlace)};
  });
  std::tie(out.round, out.turn) = in.object("round", [&](Reader& r) {
    const int count = r.integer("count", 1, kMost);
    return std::pair{count, decode_turn(r, common, true).value_or(0.0)};
  });
  out.stagger = in.choice("stagger", Stagger::none);
  in.note("stagger_mm");
  const bool along = out.stagger == Stagger::along;
  if (out.stagger != Stagger::none) {
    const double half = 0.5 * (along ? out.pitch : out.turn * common.radius());
    out.offset = in.number("stagger_mm", kPlace, half) / (along ? 1.0 : common.radius());
  } else {
    refuse_fields(in, {"stagger_mm"}, "goes with stagger along or round");
  }
  return out;
}

cutout::Linear decode_linear(Reader& in, const Common& common) {
  const int count = in.integer("count", 1, 10 * kMost);
  const auto pitch = in.optional_number("pitch_mm", kPlace);
  const auto turn = decode_turn(in, common, false);
  if (!in.has("pitch_mm") && !in.has("pitch_deg") && !in.has("pitch_round_mm"))
    in.issue(
        {.code = ErrorCode::missing_field,
         .pointer = "pitch_mm",
         .hint = common.section == nullptr
                     ? "give a step: pitch_mm along, pitch_deg or pitch_round_mm round the tube"
                     : "give a step: pitch_mm along, pitch_round_mm round the tube"});
  if (pitch && *pitch == 0.0 && !turn)
    in.issue({.code = ErrorCode::out_of_range,
              .pointer = "pitch_mm",
              .got = Json{0.0},
              .hint = "a step of 0 puts them on each other"});
  return {.count = count, .pitch = pitch.value_or(0.0), .turn = turn.value_or(0.0)};
}

cutout::Faces decode_faces(Reader& in, const Common& common) {
  cutout::Faces out;
  std::set<int> before;
  for (const double face : in.column("faces", {.min = 1, .max = 4}, {.min = 1.0, .max = 4.0})) {
    const int number = static_cast<int>(face);
    if (number != face || !before.insert(number).second)
      in.issue({.code = ErrorCode::bad_choice,
                .pointer = "faces",
                .got = Json{face},
                .hint = "whole numbers from 1 to 4, each once"});
    out.faces.push_back(number);
  }
  in.note("each");
  if (!in.has("each")) return out;
  enum class Kind { linear, grid };
  static constexpr std::array kKinds{Option<Kind>{"linear", Kind::linear},
                                     Option<Kind>{"grid", Kind::grid}};
  in.object("each", [&](Reader& e) {
    const auto kind = e.tag("kind", kKinds);
    if (!kind) return 0;
    auto here = common;
    here.on_each_face = true;
    if (*kind == Kind::grid)
      out.each = decode_grid(e, here);
    else
      out.each = decode_linear(e, here);
    return 0;
  });
  return out;
}

cutout::Round decode_round(Reader& in, const Common& common) {
  const int count = in.integer("count", 1, 10 * kMost);
  const auto turn = decode_turn(in, common, false);
  return {.count = count, .turn = turn.value_or(kTwoPi / std::max(count, 1))};
}

cutout::Pattern decode_pattern(Reader& in, const Common& common) {
  enum class Kind { linear, round, grid, faces };
  static constexpr std::array kKinds{
      Option<Kind>{"linear", Kind::linear}, Option<Kind>{"round", Kind::round},
      Option<Kind>{"grid", Kind::grid}, Option<Kind>{"faces", Kind::faces}};
  const auto kind = in.tag("kind", kKinds);
  if (!kind) return cutout::Once{};
  const bool on_section = common.section != nullptr;
  const auto unfit = [&](const char* hint) {
    if (!common.sure) return;
    in.issue({.code = ErrorCode::unsupported_combination, .pointer = "kind", .hint = hint},
             in.find("kind"));
  };
  switch (*kind) {
    case Kind::linear:
      return decode_linear(in, common);
    case Kind::grid:
      return decode_grid(in, common);
    case Kind::round:
      if (on_section) unfit("requires a round target; pattern faces repeats on several faces");
      return decode_round(in, {common.preset, common.once, nullptr, common.sure});
    case Kind::faces:
      if (!on_section) unfit("a round tube has no faces; pattern round goes round it");
      return decode_faces(in, common);
  }
  return cutout::Once{};
}

/// Decodes `tilt`. A countersink's default is free, because no other torch cuts a cone.
bevel::Tilt decode_cutout_tilt(Reader& in, Preset preset) {
  if (preset == Preset::tube_laser) return decode_no_tilt(in);
  if (!in.has("countersink")) return in.choice("tilt", bevel::Tilt::axial);
  const auto tilt = in.choice("tilt", bevel::Tilt::free);
  if (in.understood("tilt") && tilt != bevel::Tilt::free)
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "tilt",
              .got = Json{std::string(name_of(tilt))},
              .limit = Json{"free"},
              .hint = "on a countersink the torch leans to all sides"},
             in.find("tilt"));
  return tilt;
}

/// Decodes `countersink`, once the wall and the shape are known.
void decode_countersink(Reader& in, Preset preset, cutout::Spec& out) {
  if (preset == Preset::tube_laser)
    return refuse_fields(in, {"countersink"}, "the torch of a tube laser does not tilt");
  in.note("countersink");
  if (!in.has("countersink")) return;
  const bool circle = std::holds_alternative<cutout::Circle>(out.shape);
  const bool straight = out.wall != cutout::Wall::developed;
  if (in.sound("shape") && in.understood("wall") && !(circle && straight)) {
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "countersink",
              .hint = circle ? "requires wall normal or through" : "requires a circle"},
             in.find("countersink"));
    return;
  }
  out.countersink = in.object("countersink", [](Reader& c) {
    const double diameter = c.number("diameter_mm", kSize);
    return cutout::Countersink{diameter, c.angle("angle_deg", kSinkDeg).rad()};
  });
}

cutout::Spec decode_cutout(Reader& in, const Common& common, std::set<std::string>& ids) {
  cutout::Spec out{.id = decode_own_id(in, ids, "another cut-out has it")};
  out.wall = in.choice("wall", cutout::Wall::normal);
  out.tilt = decode_cutout_tilt(in, common.preset);
  out.at = in.object("at", [&](Reader& a) { return decode_anchor(a, common.tube()); });
  in.note("pattern");
  if (in.has("pattern"))
    out.pattern = in.object("pattern", [&](Reader& p) { return decode_pattern(p, common); });
  const bool placed =
      common.sure && in.sound("wall") && in.sound("tilt") && in.sound("at") && in.sound("pattern");
  in.object("shape", [&](Reader& s) {
    decode_shape(s, common, placed, out);
    return 0;
  });
  decode_countersink(in, common.preset, out);
  return out;
}

}  // namespace

cutout::Contour decode_contour_shape(Reader& in) {
  static constexpr std::array kKinds{Option<bool>{"line", false}, Option<bool>{"arc", true}};
  static constexpr std::array kSenses{Option<bool>{"ccw", false}, Option<bool>{"cw", true}};
  cutout::Contour out{.start = decode_place(in, "start_mm"), .pieces = {}};
  out.pieces = in.array("pieces", {.min = 1, .max = kMostPieces}, [](Reader& p) {
    cutout::DrawnSegment piece;
    const auto arc = p.tag("kind", kKinds);
    piece.to = decode_place(p, "to_mm");
    if (arc.value_or(false)) {
      piece.centre = decode_place(p, "centre_mm");
      piece.clockwise = p.choice("sense", kSenses);
    }
    return piece;
  });
  out.mirrored = in.flag("mirrored", false);
  return out;
}

cutout::Contour decode_dxf_shape(Reader& in) {
  const bool mirrored = in.flag("mirrored", false);
  const auto* field = in.find("dxf");
  const auto* text = field == nullptr ? nullptr : field->as<std::string>();
  in.note("dxf");
  if (text == nullptr || text->empty() || text->size() > kLongestDxf) {
    in.issue({.code = field == nullptr  ? ErrorCode::missing_field
                      : text == nullptr ? ErrorCode::wrong_type
                                        : ErrorCode::bad_text,
              .pointer = "dxf",
              .limit = Json{static_cast<double>(kLongestDxf)},
              .hint = "the text of a DXF file, of 1 to that many bytes, is required"},
             field);
    return {};
  }
  in.put("dxf", Json{*text});
  auto read = read_dxf_contour(*text);
  if (!read) {
    in.issue(field_issue(read.error().issues.front(), "dxf"));
    return {};
  }
  read->mirrored = mirrored;
  return *std::move(read);
}

part::CutoutSpecs decode_cutouts(Reader& in, Preset preset, const bevel::TableSpec& once,
                                 const section::Section* section, bool sure) {
  part::CutoutSpecs out{
      .kerf = once.kerf,
      .tolerance = once.sampling.tolerance ? once.sampling.tolerance->value : kTolerance,
      .most_lean = once.torch.max.rad(),
      .most_swing = std::min(once.torch.max.rad(), -once.torch.min.rad())};
  const Common common{preset, once, section, sure};
  out.texts = decode_texts(in, common.tube());
  in.note("cutouts");
  if (!in.has("cutouts")) return out;
  std::set<std::string> ids;
  out.all = in.array("cutouts", {.min = 0, .max = cutout::kMostCutouts},
                     [&](Reader& c) { return decode_cutout(c, common, ids); });
  return out;
}

}  // namespace tubecut::api
