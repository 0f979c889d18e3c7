#include "api/endpoints/part_request.hpp"

#include <array>
#include <utility>

#include "api/endpoints/bevel_table_codec.hpp"
#include "api/endpoints/cutout_codec.hpp"
#include "api/endpoints/frames/node_codec.hpp"
#include "api/endpoints/frames/renaming.hpp"
#include "api/endpoints/hole_codec.hpp"
#include "api/endpoints/joint_codec.hpp"
#include "api/endpoints/section_bevel_table.hpp"
#include "api/limits.hpp"
#include "api/wire/part_names.hpp"
#include "core/base/try.hpp"

namespace tubecut::api {
namespace {

using part::Datum;

constexpr Range kComponent{.min = -1e6, .max = 1e6};
constexpr Range kAllowance{.min = 0.0, .max = 1e5};
constexpr Range kDensity{.min = 100.0, .max = 25'000.0};  // kg/m^3
constexpr std::size_t kMostMarks = 1'000;
constexpr CountRange kHoles{
    .min = 0, .max = 64, .instead = "holes without a branch are cutouts, up to 2000"};
constexpr auto kMostCutters = static_cast<std::size_t>(limit::cutters_max);
constexpr Range kGap{.min = 0.0, .max = 50.0};

struct Blank {
  double clamping = 0.0, facing = 0.0;
};

Blank decode_blank(Reader& in) {
  return in.defaulted_object("allowances", [](Reader& a) {
    return Blank{a.number("clamping_mm", kAllowance, 0.0), a.number("facing_mm", kAllowance, 0.0)};
  });
}

struct DatumChoice {
  Datum datum = Datum::up;
  Angle seam = {};
};

DatumChoice decode_datum(Reader& in, Datum fallback, bool has_up) {
  DatumChoice out;
  out.datum = in.choice("datum", fallback);
  in.note("seam_deg");
  const bool known = in.understood("datum");
  if (known && out.datum == Datum::seam) {
    out.seam = in.angle("seam_deg", kAnyAngleDeg, Angle{});
  } else if (in.has("seam_deg")) {
    out.seam = in.angle("seam_deg", kAnyAngleDeg);
    if (known)
      in.issue({.code = ErrorCode::unsupported_combination,
                .pointer = "seam_deg",
                .hint = "requires datum seam"},
               in.find("seam_deg"));
  }
  if (known && out.datum == Datum::up && !has_up)
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "datum",
              .got = Json{"up"},
              .hint = "needs an `up`, of the member or of the request"});
  return out;
}

/// Decodes the values that a part has once: sampling, kerf and torch.
void decode_once(Reader& in, Preset preset, bevel::TableSpec& out) {
  out.sampling = decode_sampling(in);
  decode_torch_and_kerf(in, preset, out);
}

bevel::HoleSpec hole_options(const bevel::TableSpec& once) {
  bevel::HoleSpec out;
  out.kerf = once.kerf;
  out.torch = once.torch;
  out.sampling = once.sampling;
  return out;
}

void decode_member(Reader& in, PartRequest& out) {
  auto node = decode_named_node(in);
  auto& m = out.member.emplace();
  const auto id = in.text("member");
  m.member = known_member(in, node.ids, id, "member");
  m.node = std::move(node.spec);
  in.note("up");
  if (in.has("up")) m.up = in.vector3("up", kComponent);
  const bool found = m.member < m.node.members.size();
  const bool up = m.up || (found && m.node.members[m.member].up);
  const auto datum = decode_datum(in, up ? Datum::up : Datum::first_cutter, up || !found);
  m.datum = datum.datum;
  m.seam = datum.seam;
  decode_cut(in, false, out.preset, m.cut);
  decode_once(in, out.preset, m.cut);
  if (found) {
    const auto& own = m.node.members[m.member];
    m.cut.target = {.outer_radius = own.outer_radius, .wall = own.wall};
  }
  out.part.cutouts = decode_cutouts(in, out.preset, m.cut);
  in.note("holes");
  if (!in.has("holes")) return;
  const double radius = found ? m.node.members[m.member].outer_radius : kDiameter.min;
  in.array("holes", kHoles, [&](Reader& h) {
    auto hole = hole_options(m.cut);
    const auto branch = h.text("member");
    const auto other = known_member(h, node.ids, branch, "member");
    if (!branch.empty() && branch == id)
      h.issue({.code = ErrorCode::bad_choice,
               .pointer = "member",
               .got = Json{branch},
               .hint = "a member cannot be set on itself"});
    // Members that are refused may be those that state it.
    static constexpr joint::Joint kUnknown{};
    const auto* stated = joint::stated_joint(m.node, m.member, other);
    decode_hole_cut(h, radius, stated == nullptr && h.refused() ? &kUnknown : stated, out.preset,
                    hole);
    m.holes.push_back({std::move(hole), other});
    return 0;
  });
}

/// A partner is set into at most its radius; a rectangular tube, a cone or an elbow not at all.
double deepest_of(const joint::Partner& partner) {
  struct Of {
    double operator()(const joint::TubeCutter& t) const { return t.radius; }
    double operator()(const joint::AxisTube& t) const { return t.radius; }
    double operator()(const joint::PlaneCutter&) const { return 0.0; }
    double operator()(const joint::RectangularTubeCutter&) const { return 0.0; }
    double operator()(const joint::ConeCutter&) const { return 0.0; }
    double operator()(const joint::ElbowCutter&) const { return 0.0; }
  };
  return joint::by_kind(partner, Of{});
}

joint::Joint decode_end_joint(Reader& in, const joint::Partner* partner) {
  using joint::JointKind;
  joint::Joint out;
  const auto kind = in.tag("kind", kOnly<JointKind::set_on, JointKind::set_in, JointKind::mitre>);
  out.kind = kind.value_or(JointKind::set_on);
  out.gap = in.number("gap_mm", kGap, 0.0);
  const bool set_in = out.kind == JointKind::set_in;
  const bool goes =
      partner == nullptr || out.kind == JointKind::set_on ||
      (set_in ? deepest_of(*partner) > 0.0 : std::holds_alternative<joint::PlaneCutter>(*partner));
  if (kind && !goes)
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "kind",
              .hint = set_in ? "only a tube can be entered" : "a mitre's cutter is its plane"},
             in.find("kind"));
  if (!set_in) return out;
  const double deepest = partner == nullptr || !goes ? kDiameter.max / 2.0 : deepest_of(*partner);
  out.depth =
      in.number("depth_mm", {.min = 0.0, .max = deepest, .open_min = true, .open_max = true});
  return out;
}

