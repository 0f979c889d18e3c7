#include "api/endpoints/part_request.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "api/endpoints/bevel_table_codec.hpp"
#include "api/endpoints/cutouts/cutout_codec.hpp"
#include "api/endpoints/cutouts/square_hole.hpp"
#include "api/endpoints/frames/node_codec.hpp"
#include "api/endpoints/frames/renaming.hpp"
#include "api/endpoints/hole_codec.hpp"
#include "api/endpoints/joint_codec.hpp"
#include "api/endpoints/part_ends.hpp"
#include "api/endpoints/section_bevel_table.hpp"
#include "api/limits.hpp"
#include "api/wire/part_names.hpp"
#include "core/base/try.hpp"
#include "core/part/square_holes.hpp"

namespace tubecut::api {
namespace {

using part::Datum;

constexpr Range kComponent{.min = -1e6, .max = 1e6};
constexpr Range kAllowance{.min = 0.0, .max = 1e5};
constexpr Range kDensity{.min = 100.0, .max = 25'000.0};  // kg/m^3
constexpr std::size_t kMostMarks = 1'000;
constexpr CountRange kHoles{
    .min = 0, .max = 256, .instead = "holes without a branch are cutouts, up to 2000"};

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

double half_side(const SectionTarget& of) {
  return 0.5 * std::min(of.section.height, of.section.width);
}

/// Refuses the fields of a round part. The datum line of another is the middle of face 1.
void refuse_round_part(Reader& in) {
  constexpr std::string_view kRoundOnly = "requires a round target";
  in.choice("datum", kOnly<Datum::up>, Datum::up);
  refuse_fields(in, {"seam_deg"}, kRoundOnly);
}

void decode_member(Reader& in, PartRequest& out) {
  auto node = decode_named_node(in);
  auto& m = out.member.emplace();
  const auto id = in.text("member");
  m.member = known_member(in, node.ids, id, "member");
  if (node.ids.indices.contains(id)) out.section = section_of(node, m.member);
  m.node = std::move(node.spec);
  in.note("up");
  if (in.has("up")) m.up = in.vector3("up", kComponent);
  const bool found = m.member < m.node.members.size();
  const bool sure = found && in.sound("members");
  const bool up = m.up || (found && m.node.members[m.member].up);
  if (out.section) {
    refuse_round_part(in);
    m.datum = Datum::up;
  } else {
    const auto datum = decode_datum(in, up ? Datum::up : Datum::first_cutter, up || !found);
    m.datum = datum.datum;
    m.seam = datum.seam;
  }
  decode_cut(in, false, out.preset, m.cut);
  decode_once(in, out.preset, m.cut);
  const auto* own = found ? &m.node.members[m.member] : nullptr;
  if (out.section)
    refuse_round_only(in, m.cut);
  else if (own != nullptr)
    m.cut.target = {.outer_radius = own->outer_radius, .wall = own->wall};
  out.part.cutouts =
      decode_cutouts(in, out.preset, m.cut, out.section ? &out.section->section : nullptr, sure);
  in.note("holes");
  if (!in.has("holes")) return;
  const double half = out.section      ? half_side(*out.section)
                      : own != nullptr ? own->outer_radius
                                       : kDiameter.min;
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
    const bool square =
        out.section || (other < m.node.members.size() && m.node.members[other].section);
    decode_hole_cut(h, half, stated == nullptr && h.refused() ? &kUnknown : stated,
                    square ? Preset::tube_laser : out.preset, hole);
    m.holes.push_back({std::move(hole), other});
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

/// The same on a tube that is not round.
std::vector<part::SectionMark> decode_section_marks(Reader& in, double girth) {
  in.note("marks");
  if (!in.has("marks")) return {};
  return in.array("marks", {.min = 0, .max = kMostMarks}, [&](Reader& m) {
    part::SectionMark out{.kind = part::Mark::Kind::partner, .text = m.text("text")};
    out.s = m.number("girth_mm", {.min = 0.0, .max = girth, .open_max = true});
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
  refuse_round_part(in);
  bevel::TableSpec once;
  std::size_t count = 0;
  once.target = target_of(*out.section);
  decode_once(in, out.preset, once);
  decode_ends(in, once, out);
  out.part.cutouts =
      decode_cutouts(in, out.preset, once, &out.section->section, in.sound("target"));
  in.note("holes");
  if (in.has("holes"))
    out.part.square_holes = in.array("holes", kHoles, [&](Reader& h) {
      return decode_square_hole(h, half_side(*out.section), count++);
    });
  out.of_section.partners = decode_section_marks(in, out.section->section.outer().girth());
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
  p.cutouts = decode_cutouts(in, out.preset, once, nullptr, in.sound("target"));
  in.note("holes");
  if (!in.has("holes")) return;
  std::size_t count = 0;
  in.array("holes", kHoles, [&](Reader& h) {
    const auto asked = count++;
    if (has_section_branch(h)) {
      p.square_holes.push_back(decode_square_hole(h, p.target.outer_radius, asked));
      return 0;
    }
    auto hole = hole_options(once);
    hole.chord = {.outer_radius = p.target.outer_radius, .wall = p.target.wall};
    const auto branch = h.object("branch", decode_hole_branch);
    hole.branch = branch.placement;
    hole.branch_wall = branch.wall;
    decode_hole_cut(h, p.target.outer_radius, nullptr, out.preset, hole);
    p.holes.push_back({std::move(hole), branch.name, asked});
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
  const auto* branch = r.member ? "/member" : "/branch";
  for (const auto& one : r.cutouts().holes)
    out.push_back(
        {cutout::path_of(one.cutout), "holes/" + std::to_string(one.hole.asked) + branch, false});
  for (const auto& one : r.part.square_holes) {
    const auto at = "holes/" + std::to_string(one.asked);
    if (r.member) out.push_back({at + "/branch", at + branch, false});
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

PartRequest decode_part_request(Reader& in) {
  PartRequest out;
  out.preset = decode_preset(in);
  const auto which = in.exactly_one({"members", "target"});
  Measured measured{.preset = out.preset,
                    .cutouts = in.has("cutouts"),
                    .holes = in.has("holes"),
                    .seam_known = true};
  check_accepts(in, measured);  // as far as it needs neither the tube nor its seam
  if (!which) {
    if (in.refused()) in.silence();  // the other fields depend on which of the two it is
    return out;
  }
  if (which == 0)
    decode_member(in, out);
  else if (has_section_target(in))
    decode_section_part(in, out);
  else
    decode_direct(in, out);
  const auto before = measured;
  measured.round = !out.section;
  measured.seam_known = !in.understood("datum") || out.seam_known();
  check_accepts(in, measured, before);
  const auto blank = decode_blank(in);
  const double density = in.number("density_kg_m3", kDensity, 7850.0);
  out.part.clamping = blank.clamping;
  out.part.facing = blank.facing;
  out.part.density = density;
  return out;
}

namespace {

part::SectionPartSpec section_part_of(const SectionTarget& target, const part::PartSpec& part) {
  return {.section = target.section,
          .start = part.start,
          .finish = part.finish,
          .start_frame = part.start_frame,
          .name = part.name,
          .clamping = part.clamping,
          .facing = part.facing,
          .density = part.density,
          .cutouts = part.cutouts};
}

/// Adds the square holes of a part to its cut-outs.
Result<void> cut_square_holes(PartRequest& r) {
  auto& p = r.part;
  auto added = part::add_square_holes(p.square_holes, p.target,
                                      r.section ? std::optional(r.section->section) : std::nullopt,
                                      p.zero, p.cutouts);
  if (added) return {};
  return tl::unexpected(on_request(r, std::move(added).error()));
}

}  // namespace

Result<PartRequest> resolve(PartRequest r) {
  if (r.section && !r.member) {
    TRY(cut_square_holes(r));
    auto marks = std::move(r.of_section.partners);
    auto start_tabs = std::move(r.of_section.start_tabs);
    auto finish_tabs = std::move(r.of_section.finish_tabs);
    r.of_section = section_part_of(*r.section, r.part);
    r.of_section.start_tabs = std::move(start_tabs);
    r.of_section.finish_tabs = std::move(finish_tabs);
    r.of_section.length = r.section->length.value_or(0.0);
    r.of_section.partners = std::move(marks);
    return r;
  }
  if (!r.member) {
    TRY(const auto zero,
        part::datum_angle(r.datum, r.seam, r.part.start.cut.partners, r.part.finish.cut.partners));
    r.part.zero = zero;
    TRY(cut_square_holes(r));
    return r;
  }
  r.member->clamping = r.part.clamping;
  r.member->facing = r.part.facing;
  r.member->density = r.part.density;
  TRY(auto found, part::find_member(*r.member));
  auto cutouts = std::move(r.part.cutouts);
  r.part = std::move(found.part);
  r.part.cutouts = std::move(cutouts);
  r.start_cutters = std::move(found.start_cutters);
  r.finish_cutters = std::move(found.finish_cutters);
  r.start_ids = names(r.member->node, r.start_cutters);
  r.finish_ids = names(r.member->node, r.finish_cutters);
  r.warnings = std::move(found.warnings);
  TRY(cut_square_holes(r));
  if (r.section) {
    r.of_section = section_part_of(*r.section, r.part);
    r.of_section.length = *r.part.target.length;
    r.of_section.partners = std::move(found.on_faces);
  }
  return r;
}

Error on_request(const PartRequest& request, Error error) {
  return renamed(on_branches(std::move(error), request.cutouts()), renamings(request));
}

std::vector<Warning> on_request(const PartRequest& request, std::vector<Warning> warnings) {
  return renamed(std::move(warnings), renamings(request));
}

}  // namespace tubecut::api
