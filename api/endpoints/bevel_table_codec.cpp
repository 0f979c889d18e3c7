#include "api/endpoints/bevel_table_codec.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "api/catalog/machines.hpp"
#include "api/limits.hpp"
#include "api/wire/bevel_names.hpp"
#include "api/wire/column_choice.hpp"
#include "api/wire/tables.hpp"
#include "core/bevel/smoothing/smoothed_area.hpp"

namespace tubecut::api {
namespace {

using bevel::Contact;
using bevel::Dihedral;
using bevel::GrooveRule;
using bevel::RootSurface;

constexpr std::size_t kMostZones = 16;
constexpr Range kTorchDeg{.min = -89.0, .max = 89.0};

/// Two angles of an array [from, to], each within 0..180 or less than 90 deg.
std::pair<Angle, Angle> decode_pair(Reader& in, std::string_view name, Range range) {
  const auto values = in.angle_column(name, {.min = 2, .max = 2}, range);
  if (values.size() != 2) return {};
  return {Angle::rad(values[0]), Angle::rad(values[1])};
}

bevel::ZonedGroove decode_zones(Reader& in) {
  bevel::ZonedGroove out;
  in.optional_text("source");
  out.zones = in.array("zones", {.min = 1, .max = kMostZones}, [](Reader& z) {
    bevel::GrooveZone zone;
    zone.id = z.text("id");
    std::tie(zone.dihedral_from, zone.dihedral_to) =
        decode_pair(z, "dihedral_deg", {.min = 0.0, .max = 180.0});
    std::tie(zone.groove_from, zone.groove_to) =
        decode_pair(z, "groove_deg", {.min = 0.0, .max = 90.0, .open_max = true});
    zone.root_gap = z.optional_number("root_gap_mm", {.min = 0.0, .max = 50.0});
    return zone;
  });
  out.overlap = in.angle("overlap_deg", {.min = 0.0, .max = 90.0}, Angle{});
  return out;
}

using DecodeGroove = GrooveRule (*)(Reader&);
constexpr std::array kRules{
    Option<DecodeGroove>{"half_dihedral",
                         [](Reader& in) -> GrooveRule {
                           return bevel::HalfDihedral{
                               in.angle("cap_deg", {.min = 0.0, .max = 90.0}, Angle::deg(45))};
                         }},
    Option<DecodeGroove>{"fixed",
                         [](Reader& in) -> GrooveRule {
                           return bevel::FixedGroove{
                               in.angle("angle_deg", {.min = 0.0, .max = 90.0, .open_max = true})};
                         }},
    Option<DecodeGroove>{"none", [](Reader&) -> GrooveRule { return bevel::NoGroove{}; }},
    Option<DecodeGroove>{"square", [](Reader&) -> GrooveRule { return bevel::SquareCut{}; }},
    Option<DecodeGroove>{"zones", [](Reader& in) -> GrooveRule { return decode_zones(in); }}};

/// Decodes the limits of a machine's swing axis B at a cutting speed.
bevel::BevelRateLimits decode_swing(Reader& in) {
  const auto machine = decode_machine_choice(in, "machine");
  const double speed = in.number("speed_mm_min", {.min = 1.0, .max = 60'000.0}) / 60.0;
  const double use = in.number("use", {.min = 0.01, .max = 1.0}, 0.8);
  if (!in.understood("machine")) return {};
  for (const auto& axis : machine.axes) {
    if (axis.name != "B") continue;
    const auto limits =
        bevel::bevel_rate_limits(axis.v_max * kRadPerDeg, axis.a_max * kRadPerDeg, speed, use);
    if (limits) return *limits;
  }
  in.issue({.code = ErrorCode::unsupported_combination,
            .pointer = "machine",
            .limit = Json{"B"},
            .hint = "limits need a machine with a swing axis named B"},
           in.find("machine"));
  return {};
}

bevel::EnvelopeSmoothing decode_envelope(Reader& in) {
  bevel::EnvelopeSmoothing out;
  bool by_machine = false;
  in.object("limits", [&](Reader& l) {
    const auto which = l.exactly_one({"max_slope_deg_per_mm", "machine"});
    by_machine = which == 1;
    if (!which) {
      l.silence();
    } else if (by_machine) {
      out.limits = decode_swing(l);
    } else {
      const Range limit{.min = 1e-6, .max = 1e6};
      out.limits.slope = l.number("max_slope_deg_per_mm", limit) * kRadPerDeg;
      out.limits.curvature = l.number("max_curvature_deg_per_mm2", limit) * kRadPerDeg;
    }
    return 0;
  });
  out.along = in.choice("along", by_machine ? bevel::Along::length : bevel::Along::developed);
  if (by_machine && out.along != bevel::Along::length)
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "along",
              .limit = Json{"length"},
              .hint = "limits from a machine and a speed hold along the true length"},
             in.find("along"));
  out.refine = in.flag("refine", true);
  return out;
}

bevel::HermiteSmoothing decode_hermite(Reader& in) {
  bevel::HermiteSmoothing out;
  if (in.find("transition_points") != nullptr && *in.find("transition_points") == Json{"auto"}) {
    in.note("transition_points");
    in.put("transition_points", Json{"auto"});
    out.transition_points.reset();
  } else {
    out.transition_points = in.integer("transition_points", 2, 5'000);
  }
  return out;
}

/// The land at the root, and how far the cut keeps off.
void decode_stand_off(Reader& in, bool known, bevel::TableSpec& out) {
  out.root_face = in.number("root_face_mm", {.min = 0.0, .max = limit::wall_max_mm}, 0.0);
  if (known && out.root_face > 0.0 && out.contact != Contact::inner)
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "root_face_mm",
              .hint = "a root face requires contact inner"},
             in.find("root_face_mm"));
  out.root_gap = in.number("root_gap_mm", {.min = 0.0, .max = 50.0}, 0.0);
  out.coating = in.number("coating_mm", {.min = 0.0, .max = 50.0}, 0.0);
}

void encode_events(const bevel::Table& out, Writer& w) {
  struct Placed {
    const joint::Event* event;
    bool outer;
  };
  std::vector<Placed> events;
  for (const auto& event : out.inner_events) events.push_back({&event, false});
  for (const auto& event : out.outer_events) events.push_back({&event, true});
  w.array("events", events, [](Writer& each, const Placed& placed) {
    encode_event(*placed.event, placed.outer, each);
  });
}

/// Encodes the steps of the smoother's input, and the published method's treatment of them.
void encode_steps(const bevel::Table& out, Writer& w) {
  w.array("mutations", out.mutations, [](Writer& each, const bevel::Table::Step& m) {
    each.object([&](Writer& o) {
      o.degrees("phi_deg", m.phi);
      o.degrees("step_deg", m.step);
    });
  });
  w.array("windows", out.windows, [](Writer& each, const bevel::Table::Window& v) {
    each.object([&](Writer& o) {
      o.degrees("phi_deg", v.phi);
      o.degrees("step_deg", v.step);
      o.field("kept", v.kept_before ? "before" : "after");
      o.degrees("from_phi_deg", v.from);
      o.degrees("to_phi_deg", v.to);
      o.degrees("slope_start_deg_per_mm", v.slope_start);
      o.degrees("slope_end_deg_per_mm", v.slope_end);
    });
  });
}

}  // namespace

