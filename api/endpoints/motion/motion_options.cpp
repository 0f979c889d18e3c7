#include "api/endpoints/motion/motion_options.hpp"

#include <string>
#include <variant>

#include "api/catalog/process.hpp"
#include "api/wire/motion_names.hpp"
#include "api/wire/tables.hpp"
#include "core/motion/path/upright.hpp"

namespace tubecut::api {
namespace {

using motion::Scrap;
using motion::Surface;

constexpr std::initializer_list<const char*> kSectionFields{"start_girth_mm", "lean_deg"};
constexpr std::string_view kNotRound = "belongs to a target that is not round";
constexpr Range kAnyGirth{.min = -1e6, .max = 1e6};  // mm

motion::Speed decode_speed(Reader& in) {
  if (in.exactly_one({"mm_min", "table"}) != 1) return in.number("mm_min", kTorchSpeed) / 60.0;
  motion::SpeedTable out;
  out.pairs = in.pairs("table", {.min = 2, .max = 1'000}, kBeam, kTorchSpeed);
  for (std::size_t i = 0; i < out.pairs.size(); ++i) {
    out.pairs[i].second /= 60.0;
    if (i > 0 && !(out.pairs[i].first > out.pairs[i - 1].first))
      in.issue({.code = ErrorCode::out_of_range,
                .pointer = "table/" + std::to_string(i) + "/0",
                .got = Json{out.pairs[i].first},
                .limit = Json{out.pairs[i - 1].first},
                .unit = "mm",
                .hint = "the metal in the beam must ascend"});
  }
  return out;
}

motion::Lead decode_lead(Reader& in) {
  motion::Lead out;
  out.radius = in.number("radius_mm", {.min = 0.1, .max = 1'000.0}, 5.0);
  out.sweep = in.angle("sweep_deg", {.min = 1.0, .max = 180.0}, Angle::deg(60));
  out.overcut = in.number("overcut_mm", {.min = 0.0, .max = 1'000.0}, 5.0);
  out.pierce_b = in.optional_angle("pierce_b_deg", {.min = 0.0, .max = 85.0});
  out.fan = in.number("fan_mm", {.min = 0.1, .max = 1'000.0}, 10.0);
  return out;
}

/// Of a section: the radius of a circle as long as its outside.
using EqualRadius = std::optional<double>;

/// Decodes a place around the tube: an angle, or the girth of a section.
Angle decode_around(Reader& in, const std::string& of, EqualRadius radius) {
  if (!radius) return in.angle(of + "phi_deg", kAnyAngleDeg);
  return Angle::rad(in.number(of + "girth_mm", kAnyGirth) / *radius);
}

motion::Sector decode_sector(Reader& in, EqualRadius radius) {
  motion::Sector out;
  out.from = decode_around(in, "from_", radius);
  out.to = decode_around(in, "to_", radius);
  out.back_up = in.number("back_up_mm", {.min = 0.0, .max = 1'000.0}, 5.0);
  return out;
}

motion::Expert decode_expert(Reader& in) {
  motion::Expert out;
  out.optimism = in.number("optimism", {.min = 1.0, .max = 10.0}, 3.0);
  if (const auto filter =
          in.nullable_number("filter_ms", {.min = 0.0, .max = 10'000.0, .open_min = true}))
    out.filter = *filter * 1e-3;
  out.sag_warning = in.flag("sag_warning", true);
  return out;
}

/// Decodes the fields that only a contour has: start, direction, leads, a sector.
void decode_course(Reader& in, bool hole, EqualRadius radius, bool certain, motion::Motion& out) {
  const char* const start = radius ? "start_girth_mm" : "start_phi_deg";
  if (in.find(start) != nullptr && *in.find(start) == Json{"auto"}) {
    in.note(start);
    in.put(start, Json{"auto"});
    out.start.at = motion::Start::At::automatic;
  } else if (radius) {
    out.start = {motion::Start::At::phi, Angle::rad(in.number(start, kAnyGirth, 0.0) / *radius)};
  } else if (in.has(start) || !hole) {  // a hole need not have a point at phi 0
    out.start = {motion::Start::At::phi, in.angle(start, kAnyAngleDeg, Angle{})};
  }
  in.note(start);
  out.direction = in.choice("direction", motion::Direction::ccw);
  if (!in.is_null("lead")) out.lead = in.optional_object("lead", decode_lead);
  if (!in.is_null("sector"))
    out.sector = in.optional_object("sector", [&](Reader& s) {
      if (!certain) s.silence();  // its members follow from the target
      return decode_sector(s, radius);
    });
}

void decode_tolerances(Reader& in, motion::Motion& out) {
  out.eps_tip = in.number("eps_tip_mm", {.min = 1e-3, .max = 10.0}, 0.1);
  out.eps_b = in.angle("eps_b_deg", {.min = 0.01, .max = 10.0}, Angle::deg(0.5));
  out.jerk = in.flag("jerk", true);
}

/// Decodes heights, for a machine that lifts its torch; otherwise its control has them.
void decode_heights(Reader& in, const motion::Machine& machine, torch::Setup& out) {
  if (const auto lift = motion::lift_of(machine)) {
    out.cut_height = lift->standoff;
    out.clearance = in.number("clearance_mm", kTipClearance, torch::kClearance);
    const Range below{.min = 0.0, .max = out.clearance};
    if (in.understood("clearance_mm"))
      out.pierce_height = in.number("pierce_height_mm", below, out.cut_height);
    in.note("pierce_height_mm");
    return;
  }
  for (const auto* const name : {"clearance_mm", "pierce_height_mm"}) {
    in.note(name);
    if (in.has(name))
      in.issue({.code = ErrorCode::unsupported_combination,
                .pointer = name,
                .hint = "the machine has no axis for the torch's height"},
               in.find(name));
  }
}

torch::Tabs decode_tabs(Reader& in) {
  torch::Tabs out;
  out.count = in.integer("count", 1, torch::kMostTabs);
  out.width = in.number("width_mm", kTabWidth);
  out.of = in.choice("of", torch::Tabs::Of::last);
  return out;
}

/// Returns the speed of the strokes, mm/s, if it is given.
std::optional<double> decode_mark_options(Reader& in) {
  const auto speed = in.optional_number("speed_mm_min", kTorchSpeed);
  return speed ? std::optional(*speed / 60.0) : std::nullopt;
}

Angle decode_lean(Reader& in) {
  return in.angle("lean_deg", {.min = 0.05, .max = 5.0}, Angle::deg(1.0));
}

/// Reads `speed_on` of a section, whose speed is that on the outside.
void refuse_inner_speed(Reader& in) {
  if (in.choice("speed_on", Surface::outer) != Surface::inner) return;
  in.issue({.code = ErrorCode::unsupported_combination,
            .pointer = "speed_on",
            .got = Json{"inner"},
            .limit = Json{"outer"},
            .hint = "the speed on a bore requires a round target"},
           in.find("speed_on"));
}

}  // namespace

motion::Motion decode_motion(Reader& in, const CutSource& cut, bool certain) {
  motion::Motion out;
  const auto* contour = std::get_if<motion::CutPath>(&cut);
  const auto* section = std::get_if<SectionCutRequest>(&cut);
  const bool has_contour = contour != nullptr || std::holds_alternative<BevelTableRequest>(cut);
  out.speed = in.object("speed", decode_speed);
  if (has_contour) out.speed_on = in.choice("speed_on", Surface::outer);
  if (section != nullptr) {
    refuse_fields(in, {"start_phi_deg"}, "a target that is not round starts at start_girth_mm");
    refuse_inner_speed(in);
  }
  if (!certain)
    for (const auto* const name : kSectionFields) in.note(name);
  else if (has_contour)
    refuse_fields(in, kSectionFields, kNotRound);
  decode_tolerances(in, out);
  if (section != nullptr) out.lean = decode_lean(in);
  out.compare = in.flag("compare", false);
  const bool closed = contour == nullptr || contour->closed;
  if (has_contour)
    decode_course(in, !closed || (contour != nullptr && contour->scrap == Scrap::inside), {},
                  certain, out);
  if (section != nullptr)
    decode_course(in, false, motion::equal_radius(section->section.section), certain, out);
  out.expert = in.defaulted_object("expert", decode_expert);
  return out;
}

PartMotion decode_part_motion(Reader& in, const motion::Machine& machine, Tube tube) {
  PartMotion out;
  auto& setup = out.setup;
  out.motion.speed = in.object("speed", decode_speed);
  if (tube == Tube::section) {
    refuse_inner_speed(in);
    refuse_fields(in, {"start_phi_deg", "tabs"},
                  "a target that is not round is cut without tabs, from a flat or its first point");
    out.motion.lean = decode_lean(in);
  } else {
    out.motion.speed_on = in.choice("speed_on", Surface::outer);
    if (tube == Tube::round) refuse_fields(in, {"lean_deg"}, kNotRound);
  }
  in.note("lean_deg");
  decode_tolerances(in, out.motion);
  setup.start = in.optional_angle("start_phi_deg", kAnyAngleDeg);
  if (!in.is_null("lead")) setup.lead = in.defaulted_object("lead", decode_lead);
  setup.pierce_delay = in.number("pierce_delay_s", kPierceDelay, 0.0);
  if (!in.is_null("tabs")) setup.tabs = in.optional_object("tabs", decode_tabs);
  if (!in.is_null("marks"))
    if (const auto marks = in.optional_object("marks", decode_mark_options)) {
      out.marks = true;
      setup.mark_speed = *marks;
    }
  decode_heights(in, machine, setup);
  out.motion.expert = in.defaulted_object("expert", decode_expert);
  return out;
}

}  // namespace tubecut::api
