#include "api/endpoints/cutout_codec.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "api/formats/bevel_table_formats.hpp"
#include "api/limits.hpp"
#include "api/wire/bevel_names.hpp"
#include "api/wire/cutout_names.hpp"
#include "api/wire/tables.hpp"
#include "core/cutout/rows.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::api {
namespace {

using cutout::Flat;

constexpr int kMost = static_cast<int>(cutout::kMostCutouts);
constexpr std::size_t kMostPieces = 500;
constexpr Range kSize{.min = 0.1, .max = 1e5};  // mm; no beam cuts a smaller one
constexpr Range kCorner{.min = 0.0, .max = 5e4};
constexpr Range kPlace{.min = -1e5, .max = 1e5};
constexpr Range kTurnDeg{.min = -360.0, .max = 360.0};
constexpr double kTolerance = 0.01;  // mm, where the sampling has none

/// What a part's cut-outs have in common, as far as it is known.
struct Common {
  Preset preset;
  const bevel::TableSpec& once;
};

Flat decode_place(Reader& in, std::string_view name) {
  const auto xy = in.column(name, {.min = 2, .max = 2}, kPlace);
  return xy.size() == 2 ? Flat(xy[0], xy[1]) : Flat(0.0, 0.0);
}

bool decode_as_cut(Reader& in) {
  static constexpr std::array kCorners{Option<bool>{"rounded", false},
                                       Option<bool>{"as_cut", true}};
  return in.choice("corners", kCorners, false);
}

cutout::Contour decode_contour_shape(Reader& in) {
  static constexpr std::array kKinds{Option<bool>{"line", false}, Option<bool>{"arc", true}};
  static constexpr std::array kSenses{Option<bool>{"ccw", false}, Option<bool>{"cw", true}};
  cutout::Contour out{.start = decode_place(in, "start_mm"), .pieces = {}};
  out.pieces = in.array("pieces", {.min = 1, .max = kMostPieces}, [](Reader& p) {
    cutout::Piece piece;
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

/// The least corner that the kerf allows, or 0 with corners as_cut or if a side is refused.
double default_radius(const Common& common, const cutout::Spec& spec, const cutout::Rectangle& r,
                      cutout::Lay lay) {
  const auto& tube = common.once.target;
  const bool sides = r.along > 0.0 && r.round > 0.0;
  if (spec.as_cut || !sides || !(tube.inner_radius() > 0.0)) return 0.0;
  const cutout::Laying laying(tube, lay, false);
  const auto box = bounds(turned(cutout::rectangle(r.along, r.round, 0.0), spec.turn));
  const double b = std::min(box.most.y(), 0.999 * tube.inner_radius());
  const double least = cutout::least_radius(laying, common.once.kerf, b);
  return std::min(least, 0.5 * std::min(r.along, r.round));
}

void decode_shape(Reader& in, const Common& common, cutout::Lay lay, cutout::Spec& out) {
  enum class Kind { circle, slot, rectangle, contour };
  static constexpr std::array kKinds{
      Option<Kind>{"circle", Kind::circle}, Option<Kind>{"slot", Kind::slot},
      Option<Kind>{"rectangle", Kind::rectangle}, Option<Kind>{"contour", Kind::contour}};
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
          in.number("corner_radius_mm", kCorner, default_radius(common, out, shape, lay));
      out.shape = shape;
      return;
    }
    case Kind::contour:
      out.as_cut = decode_as_cut(in);
      out.shape = decode_contour_shape(in);
      return;
  }
}

cutout::Anchor decode_anchor(Reader& in, double radius) {
  using Anchor = cutout::Anchor;
  Anchor out{.z = in.number("z_mm", kOffset)};
  out.from = in.choice("from", Anchor::From::start);
  out.zero = in.choice("z_zero", Anchor::Zero::work_point);
  in.note("face");
  if (in.has("face"))
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "face",
              .hint = "a round tube has no faces; give phi_deg or girth_mm"},
             in.find("face"));
  else if (const auto which = in.exactly_one({"phi_deg", "girth_mm"}))
    out.phi = *which == 0 ? in.angle("phi_deg", kAnyAngleDeg).rad()
                          : in.number("girth_mm", kPlace) / std::max(radius, 1.0);
  out.opposite = in.flag("opposite", false);
  return out;
}

/// A step round the tube, by its angle or its way on the outside.
std::optional<double> decode_turn(Reader& in, double radius, bool required) {
  in.note("pitch_deg");
  in.note("pitch_round_mm");
  if (!required && !in.has("pitch_deg") && !in.has("pitch_round_mm")) return std::nullopt;
  const auto which = in.exactly_one({"pitch_deg", "pitch_round_mm"});
  if (!which) return 0.0;
  const double turn = *which == 0 ? in.angle("pitch_deg", kTurnDeg).rad()
                                  : in.number("pitch_round_mm", kPlace) / std::max(radius, 1.0);
  if (turn == 0.0 && in.understood(*which == 0 ? "pitch_deg" : "pitch_round_mm"))
    in.issue({.code = ErrorCode::out_of_range,
              .pointer = *which == 0 ? "pitch_deg" : "pitch_round_mm",
              .got = Json{0.0},
              .hint = "a step of 0 puts them on each other"});
  return turn;
}