void encode_limits(const bevel::TableSpec& spec, Writer& o) {
  o.degrees("mutation_limit_deg", spec.mutation_limit.rad());
  const auto* envelope = std::get_if<bevel::EnvelopeSmoothing>(&spec.smoothing);
  if (envelope == nullptr) return;
  o.degrees("max_slope_deg_per_mm", envelope->limits.slope);
  o.degrees("max_curvature_deg_per_mm2", envelope->limits.curvature);
}

void check_combination(const bevel::TableSpec& s, Reader& in) {
  const bool outer = s.root_surface == RootSurface::outer;
  const bool weld = s.dihedral == Dihedral::weld_side;
  if (!weld && !(outer && s.contact == Contact::none))
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "dihedral",
              .limit = Json{"weld_side"},
              .hint = "inside and as_published require root_surface outer and no contact"},
             in.find("dihedral"));
  const bool goes = s.contact == Contact::none || (s.contact == Contact::outer) == outer;
  if (goes) return;
  in.issue({.code = ErrorCode::unsupported_combination,
            .pointer = "contact",
            .got = Json{"inner"},
            .limit = Json{outer ? "outer|none" : "inner|auto|none"},
            .hint = outer ? "contact inner and auto require root_surface inner"
                          : "contact outer requires root_surface outer"},
           in.find("contact"));
}

GrooveRule decode_groove(Reader& in, bool zones) {
  const auto rule = zones ? in.tag("rule", kRules) : in.tag("rule", first<4>(kRules));
  return rule ? (*rule)(in) : bevel::NoGroove{};
}

bevel::TorchRange decode_torch(Reader& in) {
  bevel::TorchRange out;
  out.min = in.angle("min_deg", kTorchDeg, Angle::deg(-80));
  out.max = in.angle("max_deg", kTorchDeg, Angle::deg(80));
  if (!(out.min < out.max))
    in.issue({.code = ErrorCode::out_of_range,
              .pointer = "max_deg",
              .limit = Json{out.min.deg()},
              .unit = "deg",
              .hint = "must be greater than min_deg"},
             in.find("max_deg"));
  return out;
}

