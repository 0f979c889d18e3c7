#include <algorithm>
#include <cmath>

#include "api/endpoints/all.hpp"
#include "api/endpoints/bevel_table_codec.hpp"
#include "api/endpoints/hole_codec.hpp"
#include "api/endpoints/joint_codec.hpp"
#include "api/formats/bevel_table_formats.hpp"
#include "api/formats/hole_formats.hpp"
#include "api/formats/step/step.hpp"
#include "api/limits.hpp"
#include "api/pipeline.hpp"
#include "api/wire/bevel_names.hpp"
#include "api/wire/joint_names.hpp"
#include "api/wire/tables.hpp"
#include "core/bevel/hole/hole.hpp"

namespace tubecut::api {
namespace {

using bevel::JointKind;
using bevel::Tilt;

constexpr Range kGap{.min = 0.0, .max = 50.0};
constexpr Range kBranchInclinationDeg{.min = 0.0, .max = 180.0, .open_min = true, .open_max = true};
constexpr Range kComponent{.min = -1e6, .max = 1e6};

}  // namespace

HoleBranch decode_hole_branch(Reader& in) {
  HoleBranch out{.name = in.optional_text("id").value_or("")};
  if (in.find("kind") != nullptr)
    in.issue(
        {.code = ErrorCode::unsupported_combination,
         .pointer = "kind",
         .hint = "a branch here is a round tube; holes for rectangular_tube and flat_oval_tube "
                 "are cut by /v1/parts and /v1/frames, slots and contours as cutouts"},
        in.find("kind"));
  const auto size = decode_tube_section(in, true);
  out.wall = size.wall;
  const auto which = in.exactly_one({"inclination_deg", "axis"});
  if (which == 1) {
    const auto axis = in.object("axis", [](Reader& a) {
      return joint::AxisLine{a.vector3("point_mm", kOffset), a.vector3("direction", kComponent)};
    });
    out.placement = joint::AxisTube{.radius = size.outer_radius, .axis = axis};
    return out;
  }
  joint::TubeCutter tube{.radius = size.outer_radius};
  if (which) tube.inclination = in.angle("inclination_deg", kBranchInclinationDeg);
  tube.clocking = in.angle("clocking_deg", kAnyAngleDeg, Angle{});
  tube.offset = in.number("offset_mm", kOffset, 0.0);
  tube.height = in.number("height_mm", kOffset, 0.0);
  out.placement = tube;
  return out;
}

joint::Joint decode_joint_kind(Reader& in, double chord_radius, bool of_members) {
  joint::Joint out;
  const auto kind =
      of_members ? in.tag("kind", kNames<JointKind>)
                 : in.tag("kind", kOnly<JointKind::set_on, JointKind::set_in, JointKind::through>);
  out.kind = kind.value_or(JointKind::set_in);
  out.gap = in.number("gap_mm", kGap, 0.0);
  if (out.kind != JointKind::set_in && in.has("depth_mm"))
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "depth_mm",
              .hint = "only a set-in branch has a depth"},
             in.find("depth_mm"));
  const double deepest = std::max(chord_radius, kDiameter.min);
  out.depth = in.optional_number("depth_mm",
                                 {.min = 0.0, .max = deepest, .open_min = true, .open_max = true});
  if (out.kind == JointKind::mitre) out.plane = in.choice("plane", joint::MitrePlane::bisecting);
  return out;
}

void encode_joint_kind(const joint::Joint& joint, Writer& o) {
  o.field("kind", name_of(joint.kind));
  o.field("gap_mm", joint.gap);
  if (joint.depth) o.field("depth_mm", *joint.depth);
  if (joint.kind == JointKind::mitre) o.field("plane", name_of(joint.plane));
}

void decode_hole_cut(Reader& in, double chord_radius, const joint::Joint* stated, Preset preset,
                     bevel::HoleSpec& out) {
  in.note("joint");
  const bool told = stated != nullptr && !in.has("joint");
  const auto joint = told ? *stated : in.object("joint", [&](Reader& j) {
    return decode_joint_kind(j, chord_radius, false);
  });
  out.kind = joint.kind;
  out.gap = joint.gap;
  out.depth = joint.depth;
  const bool laser = preset == Preset::tube_laser;
  out.groove = laser ? decode_square_groove(in)
                     : in.object("groove", [](Reader& g) { return decode_groove(g, false); });
  out.tilt = laser ? decode_no_tilt(in) : in.choice("tilt", Tilt::axial);
}

void encode_hole(const bevel::HoleSpec& spec, const bevel::Hole& hole, Writer& o) {
  o.field("side", hole.far ? "far" : "near");
  o.object("points", [&](Writer& p) { hole_columns(spec, hole).write(p); });
  o.field("b_sign", kBSignInPart);
  o.field("scrap", "inside");
  o.field("turns", 0);
  o.field("length_mm", hole.length_total);
  encode_torch_line(hole.torch_line, o);
  o.object("fit_up", [&](Writer& f) {
    fit_up_columns(hole).write(f);
    f.field("least_between_nodes_mm", hole.fit.least_between);
    f.field("greatest_root_between_nodes_mm", hole.fit.greatest_root_between);
  });
}