cutout::Grid decode_grid(Reader& in, double radius) {
  using Stagger = cutout::Grid::Stagger;
  cutout::Grid out;
  std::tie(out.along, out.pitch) = in.object("along", [](Reader& a) {
    const int count = a.integer("count", 1, kMost);
    return std::pair{count, a.number("pitch_mm", kPlace)};
  });
  std::tie(out.round, out.turn) = in.object("round", [&](Reader& r) {
    const int count = r.integer("count", 1, kMost);
    return std::pair{count, decode_turn(r, radius, true).value_or(0.0)};
  });
  out.stagger = in.choice("stagger", Stagger::none);
  in.note("stagger_mm");
  const bool along = out.stagger == Stagger::along;
  if (out.stagger != Stagger::none) {
    const double half = 0.5 * (along ? out.pitch : out.turn * radius);
    out.offset = in.number("stagger_mm", kPlace, half) / (along ? 1.0 : std::max(radius, 1.0));
  } else if (in.has("stagger_mm")) {
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "stagger_mm",
              .hint = "goes with stagger along or round"},
             in.find("stagger_mm"));
  }
  return out;
}

cutout::Pattern decode_pattern(Reader& in, double radius) {
  enum class Kind { linear, round, grid };
  static constexpr std::array kKinds{Option<Kind>{"linear", Kind::linear},
                                     Option<Kind>{"round", Kind::round},
                                     Option<Kind>{"grid", Kind::grid}};
  const auto kind = in.tag("kind", kKinds);
  if (!kind) return cutout::Once{};
  if (*kind == Kind::grid) return decode_grid(in, radius);
  const int count = in.integer("count", 1, 10 * kMost);
  if (*kind == Kind::round) {
    const auto turn = decode_turn(in, radius, false);
    return cutout::Round{.count = count, .turn = turn.value_or(kTwoPi / std::max(count, 1))};
  }
  const auto pitch = in.optional_number("pitch_mm", kPlace);
  const auto turn = decode_turn(in, radius, !pitch);
  if (pitch && *pitch == 0.0 && !turn)
    in.issue({.code = ErrorCode::out_of_range,
              .pointer = "pitch_mm",
              .got = Json{0.0},
              .hint = "a step of 0 puts them on each other"});
  return cutout::Linear{.count = count, .pitch = pitch.value_or(0.0), .turn = turn.value_or(0.0)};
}

cutout::Spec decode_cutout(Reader& in, const Common& common, std::set<std::string>& ids) {
  cutout::Spec out{.id = in.text("id")};
  if (in.understood("id") && !ids.insert(out.id).second)
    in.issue({.code = ErrorCode::duplicate_id,
              .pointer = "id",
              .got = Json{out.id},
              .hint = "another cut-out has it"});
  out.wall = in.choice("wall", cutout::Wall::normal);
  out.tilt = common.preset == Preset::tube_laser ? decode_no_tilt(in)
                                                 : in.choice("tilt", bevel::Tilt::axial);
  const auto lay = cutout::lay_of(out.wall, out.tilt);
  in.object("shape", [&](Reader& s) {
    decode_shape(s, common, lay, out);
    return 0;
  });
  const double radius = common.once.target.outer_radius;
  out.at = in.object("at", [&](Reader& a) { return decode_anchor(a, radius); });
  in.note("pattern");
  if (in.has("pattern"))
    out.pattern = in.object("pattern", [&](Reader& p) { return decode_pattern(p, radius); });
  return out;
}

}  // namespace

part::CutoutSpecs decode_cutouts(Reader& in, Preset preset, const bevel::TableSpec& once) {
  part::CutoutSpecs out{
      .kerf = once.kerf,
      .tolerance = once.sampling.tolerance ? once.sampling.tolerance->value : kTolerance,
      .most_lean = once.torch.max.rad()};
  in.note("cutouts");
  if (!in.has("cutouts")) return out;
  std::set<std::string> ids;
  out.all = in.array("cutouts", {.min = 0, .max = cutout::kMostCutouts}, [&](Reader& c) {
    return decode_cutout(c, {preset, once}, ids);
  });
  return out;
}