Smoothing decode_smoothing(Reader& in) {
  using Decode = bevel::Smoothing (*)(Reader&);
  static constexpr std::array kMethods{
      Option<Decode>{"envelope", [](Reader& m) -> bevel::Smoothing { return decode_envelope(m); }},
      Option<Decode>{"hermite", [](Reader& m) -> bevel::Smoothing { return decode_hermite(m); }},
      Option<Decode>{"none", [](Reader&) -> bevel::Smoothing { return bevel::NoSmoothing{}; }}};
  Smoothing out;
  const auto method = in.tag("method", kMethods);
  out.mutation_limit =
      in.angle("mutation_limit_deg", {.min = 0.0, .max = 180.0, .open_min = true}, Angle::deg(10));
  if (method) out.method = (*method)(in);
  return out;
}

void decode_torch_and_kerf(Reader& in, Preset preset, bevel::TableSpec& out) {
  out.kerf = in.number("kerf_mm", kKerf);
  out.torch = in.defaulted_object("torch", decode_torch);
  if (preset == Preset::tube_laser) check_torch_reaches_square(in, out.torch);
}

void decode_table_options(Reader& in, Preset preset, bevel::TableSpec& out) {
  decode_cut(in, true, preset, out);
}

void decode_cut(Reader& in, bool whole, Preset preset, bevel::TableSpec& out) {
  const bool laser = preset == Preset::tube_laser;
  out.untilted = laser;
  out.root_surface = laser ? in.choice("root_surface", RootSurface::inner)
                           : in.choice("root_surface", kNames<RootSurface>);
  out.groove = laser ? decode_square_groove(in)
                     : in.object("groove", [](Reader& g) { return decode_groove(g, true); });
  if (whole) out.dihedral = in.choice("dihedral", Dihedral::weld_side);
  out.contact = laser ? decode_untilted_contact(in) : in.choice("contact", Contact::inner);
  const bool known = in.understood("root_surface") && (!whole || in.understood("dihedral")) &&
                     in.understood("contact");
  if (known) check_combination(out, in);
  decode_stand_off(in, known, out);
  if (whole) decode_torch_and_kerf(in, preset, out);
  if (laser) return decode_no_smoothing(in, out);
  const auto smoothing = in.object("smoothing", decode_smoothing);
  out.smoothing = smoothing.method;
  out.mutation_limit = smoothing.mutation_limit;
}

std::vector<std::string> decode_table_columns(Reader& in, const bevel::TableSpec& spec) {
  return decode_columns(in, bevel_column_names(), bevel_column_names(spec));
}

void encode_table(const bevel::TableSpec& spec, const bevel::Table& out,
                  const std::vector<std::string>& columns, Writer& w) {
  w.object("points", [&](Writer& p) { bevel_columns(spec, out).only(columns).write(p); });
  w.field("b_sign", name_of_b_sign(out));
  encode_bevel_lists(out, w);
  w.object("limits", [&](Writer& o) { encode_limits(spec, o); });
  if (const auto area = bevel::smoothed_area(spec, out))
    w.object("smoothed_area", [&](Writer& o) {
      o.degrees("area_deg_mm", area->area);
      o.degrees("least_deg_mm", area->least);
    });
  encode_torch_binds(out, w);
  encode_penetration(out.penetration, w);
  encode_torch_line(out.torch_line, w);
  w.field("length_mm", out.length_total);
  w.field("developed_length_mm", out.developed_total);
}

void encode_bevel_lists(const bevel::Table& table, Writer& w) {
  encode_events(table, w);
  encode_steps(table, w);
}

void encode_torch_binds(const bevel::Table& out, Writer& w) {
  w.array("torch_binds", out.torch_binds, [](Writer& each, const bevel::Table::Binding& v) {
    each.object([&](Writer& o) {
      o.degrees("from_phi_deg", v.from);
      o.degrees("to_phi_deg", v.to);
      o.degrees("groove_lost_deg", v.groove_lost);
      o.field("root_gap_mm", v.root_gap);
    });
  });
}

void encode_penetration(const bevel::Penetration& deepest, Writer& w) {
  w.object("penetration", [&](Writer& o) {
    o.field("depth_mm", deepest.depth);
    o.degrees("phi_deg", deepest.phi);
    o.field("radius_mm", deepest.radius);
    o.field("z_mm", deepest.z);
    o.field("cutter", deepest.solid);
  });
}

void encode_torch_line(const bevel::BeamProof& proof, Writer& w) {
  w.object("torch_line", [&](Writer& o) {
    o.field("gouge_mm", proof.gouge);
    o.degrees("gouge_phi_deg", proof.gouge_phi);
    o.field("left_mm", proof.left);
    o.degrees("left_phi_deg", proof.left_phi);
  });
}

}  // namespace tubecut::api
