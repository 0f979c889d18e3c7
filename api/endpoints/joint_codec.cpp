#include "api/endpoints/joint_codec.hpp"

#include <algorithm>

#include "api/catalog/section_sizes.hpp"
#include "api/catalog/tube_sizes.hpp"
#include "api/limits.hpp"
#include "api/wire/joint_names.hpp"
#include "api/wire/tables.hpp"

namespace tubecut::api {
namespace {

constexpr double kBendRadiusMax = 50'000.0;  // mm; longer bends are rolled, not elbows

constexpr Range kInclinationDeg{.min = 0.0, .max = 180.0, .open_min = true, .open_max = true};
constexpr Range kTolerance{.min = limit::tolerance_min_mm, .max = limit::tolerance_max_mm};
constexpr Range kComponent{.min = -1e6, .max = 1e6};
constexpr Range kHalfAngleDeg{.min = -80.0, .max = 80.0};

joint::AxisLine decode_axis(Reader& in) {
  return {.point = in.vector3("point_mm", kOffset),
          .direction = in.vector3("direction", kComponent)};
}

joint::Partner decode_tube(Reader& in) {
  const double radius = decode_tube_section(in, false).outer_radius;
  const auto which = in.exactly_one({"inclination_deg", "axis"});
  if (which == 1) {
    const auto axis = in.object("axis", decode_axis);
    return joint::AxisTube{.radius = radius, .axis = axis};
  }
  joint::TubeCutter out{.radius = radius};
  if (which) out.inclination = in.angle("inclination_deg", kInclinationDeg);
  out.clocking = in.angle("clocking_deg", kAnyAngleDeg, Angle{});
  out.offset = in.number("offset_mm", kOffset, 0.0);
  out.height = in.number("height_mm", kOffset, 0.0);
  return out;
}

joint::Partner decode_axis_tube(Reader& in) {
  const double radius = decode_tube_section(in, false).outer_radius;
  return joint::AxisTube{.radius = radius, .axis = in.object("axis", decode_axis)};
}

joint::Partner decode_plane(Reader& in) {
  return joint::PlaneCutter{.point = in.vector3("point_mm", kOffset),
                            .normal = in.vector3("normal", kComponent)};
}

joint::Partner decode_rectangular_tube(Reader& in) {
  joint::RectangularTubeCutter out{.width = in.number("width_mm", kPlate)};
  // A plate is thin in one direction only; if both are small, the unit is probably another.
  const bool thin = in.understood("width_mm") && out.width < kDiameter.min;
  out.height = in.number("height_mm", thin ? kDiameter : kPlate);
  const bool sized = in.understood("width_mm") && in.understood("height_mm");
  const double widest = 0.5 * (sized ? std::min(out.width, out.height) : kDiameter.max);
  out.corner = in.number("corner_radius_mm", {.min = 0.0, .max = widest, .open_min = true});
  const auto axis = in.object("axis", decode_axis);
  out.point = axis.point;
  out.direction = axis.direction;
  out.up = in.vector3("up", kComponent);
  return out;
}

joint::Partner decode_cone(Reader& in) {
  joint::ConeCutter out{.radius = in.number("outer_diameter_mm", kDiameter) / 2.0,
                        .half_angle = in.angle("half_angle_deg", kHalfAngleDeg)};
  const auto axis = in.object("axis", decode_axis);
  out.point = axis.point;
  out.direction = axis.direction;
  return out;
}

joint::Partner decode_elbow(Reader& in) {
  joint::ElbowCutter out{.radius = in.number("outer_diameter_mm", kDiameter) / 2.0};
  const double least = in.understood("outer_diameter_mm") ? out.radius : kDiameter.min / 2.0;
  out.bend_radius =
      in.number("bend_radius_mm", {.min = least, .max = kBendRadiusMax, .open_min = true});
  out.bend = in.angle("bend_deg", {.min = 0.0, .max = 180.0, .open_min = true});
  const auto axis = in.object("axis", decode_axis);
  out.point = axis.point;
  out.direction = axis.direction;
  out.inwards = in.vector3("inwards", kComponent);
  return out;
}

using Decode = joint::Partner (*)(Reader&);
constexpr std::array kKinds{
    Option<Decode>{joint::TubeCutter::kName, decode_tube},
    Option<Decode>{joint::PlaneCutter::kName, decode_plane},
    Option<Decode>{joint::RectangularTubeCutter::kName, decode_rectangular_tube},
    Option<Decode>{joint::ConeCutter::kName, decode_cone},
    Option<Decode>{joint::ElbowCutter::kName, decode_elbow}};
static_assert(kKinds.size() == std::variant_size_v<joint::Cutter>, "every kind is read");

/// In world coordinates there is no target as reference of angles.
constexpr auto kWorldKinds = [] {
  auto out = kKinds;
  out[0].value = decode_axis_tube;
  return out;
}();

joint::Partner decode_cutter(Reader& in) {
  const auto decode = in.tag("kind", kKinds);
  in.optional_text("id");
  return decode.value_or(decode_tube)(in);
}

}  // namespace

TubeSection decode_tube_section(Reader& in, bool with_wall) {
  const auto which = in.exactly_one({"outer_diameter_mm", "size"});
  TubeSection out;
  if (with_wall && which != 0) in.note("wall_mm");
  if (which == 1) {
    const auto name = in.text("size");
    const auto* size = find_tube_size(name);
    if (size == nullptr) {
      if (find_section_size(name) != nullptr)
        in.issue({.code = ErrorCode::unsupported_target,
                  .pointer = "size",
                  .limit = Json{"a round size"},
                  .hint = "rectangular tubes are cut by " + std::string(kSectionPaths)},
                 in.find("size"));
      else if (!name.empty())
        in.issue({.code = ErrorCode::unknown_size,
                  .pointer = "size",
                  .hint = is_section_size(name) ? section_size_hint(name) : tube_size_hint(name)},
                 in.find("size"));
      return out;
    }
    if (with_wall && in.has("wall_mm"))
      in.issue({.code = ErrorCode::exclusive_fields,
                .pointer = "wall_mm",
                .hint = "size already defines the wall; remove this field"},
               in.find("wall_mm"));
    return {size->outer_diameter / 2.0, size->wall};
  }
  if (!which) return out;
  out.outer_radius = in.number("outer_diameter_mm", kDiameter) / 2.0;
  if (!with_wall) return out;
  const bool sized = in.understood("outer_diameter_mm");
  out.wall = in.number("wall_mm", sized ? wall_of(out.outer_radius) : kWall);
  return out;
}

joint::Target decode_target(Reader& in) {
  return in.object("target", [](Reader& t) {
    if (t.has("kind")) {
      const auto kind = t.text("kind");
      if (!kind.empty() && kind != "round")
        t.issue({.code = ErrorCode::unsupported_target,
                 .pointer = "kind",
                 .limit = Json{"round"},
                 .hint = "round is cut everywhere; rectangular_tube and flat_oval_tube by " +
                         std::string(kSectionPaths)},
                t.find("kind"));
    } else {
      t.note("kind");
      t.put("kind", Json{"round"});
    }
    t.optional_text("id");
    const auto section = decode_tube_section(t, true);
    joint::Target out{.outer_radius = section.outer_radius, .wall = section.wall};
    out.length =
        t.optional_number("length_mm", {.min = 0.0, .max = limit::offset_max_mm, .open_min = true});
    return out;
  });
}

std::vector<joint::Partner> decode_cutters(Reader& in) {
  return in.array("cutters", {.min = 1, .max = static_cast<std::size_t>(limit::cutters_max)},
                  decode_cutter);
}

WorldCutter decode_world_cutter(Reader& in) {
  const auto decode = in.tag("kind", kWorldKinds);
  WorldCutter out{.partner = {}, .name = in.optional_text("id").value_or("")};
  out.partner = decode.value_or(decode_axis_tube)(in);
  return out;
}

joint::Sampling decode_sampling(Reader& in) {
  return in.defaulted_object("sampling", [](Reader& s) {
    joint::Sampling out;
    s.note("uniform_points");
    s.note("tolerance_mm");
    if (s.has("uniform_points"))
      out.uniform_points = static_cast<std::size_t>(
          s.integer("uniform_points", static_cast<int>(limit::uniform_points_min),
                    static_cast<int>(limit::uniform_points_max)));
    if (s.has("metric") && s.has("uniform_points") && !s.has("tolerance_mm")) {
      s.note("metric");
      const char* hint = "metric requires tolerance_mm";
      s.issue({.code = ErrorCode::missing_field, .pointer = "tolerance_mm", .hint = hint});
      s.issue({.code = ErrorCode::unknown_field, .pointer = "metric", .hint = hint},
              s.find("metric"));
    }
    if (s.has("tolerance_mm") || !s.has("uniform_points")) {
      joint::Tolerance tolerance;
      tolerance.value = s.number("tolerance_mm", kTolerance, 0.05);
      tolerance.metric = s.choice("metric", joint::Metric::developed);
      out.tolerance = tolerance;
    }
    out.max_nodes = static_cast<std::size_t>(limit::nodes_max);
    return out;
  });
}

void encode_event(const joint::Event& event, bool outer, Writer& w) {
  w.object([&](Writer& o) {
    o.field("kind", name_of(event.kind));
    o.field("surface", wall_name(outer));
    o.degrees("phi_deg", event.phi);
    o.field("z_from_mm", event.z_from);
    o.field("z_to_mm", event.z_to);
    o.field("from", event.from);
    o.field("to", event.to);
  });
}

void encode_profile(const joint::Profile& profile, const joint::Sampling& sampling, Writer& w) {
  w.field("surface", wall_name(profile.outer));
  w.field("radius_mm", profile.radius);
  w.object("points", [&](Writer& c) { profile_columns(profile, sampling).write(c); });
  w.array("events", profile.events,
          [&](Writer& e, const joint::Event& event) { encode_event(event, profile.outer, e); });
  w.field("length_mm", profile.length);
  w.field("developed_length_mm", profile.developed);
}

}  // namespace tubecut::api