/// Decodes the joints of an end's cutters, if given, by their index.
void decode_end_joints(Reader& in, const std::string& end, bevel::TableSpec& out,
                       std::vector<Warning>& warnings) {
  in.note("joints");
  if (!in.has("joints")) return;
  const auto n = out.partners.size();
  const bool known = in.understood("cutters") && n > 0;
  out.stated.assign(n, std::nullopt);
  in.array("joints", {.min = 0, .max = kMostCutters}, [&](Reader& j) {
    const int last = static_cast<int>(known ? n : kMostCutters) - 1;
    const auto index = static_cast<std::size_t>(j.integer("cutter", 0, last));
    const bool there = known && j.understood("cutter");
    const auto joint = decode_end_joint(j, there ? &out.partners[index] : nullptr);
    const auto missing = j.optional_number("missing_mm", {.min = 0.0, .max = limit::offset_max_mm});
    if (!there) return 0;
    if (missing.value_or(0.0) > 0.0)
      warnings.push_back({.code = WarningCode::ghost_contact,
                          .member = "ends/" + end + "/cutters/" + std::to_string(index),
                          .detail = "it is missing over " + brief(*missing) + " mm of this cut"});
    if (out.stated[index])
      j.issue({.code = ErrorCode::duplicate_id,
               .pointer = "cutter",
               .hint = "the joint of this cutter is already stated"},
              j.find("cutter"));
    out.stated[index] = joint;
    return 0;
  });
}

