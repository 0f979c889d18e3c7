#include "api/endpoints/all.hpp"
#include "api/formats/feed_curve_formats.hpp"
#include "api/limits.hpp"
#include "api/pipeline.hpp"
#include "api/wire/cutoff_names.hpp"
#include "api/wire/tables.hpp"
#include "core/cutoff/feed_curve.hpp"
#include "core/cutoff/verify.hpp"

namespace tubecut::api {
namespace {

using cutoff::FitMethod;

constexpr Range kLinkageLength{.min = 1.0, .max = 10'000.0};
constexpr Range kFeed{.min = -10'000.0, .max = 10'000.0};
constexpr Range kFeedSpeed{.min = 1e-3, .max = 10'000.0};
constexpr Range kDistance{.min = 0.0, .max = 10'000.0};
constexpr Range kAxisLimit{.min = 1e-3, .max = 1e6};
constexpr Range kJerkLimit{.min = 1e-3, .max = 1e9};
constexpr Range kTime{.min = 0.0, .max = 86'400.0};

// Equispaced only in comparisons.
constexpr auto kMethods = kOnly<FitMethod::minimax, FitMethod::least_squares,
                                FitMethod::three_point, FitMethod::automatic>;

cutoff::Linkage decode_linkage(Reader& in) {
  cutoff::Linkage out;
  out.arm = in.number("arm_mm", kLinkageLength);
  out.pivot_distance = in.number("pivot_distance_mm", kLinkageLength);
  out.pivot_offset = in.number("pivot_offset_mm", kLinkageLength);
  out.rest_angle =
      in.angle_either("rest_angle", {.min = -kPi, .max = kPi, .open_min = true, .open_max = true});
  out.slot_angle = in.angle_either("slot_angle", {.min = kPi / 180.0, .max = kPi * 179.0 / 180.0});
  const auto which = in.exactly_one({"rad_per_mm", "calibrate"});
  if (which == 0) out.rad_per_mm = in.number("rad_per_mm", {.min = 1e-9, .max = 10.0});
  if (which == 1)
    out.calibrate = in.object("calibrate", [](Reader& c) {
      cutoff::MeasuredPair pair;
      pair.feed = c.number("feed_mm", kFeed);
      pair.stroke = c.number("stroke_mm", kFeed);
      return pair;
    });
  return out;
}

cutoff::Cut decode_cut(Reader& in) {
  cutoff::Cut out;
  const auto which = in.exactly_one({"start_feed_mm", "clearance_mm"});
  if (which == 1) {
    cutoff::CutDistances d;
    d.clearance = in.number("clearance_mm", kDistance);
    d.slowdown = in.number("slowdown_mm", kDistance);
    d.wall = in.number("wall_mm", kWall);
    d.overcut = in.number("overcut_mm", kDistance);
    out.range = d;
  } else {
    cutoff::FeedWindow w;
    if (which == 0) w.start_feed = in.number("start_feed_mm", kFeed);
    const Range beyond{
        .min = which == 0 ? w.start_feed : kFeed.min, .max = kFeed.max, .open_min = true};
    w.end_feed = in.number("end_feed_mm", beyond);
    out.range = w;
  }
  out.feed = in.number("feed_mm_s", kFeedSpeed);
  return out;
}

cutoff::FitSpec decode_fit(Reader& in) {
  cutoff::FitSpec out;
  for (const auto& [field, method] :
       {std::pair("nodes_s", "three_point"), std::pair("tolerance_ratio", "auto")}) {
    if (in.has("method") || !in.has(field)) continue;
    const auto hint = std::string(field) + " goes with method " + method;
    in.issue({.code = ErrorCode::missing_field, .pointer = "method", .hint = hint});
    in.issue({.code = ErrorCode::unknown_field, .pointer = field, .hint = hint}, in.find(field));
    in.silence();
    return out;
  }
  out.method = in.choice("method", kMethods, FitMethod::minimax);
  if (!in.understood("method")) in.silence();
  switch (out.method) {
    case FitMethod::automatic:
      out.tolerance = in.number("tolerance_ratio", {.min = 1e-9, .max = 1.0}, 0.005);
      break;
    case FitMethod::three_point:
      out.degree = in.integer("degree", 2, 2, 2);
      in.note("nodes_s");
      if (in.has("nodes_s")) {
        const auto t = in.column("nodes_s", {.min = 3, .max = 3}, kTime);
        if (t.size() == 3) out.nodes = {t[0], t[1], t[2]};
      }
      break;
    case FitMethod::minimax:
    case FitMethod::least_squares:
    case FitMethod::equispaced:
      out.degree = in.integer("degree", 1, cutoff::kHighestDegree, 2);
  }
  out.preserve_stroke = in.flag("preserve_stroke", false);
  return out;
}

cutoff::TableSpec decode_table(Reader& in) {
  in.note("points");
  in.note("step_mm");
  if (in.has("step_mm") && in.has("points")) (void)in.exactly_one({"points", "step_mm"});
  if (in.has("step_mm"))
    return cutoff::TableStep{in.number("step_mm", {.min = 1e-4, .max = 1'000.0})};
  return cutoff::TablePoints{in.integer("points", 2, cutoff::kMostTablePoints, 400)};
}

cutoff::CycleSpec decode_cycle(Reader& in) {
  cutoff::CycleSpec out;
  out.period = in.number("period_s", {.min = 1e-5, .max = 1.0}, 0.002);
  out.max_cylinder_speed = in.number("max_cylinder_speed_mm_s", kAxisLimit);
  out.max_cylinder_acceleration = in.number("max_cylinder_acceleration_mm_s2", kAxisLimit);
  out.max_cylinder_jerk = in.number("max_cylinder_jerk_mm_s3", kJerkLimit);
  out.max_feed = in.optional_number("max_feed_mm", kAxisLimit);
  out.dwell = in.number("dwell_s", kTime, 0.0);
  out.handling = in.number("handling_s", kTime, 0.0);
  out.target = in.optional_number("target_per_hour", {.min = 0.01, .max = 1e6});
  return out;
}

cutoff::ToolSpec decode_tool(Reader& in) {
  cutoff::ToolSpec out;
  out.disc = in.number("disc_rev_min", {.min = 0.01, .max = 1e5});
  out.blades = in.integer("blades", 1, 100);
  out.corner_radius = in.number("corner_radius_mm", {.min = 1e-3, .max = 100.0});
  out.kerf = in.number("kerf_mm", {.min = 0.01, .max = 50.0});
  return out;
}

/// [least, most] in mm.
std::pair<double, double> decode_span(Reader& in, std::string_view name, Range range) {
  const auto span = in.column(name, {.min = 2, .max = 2}, range);
  if (span.size() != 2) return {};
  if (!(span[0] <= span[1]))
    in.issue({.code = ErrorCode::out_of_range,
              .pointer = std::string(name) + "/1",
              .limit = Json{span[0]},
              .unit = "mm",
              .hint = "least first, then most"});
  return {span[0], span[1]};
}

cutoff::TubeSpec decode_cut_tube(Reader& in) {
  cutoff::TubeSpec out;
  out.outer_diameter = in.number("outer_diameter_mm", kDiameter);
  out.wall = in.number("wall_mm", kWall);
  out.machine = in.optional_object("machine_range", [](Reader& m) {
    return cutoff::TubeRange{.outer_diameter = decode_span(m, "outer_diameters_mm", kDiameter),
                             .wall = decode_span(m, "walls_mm", kWall)};
  });
  return out;
}

cutoff::ComparisonSpec decode_comparison(Reader& in) {
  cutoff::ComparisonSpec out;
  out.first_degree = in.integer("first_degree", 1, cutoff::kHighestDegree, 2);
  out.last_degree = in.integer("last_degree", out.first_degree, cutoff::kHighestDegree, 5);
  return out;
}

void encode_geometry(const cutoff::Geometry& g, Writer& o) {
  o.field("rod_height_mm", g.rod_height);
  o.degrees("slot_elevation_deg", g.slot_elevation.rad());
  o.field("stroke_low_mm", g.stroke_low);
  o.field("stroke_high_mm", g.stroke_high);
  if (g.feed_low) o.field("feed_low_mm", *g.feed_low);
  if (g.feed_high) o.field("feed_high_mm", *g.feed_high);
  if (g.feed_at_peak) o.field("feed_at_peak_mm", *g.feed_at_peak);
  o.field("rad_per_mm", g.rad_per_mm);
}

void encode_work(const cutoff::Work& v, Writer& o) {
  o.field("start_feed_mm", v.start_feed);
  o.field("end_feed_mm", v.end_feed);
  o.field("feed_mm_s", v.feed);
  o.field("duration_s", v.duration);
  o.field("start_stroke_mm", v.start_stroke);
  o.field("end_stroke_mm", v.end_stroke);
  o.field("min_cylinder_speed_mm_s", v.min_cylinder_speed);
  o.field("max_cylinder_speed_mm_s", v.max_cylinder_speed);
  o.field("max_cylinder_acceleration_mm_s2", v.max_cylinder_acceleration);
  o.field("max_cylinder_jerk_mm_s3", v.max_cylinder_jerk);
  if (v.time_at_peak) o.field("time_at_peak_s", *v.time_at_peak);
}

void encode_command(const cutoff::Command& c, Writer& o) {
  o.field("method", name_of(c.method));
  o.field("degree", c.degree);
  o.field("duration_s", c.duration);
  o.column("chebyshev", c.chebyshev);
  o.column("scaled", c.scaled);
  o.column("seconds", c.seconds);
  o.column("seconds_rounded", c.seconds_rounded);
  o.field("digits", c.digits);
  o.field("rounded_max_relative_error", c.rounded_max_relative_error);
  o.field("max_relative_error", c.errors.max_relative_error);
  o.field("tool_ripple", c.errors.tool_ripple);
  o.field("tool_position_error_mm", c.errors.tool_position_error);
  o.field("end_drift_mm", c.errors.end_drift);
  o.field("cylinder_end_drift_mm", c.errors.cylinder_end_drift);
}

void encode_cycle(const cutoff::Cycle& c, Writer& o) {
  o.field("work_start_s", c.work_start);
  o.field("work_end_s", c.work_end);
  o.field("stop_s", c.stop);
  o.field("end_s", c.end);
  o.field("cycle_s", c.cycle);
  o.field("pieces_per_hour", c.pieces_per_hour);
  if (c.target) {
    o.field("target_met", c.target->met);
    if (c.target->estimated_feed) o.field("estimated_feed_mm_s", *c.target->estimated_feed);
    if (c.target->feed) o.field("feed_for_target_mm_s", *c.target->feed);
  }
  o.field("stop_feed_mm", c.stop_feed);
  o.field("stop_stroke_mm", c.stop_stroke);
  o.field("overshoot_mm", c.overshoot);
  o.field("speed_in_mm_s", c.speed_in);
  o.field("speed_out_mm_s", c.speed_out);
  o.field("acceleration_step_in_mm_s2", c.acceleration_step_in);
  o.field("acceleration_step_out_mm_s2", c.acceleration_step_out);
  o.field("approach_peak_mm_s", c.approach_peak);
  o.field("return_peak_mm_s", c.return_peak);
  o.field("samples", c.samples.time.size());
}

void encode_tool(const cutoff::ToolOutputs& t, Writer& o) {
  o.field("feed_per_revolution_mm", t.feed_per_revolution);
  o.field("feed_per_blade_mm", t.feed_per_blade);
  o.field("feed_per_blade_low_mm", t.feed_per_blade_low);
  o.field("feed_per_blade_high_mm", t.feed_per_blade_high);
  o.field("roughness_um", t.roughness);
  o.field("roughness_one_blade_um", t.roughness_one_blade);
  if (!t.wall_cut) return;
  o.field("cutting_speed_outside_m_min", t.wall_cut->cutting_speed_outside);
  o.field("cutting_speed_bore_m_min", t.wall_cut->cutting_speed_bore);
  o.field("revolutions_through_wall", t.wall_cut->revolutions);
  o.field("through_wall_s", t.wall_cut->duration);
  o.field("chip_rate_mm3_s", t.wall_cut->chip_rate);
  o.field("chip_volume_mm3", t.wall_cut->chip_volume);
}

struct FeedCurves {
  using Spec = cutoff::FeedCurveSpec;
  using Out = cutoff::FeedCurve;
  static constexpr std::string_view kId = "feed-curves";
  static constexpr std::string_view kPath = "/v1/feed-curves";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_max_bytes);
  static constexpr double kBudgetS = api::kBudgetS;
  static constexpr std::array<std::string_view, 0> kAccepts{};
  static constexpr std::array<CheckLimit, 31> kChecks{{
      {"stroke_limits", "1e-9", ""},
      {"peak_feed", "1e-7", ""},
      {"work_ends", "1e-9", ""},
      {"calibration", "1e-9", ""},
      {"table_feed", "1e-9", ""},
      {"table_speed", "1e-8", ""},
      {"table_acceleration", "1e-7", ""},
      {"table_pace", "1e-12", ""},
      {"work_speed", "1e-3", ""},
      {"work_acceleration", "1e-3", ""},
      {"fit_forms", "1e-9", ""},
      {"fit_speed_error", "2e-3", ""},
      {"fit_rounded", "2e-3", ""},
      {"fit_tool_ripple", "2e-3", ""},
      {"fit_tool_position", "2e-3", ""},
      {"fit_end_drift", "1e-9", ""},
      {"comparison_minimax", "1e-6", ""},
      {"cycle_feed", "1e-9", ""},
      {"cycle_max_feed", "1e-9", ""},
      {"cycle_feed_speed", "1e-8", ""},
      {"cycle_times", "1e-12", ""},
      {"cycle_ends_at_rest", "0", ""},
      {"cycle_target_estimate", "1e-12", ""},
      {"cycle_speed", "1e-9", ""},
      {"cycle_acceleration", "1e-9", ""},
      {"cycle_jerk", "1 + 1e-6", ""},
      {"cycle_speed_steps", "1 + 1e-6", ""},
      {"cycle_stroke_steps", "1 + 1e-6", ""},
      {"tool_feed", "1e-12", ""},
      {"tool_roughness", "1e-12", ""},
      {"tool_wall_cut", "1e-9", ""},
  }};

  static Spec decode(Reader& in) {
    Spec out;
    out.linkage = in.object("linkage", decode_linkage);
    out.cut = in.object("cut", decode_cut);
    out.fit = in.defaulted_object("fit", decode_fit);
    out.table = in.defaulted_object("table", decode_table);
    out.cycle = in.optional_object("cycle", decode_cycle);
    out.tool = in.optional_object("tool", decode_tool);
    out.tube = in.optional_object("tube", decode_cut_tube);
    out.comparison = in.optional_object("comparison", decode_comparison);
    return out;
  }

  static Result<Out> compute(const Spec& spec) { return cutoff::feed_curve(spec); }
  static std::vector<Check> verify(const Spec& spec, const Out& out) {
    return cutoff::verify(spec, out);
  }
  static std::vector<Warning> warnings(const Spec&, const Out& out) { return out.warnings; }
  static std::vector<Measure> measure(const Spec&, const Out&) { return {}; }

  static void encode(const Spec&, const Out& out, Writer& w) {
    w.object("geometry", [&](Writer& o) { encode_geometry(out.geometry, o); });
    w.object("work", [&](Writer& o) { encode_work(out.work, o); });
    w.object("table", [&](Writer& o) { feed_columns(out).write(o); });
    w.object("fit", [&](Writer& o) { encode_command(out.fit, o); });
    if (out.comparison)
      w.array("comparison", *out.comparison, [](Writer& each, const cutoff::Command& command) {
        each.object([&](Writer& o) { encode_command(command, o); });
      });
    if (out.cycle) w.object("cycle", [&](Writer& o) { encode_cycle(*out.cycle, o); });
    if (out.tool) w.object("tool", [&](Writer& o) { encode_tool(*out.tool, o); });
  }

  static const std::vector<Format<Spec, Out>>& formats() {
    static const std::vector<Format<Spec, Out>> kFormats{
        {"csv", "text/csv", &feed_curve_csv, {"table", "samples"}},
        {"svg", "image/svg+xml", &feed_curve_svg, {"chart"}},
        {"st", "text/x-iec61131-st", &feed_curve_structured_text, {}, {}, false, true}};
    return kFormats;
  }
};

}  // namespace

Endpoint feed_curves() { return endpoint<FeedCurves>(); }

}  // namespace tubecut::api