namespace {

/// How far a mould reaches from its anchor on the outside.
struct Reach {
  double phi_from, phi_to, z_from, z_to;
};
Reach reach_of(const bevel::Hole& rows) {
  const auto phi = std::ranges::minmax(rows.phi), z = std::ranges::minmax(rows.z);
  return {phi.min, phi.max, z.min, z.max};
}

void encode_instance(const part::PartSpec& spec, const part::Part& part,
                     const cutout::Instance& one, const Reach& reach, Writer& o) {
  const double radius = spec.target.outer_radius;
  const double middle = one.phi + 0.5 * (reach.phi_from + reach.phi_to);
  const double turn = math::whole_turn(middle) - middle;
  o.field("id", one.name);
  o.degrees("phi_deg", one.phi);
  o.field("girth_mm", radius * one.phi);
  o.field("z_mm", one.z);
  o.field("from_finish_mm", part.lengths.longest - one.z);
  o.field("z_from_mm", one.z + reach.z_from);
  o.field("z_to_mm", one.z + reach.z_to);
  o.field("girth_from_mm", radius * (one.phi + reach.phi_from + turn));
  o.field("girth_to_mm", radius * (one.phi + reach.phi_to + turn));
}

void encode_group(const part::PartSpec& spec, const part::Part& part,
                  const std::vector<std::size_t>& group, Writer& o) {
  const auto& layout = part.cutouts;
  const auto& first = layout.instances[group.front()];
  const auto& mould = layout.mould_of(first);
  o.field("id", spec.cutouts.all[first.asked].id);
  o.field("side", mould.laying.far() ? "far" : "near");
  o.field("wall", name_of(mould.laying.lay()));
  o.object("points", [&](Writer& p) { cutout_columns(cutout::placed(layout, first)).write(p); });
  o.field("b_sign", kBSignInPart);
  o.field("scrap", "inside");
  o.field("turns", 0);
  o.field("length_mm", mould.rows.length_total);
  o.field("area_outer_mm2", mould.taken.outer_area);
  o.field("area_inner_mm2", mould.taken.inner_area);
  o.field("volume_mm3", mould.taken.volume);
  o.field("mass_kg", mould.taken.volume * 1e-9 * spec.density);
  const auto reach = reach_of(mould.rows);
  o.array("instances", group, [&](Writer& each, std::size_t i) {
    each.object([&](Writer& w) { encode_instance(spec, part, layout.instances[i], reach, w); });
  });
}

/// The instances of one asked cut-out on one side are a group.
std::vector<std::vector<std::size_t>> groups_of(const cutout::Layout& layout) {
  std::vector<std::vector<std::size_t>> out;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> known;
  for (std::size_t i = 0; i < layout.instances.size(); ++i) {
    const auto& one = layout.instances[i];
    const auto [at, fresh] = known.try_emplace({one.asked, one.mould}, out.size());
    if (fresh) out.emplace_back();
    out[at->second].push_back(i);
  }
  return out;
}

void encode_web(std::string_view name, const part::CutoutWeb& web, const part::Part& part,
                Writer& w) {
  using Beside = part::CutoutWeb::Beside;
  const auto& all = part.cutouts.instances;
  w.object(name, [&](Writer& o) {
    o.field("width_mm", web.width);
    o.field("radius_mm", web.radius);
    o.field("cutout", all[web.cutout].name);
    o.field("beside", name_of(web.beside));
    if (web.beside == Beside::cutout) o.field("other", all[web.other].name);
    if (web.beside == Beside::hole) o.field("other_hole", web.other);
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

void encode_cutouts(const part::PartSpec& spec, const part::Part& part, bool seam_known,
                    Writer& w) {
  const auto& layout = part.cutouts;
  if (layout.empty()) return;
  w.array("cutouts", groups_of(layout), [&](Writer& each, const std::vector<std::size_t>& group) {
    each.object([&](Writer& o) { encode_group(spec, part, group, o); });
  });
  const auto& report = part.cutout_report;
  w.object("cutout_report", [&](Writer& o) {
    if (report.between) encode_web("web", *report.between, part, o);
    if (report.to_end) encode_web("to_end", *report.to_end, part, o);
    if (seam_known && report.to_seam)
      o.object("to_seam", [&](Writer& s) {
        s.field("girth_mm", report.to_seam->girth);
        s.field("cutout", layout.instances[report.to_seam->cutout].name);
      });
    o.object("net_section", [&](Writer& n) {
      n.field("z_mm", report.net.z);
      n.field("area_mm2", report.net.area);
      n.field("share", report.net.share);
    });
  });
}

std::vector<std::size_t> places_in_answer(const cutout::Layout& layout) {
  std::vector<std::size_t> out(layout.instances.size());
  std::size_t next = 0;
  for (const auto& group : groups_of(layout))
    for (const auto i : group) out[i] = next++;
  return out;
}

std::vector<Measure> measures_of_cutouts(const part::PartSpec& spec, const part::Part& part,
                                         bool seam_known) {
  std::vector<Measure> out;
  if (part.cutouts.empty()) return out;
  const auto& report = part.cutout_report;
  for (const auto* web : {&report.between, &report.to_end})
    if (*web) out.push_back({"min_web_mm", (*web)->width});
  if (report.to_end) out.push_back({"min_hole_to_end_mm", report.to_end->width});
  if (seam_known && report.to_seam) out.push_back({"min_seam_to_hole_mm", report.to_seam->girth});
  for (const auto& one : spec.cutouts.all)
    if (const auto size = cutout::least_size(one.shape)) {
      out.push_back({"min_diameter_mm", *size});
      out.push_back({"min_diameter_per_wall", *size / spec.target.wall});
    }
  return out;
}

}  // namespace tubecut::api