part::EndSpec decode_end(Reader& in, const std::string& end, const bevel::TableSpec& once,
                         PartRequest& request) {
  const auto which = in.exactly_one({"cutters", "square_at_mm"});
  if (!which) {
    in.silence();
    return {};
  }
  part::EndSpec out{.cut = once};
  if (const auto own = in.optional_number("kerf_mm", kKerf)) out.cut.kerf = *own;
  if (which == 1) return part::square_end(out.cut, in.number("square_at_mm", kOffset));
  out.cut.partners = decode_cutters(in);
  decode_end_joints(in, end, out.cut, request.warnings);
  decode_cut(in, false, request.preset, out.cut);
  if (request.section) refuse_round_only(in, out.cut);
  return out;
}

void decode_ends(Reader& in, const bevel::TableSpec& once, PartRequest& out) {
  in.object("ends", [&](Reader& ends) {
    const auto end = [&](Reader& e, const char* name, bool& own_kerf) {
      own_kerf = e.has("kerf_mm");
      return decode_end(e, name, once, out);
    };
    out.part.start =
        ends.object("start", [&](Reader& e) { return end(e, "start", out.start_kerf); });
    out.part.finish =
        ends.object("finish", [&](Reader& e) { return end(e, "finish", out.finish_kerf); });
    return 0;
  });
}

/// Decodes the positions of other members on the part, in the start's frame.
std::vector<part::Mark> decode_marks(Reader& in) {
  in.note("marks");
  if (!in.has("marks")) return {};
  return in.array("marks", {.min = 0, .max = kMostMarks}, [](Reader& m) {
    part::Mark out{.kind = part::Mark::Kind::partner, .text = m.text("text")};
    out.phi = m.angle("phi_deg", kAnyAngleDeg).rad();
    out.z_from = out.z_to = m.number("z_mm", kOffset);
    return out;
  });
}

/// Requires a direct target's length, and takes the part's name from it.
void decode_part_target(Reader& in, std::string& name) {
  if (!in.is<Json::Object>("target")) return;
  const auto* target = in.find("target");
  if (target->find("length_mm") == nullptr)
    in.issue({.code = ErrorCode::missing_field,
              .pointer = "target/length_mm",
              .hint = "between the two work points"});
  if (const auto* id = target->find("id"))
    if (const auto* text = id->as<std::string>()) name = *text;
}

/// A part of a tube that is not round. Its datum line is the middle of face 1.
void decode_section_part(Reader& in, PartRequest& out) {
  out.section = decode_section_target(in);
  decode_part_target(in, out.part.name);
  in.choice("datum", kOnly<Datum::up>, Datum::up);
  constexpr std::string_view kRoundOnly = "requires a round target";
  refuse_fields(in, {"holes", "cutouts", "marks", "seam_deg"}, kRoundOnly);
  if (out.preset == Preset::tube_laser)
    for (const auto name : {"min_tongue_mm", "min_web_mm", "min_hole_to_end_mm"})
      refuse_limit(in, name, kRoundOnly);
  bevel::TableSpec once;
  once.target = target_of(*out.section);
  decode_once(in, out.preset, once);
  decode_ends(in, once, out);
}

void decode_direct(Reader& in, PartRequest& out) {
  auto& p = out.part;
  p.target = decode_target(in);
  decode_part_target(in, p.name);
  const auto datum = decode_datum(in, Datum::up, true);
  out.datum = datum.datum;
  out.seam = datum.seam;
  bevel::TableSpec once;
  once.target = p.target;
  decode_once(in, out.preset, once);
  decode_ends(in, once, out);
  p.partners = decode_marks(in);
  p.cutouts = decode_cutouts(in, out.preset, once);
  in.note("holes");
  if (!in.has("holes")) return;
  in.array("holes", kHoles, [&](Reader& h) {
    auto hole = hole_options(once);
    hole.chord = {.outer_radius = p.target.outer_radius, .wall = p.target.wall};
    const auto branch = h.object("branch", decode_hole_branch);
    hole.branch = branch.placement;
    hole.branch_wall = branch.wall;
    decode_hole_cut(h, p.target.outer_radius, nullptr, out.preset, hole);
    p.holes.push_back({std::move(hole), branch.name, p.holes.size()});
    return 0;
  });
}

