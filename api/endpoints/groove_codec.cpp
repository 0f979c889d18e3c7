#include "api/endpoints/groove_codec.hpp"

#include "api/limits.hpp"
#include "api/wire/common_fields.hpp"
#include "api/wire/groove_names.hpp"

namespace tubecut::api {
namespace {

static_assert(limit::mill_samples_max == groove::kMaxSamples &&
              limit::mill_triples_max == groove::kMaxTriples &&
              limit::mill_annealed_samples_max == groove::kMaxAnnealedSamples);

constexpr Range kSmallLength{.min = 0.0, .max = 1'000.0};
constexpr Range kArea{.min = 0.01, .max = 1e6};
constexpr Range kTravelMm{.min = -limit::offset_max_mm, .max = limit::offset_max_mm};

groove::Pipe decode_pipe(Reader& in) {
  groove::Pipe out;
  out.outer_diameter = in.number("outer_diameter_mm", kDiameter);
  out.wall = in.number("wall_mm", kWall);
  return out;
}

groove::RootFace decode_root_face(Reader& in) {
  groove::RootFace out;
  out.height = in.number("height_mm", kSmallLength);
  out.width = in.number("width_mm", {.min = 1e-3, .max = limit::wall_max_mm});
  return out;
}

groove::Filler decode_filler(Reader& in) {
  const auto which = in.exactly_one({"area_mm2", "height_mm"});
  if (!which) {
    in.note("at_deg");  // with either choice
    return groove::FillerArea{};
  }
  if (which == 0) return groove::FillerArea{.area = in.number("area_mm2", kArea)};
  groove::FillerHeight out;
  out.height = in.number("height_mm", {.min = 1e-3, .max = 1'000.0});
  out.at = in.angle("at_deg", kAnyAngleDeg, Angle{});
  return out;
}

groove::FixedBevel decode_compare(Reader& in) {
  static constexpr std::array kRules{Option<int>{"fixed", 0}};
  in.choice("rule", kRules);
  return {.bevel = in.angle("bevel_deg", {.min = 0.0, .max = 80.0})};
}

groove::Mill decode_mill(Reader& in) {
  groove::Mill out;
  out.half_angle = in.angle("half_angle_deg", {.min = 0.0, .max = 90.0, .open_max = true});
  out.tip_radius = in.number("tip_radius_mm", {.min = 0.1, .max = 1'000.0});
  out.length = in.number("length_mm", {.min = 0.01, .max = 1'000.0});
  return out;
}

std::optional<groove::Range> decode_range(Reader& in, std::string_view name, Range limits) {
  in.note(name);
  if (!in.has(name)) return std::nullopt;
  const auto ends = in.column(name, {.min = 2, .max = 2}, limits);
  if (ends.size() != 2) return std::nullopt;
  if (!(ends[0] < ends[1]))
    in.issue({.code = ErrorCode::out_of_range,
              .pointer = std::string(name) + "/1",
              .limit = Json{ends[0]},
              .unit = std::string(unit_of(name)),
              .hint = "must be greater than the limit"});
  return groove::Range{ends[0], ends[1]};
}

groove::Setup decode_setup(Reader& in) {
  groove::Setup out;
  out.mount = in.choice("mount", kNames<groove::Mount>);
  out.pivot_length = in.number("pivot_length_mm", {.min = 0.0, .max = 10'000.0}, 0.0);
  out.z_zero = in.number("z_zero_mm", kTravelMm, 0.0);
  out.c_zero = in.angle("c_zero_deg", kAnyAngleDeg, Angle{});
  out.direction = in.integer("direction", -1, 1, 1);
  if (out.direction == 0)
    in.issue({.code = ErrorCode::bad_choice, .pointer = "direction", .limit = Json{"-1|1"}},
             in.find("direction"));
  out.overrun = in.number("overrun_mm", kSmallLength, 0.0);
  in.optional_object("travel", [&](Reader& t) {
    out.travel.x = decode_range(t, "x_mm", kTravelMm);
    out.travel.z = decode_range(t, "z_mm", kTravelMm);
    out.travel.b_deg = decode_range(t, "b_deg", kAnyAngleDeg);
    return 0;
  });
  return out;
}

groove::Optimise decode_optimise(Reader& in) {
  groove::Optimise out;
  out.method = in.choice("method", groove::Method::chebyshev);
  out.hold = in.choice("hold", groove::Hold::tip);
  if (out.method == groove::Method::chebyshev) out.bias = in.choice("bias", groove::Bias::centred);
  if (out.method == groove::Method::annealing)
    out.seed = static_cast<std::uint64_t>(in.integer("seed", 0, 2'147'483'647, 1));
  return out;
}

groove::GapCheck decode_check(Reader& in) {
  groove::GapCheck out;
  out.points = in.integer("points", 3, groove::kMaxPoints, 11);
  out.window = in.angle("window_deg", {.min = 0.05, .max = 90.0}, Angle::deg(40));
  out.pitch = in.angle("pitch_deg", {.min = 0.05, .max = 90.0}, Angle::deg(1));
  out.qualify = in.number("qualify_mm", {.min = 1e-6, .max = 100.0}, 0.5);
  return out;
}

}  // namespace

groove::GrooveSpec decode_groove_request(Reader& in) {
  groove::GrooveSpec out;
  out.chord = in.object("chord", decode_pipe);
  out.branch = in.object("branch", decode_pipe);
  out.root_face = in.object("root_face", decode_root_face);
  out.inclination = in.angle("inclination_deg", {.min = 5.0, .max = 90.0});
  out.eccentricity = in.number("eccentricity_mm", {.min = -5'000.0, .max = 5'000.0}, 0.0);
  out.filler = in.object("filler", decode_filler);
  out.area_in = in.choice("area_in", groove::AreaIn::axial);
  out.sections = in.integer("sections", 4, groove::kMaxSections, 24);
  out.compare = in.optional_object("compare", decode_compare);
  return out;
}

groove::MillPathSpec decode_mill_path_request(Reader& in) {
  groove::MillPathSpec out;
  out.groove = in.object("groove", [](Reader& nested) {
    read_inner_common_fields(nested);
    return decode_groove_request(nested);
  });
  out.mill = in.object("mill", decode_mill);
  out.setup = in.object("setup", decode_setup);
  out.positions = in.integer("positions", groove::kMinPositions, groove::kMaxPositions, 90);
  out.optimise = in.defaulted_object("optimise", decode_optimise);
  out.check = in.defaulted_object("check", decode_check);
  return out;
}

}  // namespace tubecut::api