namespace {

struct Holes {
  using Spec = NamedHole;
  using Out = bevel::HoleCut;
  static constexpr std::string_view kId = "holes";
  static constexpr std::string_view kPath = "/v1/holes";
  static constexpr auto kMaxBody = static_cast<std::size_t>(limit::body_max_bytes);
  static constexpr double kBudgetS = api::kBudgetS;
  static constexpr std::array<std::string_view, 2> kAccepts{"max_root_gap_mm", "max_b_deg"};
  static constexpr std::array<CheckLimit, 13> kChecks{{
      {"on_branch", "1e-6", "mm"},
      {"gap", "1e-6", "mm"},
      {"fit_up", "1e-6", "mm"},
      {"dihedral", "1e-6", "deg"},
      {"groove", "1e-6", "deg"},
      {"tilt", "1e-6", "deg"},
      {"kerf", "1e-6", "mm"},
      {"branch_end", "1e-6", "mm"},
      {"gap_stated", "1e-3", "mm"},
      {"gap_between", "sampling.tolerance_mm", "mm"},
      {"gouge", "0.01", "mm"},
      {"gouge_stated", "1e-3", "mm"},
      {"left_stated", "max(5e-3, 0.02 left_mm)", "mm"},
  }};

  static Spec decode(Reader& in) {
    Spec out;
    const auto chord = in.object("chord", [&](Reader& c) {
      out.chord_name = c.optional_text("id").value_or("");
      return decode_tube_section(c, true);
    });
    out.chord = {.outer_radius = chord.outer_radius, .wall = chord.wall};
    const double deepest = in.refused() ? kDiameter.max / 2.0 : chord.outer_radius;
    const auto branch = in.object("branch", decode_hole_branch);
    out.branch = branch.placement;
    out.branch_wall = branch.wall;
    out.branch_name = branch.name;
    decode_hole_cut(in, deepest, nullptr, Preset::none, out);
    out.torch = in.defaulted_object("torch", decode_torch);
    out.kerf = in.number("kerf_mm", {.min = 0.0, .max = 50.0});
    out.sampling = decode_sampling(in);
    return out;
  }

  static Result<Out> compute(const Spec& spec) { return bevel::hole(spec); }
  static std::vector<Check> verify(const Spec& spec, const Out& out) {
    return bevel::verify(spec, out);
  }
  static std::vector<Warning> warnings(const Spec&, const Out& out) { return out.warnings; }

  static std::vector<Measure> measure(const Spec&, const Out& out) {
    double gap = 0.0, b = 0.0;
    for (const auto& hole : out.holes) {
      gap = std::max(gap, hole.fit.greatest_root_between);
      for (const double one : hole.b) b = std::max(b, std::abs(one));
    }
    return {{"max_root_gap_mm", gap}, {"max_b_deg", b * kDegPerRad}};
  }

  static void encode(const Spec& spec, const Out& out, Writer& w) {
    w.array("holes", out.holes, [&](Writer& each, const bevel::Hole& hole) {
      each.object([&](Writer& o) { encode_hole(spec, hole, o); });
    });
    if (out.branch) w.object("branch", [&](Writer& o) { encode_branch(spec, *out.branch, o); });
  }

  /// The cutter goes unchanged into a bevel table of the branch.
  static void encode_branch(const Spec& spec, const bevel::BranchEnd& end, Writer& o) {
    o.object("cutter", [&](Writer& c) {
      c.field("kind", "tube");
      c.field("outer_diameter_mm", 2.0 * end.chord.radius);
      c.degrees("inclination_deg", end.chord.inclination.rad());
      c.degrees("clocking_deg", end.chord.clocking.rad());
      c.field("offset_mm", end.chord.offset);
      c.field("height_mm", end.chord.height);
    });
    o.object("points", [&](Writer& p) { branch_columns(spec, end).write(p); });
  }

  static std::string step(const Spec& spec, const Out& out, const Caption& caption) {
    return hole_step(spec, out, caption);
  }
  static const std::vector<Format<Spec, Out>>& formats() {
    static const std::vector<Format<Spec, Out>> kFormats{
        {"csv", "text/csv", &hole_csv},
        {"svg", "image/svg+xml", &hole_svg, {"chart", "template", "section"}, {"mirror", "paper"}},
        {"pdf", "application/pdf", &hole_pdf, {"template", "section"}, {"mirror", "paper"}},
        {"dxf", "image/vnd.dxf", &hole_dxf, {"template", "tube"}},
        {"step", "model/step", &step, {"smooth", "straight"}}};
    return kFormats;
  }
};

}  // namespace

Endpoint holes() { return endpoint<Holes>(); }

}  // namespace tubecut::api