/// Adds the values that are given once for the whole part.
void add_once(const std::string& at, bool own_kerf, Renamings& out) {
  for (const auto* one : {"torch", "sampling"}) out.push_back({at + one, one});
  if (!own_kerf) out.push_back({at + "kerf", "kerf"});
}

/// Core's part as the request's members or, without a node, as its ends.
Renamings renamings(const PartRequest& r) {
  const auto of = [](std::size_t i) { return "members/" + std::to_string(i); };
  Renamings out;
  for (const auto& hole : r.part.holes) {
    const auto at = "holes/" + std::to_string(hole.asked) + "/";
    add_once(at, false, out);
    if (r.member) out.push_back({at + "branch", at + "member", false});
  }
  for (const bool finish : {false, true}) {
    const auto at = std::string(joint::end_name(finish)) + "/";
    add_once(at, finish ? r.finish_kerf : r.start_kerf, out);
    if (!r.member) {
      out.push_back({at + "target", "target"});
      out.push_back({at, "ends/" + at});
      continue;
    }
    const auto& cutters = finish ? r.finish_cutters : r.start_cutters;
    for (std::size_t i = 0; i < cutters.size(); ++i)
      out.push_back({at + "cutters/" + std::to_string(i), of(cutters[i]), false});
    for (const auto* one : {"cutters", "target"})
      out.push_back({at + one, of(r.member->member), false});
    out.push_back({at, ""});
  }
  if (r.member) out.push_back({"target", of(r.member->member), false});
  return out;
}

std::vector<std::string> names(const joint::NodeSpec& node, const std::vector<std::size_t>& of) {
  std::vector<std::string> out;
  for (const auto i : of) out.push_back(node.members[i].name);
  return out;
}

}  // namespace

PartRequest decode_part_request(Reader& in, Tubes tubes) {
  PartRequest out;
  out.preset = decode_preset(in);
  check_accepts(in, out.preset);
  const auto which = in.exactly_one({"members", "target"});
  if (!which) {
    if (in.refused()) in.silence();  // the other fields depend on which of the two it is
    return out;
  }
  if (which == 0)
    decode_member(in, out);
  else if (tubes == Tubes::all && has_section_target(in))
    decode_section_part(in, out);
  else
    decode_direct(in, out);
  if (in.understood("datum")) check_seam_limit(in, out.preset, out.seam_known());
  const auto blank = decode_blank(in);
  const double density = in.number("density_kg_m3", kDensity, 7850.0);
  out.part.clamping = blank.clamping;
  out.part.facing = blank.facing;
  out.part.density = density;
  return out;
}

Result<PartRequest> resolve(PartRequest r, const std::stop_token& stop) {
  if (r.section) {
    auto& p = r.part;
    r.of_section = {.section = r.section->section,
                    .length = r.section->length.value_or(0.0),
                    .start = p.start,
                    .finish = p.finish,
                    .name = p.name,
                    .clamping = p.clamping,
                    .facing = p.facing,
                    .density = p.density};
    return r;
  }
  if (!r.member) {
    TRY(const auto zero,
        part::datum_angle(r.datum, r.seam, r.part.start.cut.partners, r.part.finish.cut.partners));
    r.part.zero = zero;
    return r;
  }
  r.member->clamping = r.part.clamping;
  r.member->facing = r.part.facing;
  r.member->density = r.part.density;
  TRY(auto found, part::find_member(*r.member, stop));
  auto cutouts = std::move(r.part.cutouts);
  r.part = std::move(found.part);
  r.part.cutouts = std::move(cutouts);
  r.start_cutters = std::move(found.start_cutters);
  r.finish_cutters = std::move(found.finish_cutters);
  r.start_ids = names(r.member->node, r.start_cutters);
  r.finish_ids = names(r.member->node, r.finish_cutters);
  r.warnings = std::move(found.warnings);
  return r;
}

Error on_request(const PartRequest& request, Error error) {
  return renamed(std::move(error), renamings(request));
}

std::vector<Warning> on_request(const PartRequest& request, std::vector<Warning> warnings) {
  return renamed(std::move(warnings), renamings(request));
}

}  // namespace tubecut::api
