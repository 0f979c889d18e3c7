#include "api/endpoints/frames/frame_request.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "api/endpoints/bevel_table_codec.hpp"
#include "api/endpoints/frames/frame_bodies.hpp"
#include "api/endpoints/frames/node_codec.hpp"
#include "api/endpoints/frames/plate_codec.hpp"
#include "api/endpoints/frames/tab_slots.hpp"
#include "api/endpoints/joint_codec.hpp"
#include "api/limits.hpp"
#include "api/wire/bevel_names.hpp"
#include "api/wire/frame_names.hpp"
#include "api/wire/joint_names.hpp"

namespace tubecut::api {
namespace {

using frame::How;

constexpr Range kGap{.min = 0.0, .max = 50.0};
constexpr Range kDistance{.min = 0.0, .max = limit::offset_max_mm};
constexpr Range kAlike{.min = 0.0, .max = 5.0};
constexpr double kAlikeByDefault = 0.02;  // mm: coordinates of three decimals make 0.005 of it
constexpr Range kAllowance{.min = 0.0, .max = 1e5};
constexpr Range kDensity{.min = 100.0, .max = 25'000.0};  // kg/m^3
constexpr std::size_t kMostOthers = 1'000;                // that joints name
constexpr std::size_t kMostOthersGiven = 100'000;
constexpr auto kMostJoints = 2 * static_cast<std::size_t>(limit::members_max);

/// Returns whether the branch enters the chord's wall, so that it has a hole by default.
bool enters(How::Kind kind) { return kind == How::Kind::set_in || kind == How::Kind::through; }

/// `gap_mm`, `depth_mm`, `plane` and `hole`, of a kind.
void decode_how(Reader& in, bool known_kind, How& out) {
  out.gap = in.number("gap_mm", kGap, 0.0);
  if (out.kind == How::Kind::set_in || !known_kind)
    out.depth = in.optional_number(
        "depth_mm", {.min = 0.0, .max = kDiameter.max / 2.0, .open_min = true, .open_max = true});
  static constexpr std::array kHoles{Option<bool>{"cut", true}, Option<bool>{"none", false}};
  if (out.kind == How::Kind::mitre || !known_kind)
    out.plane = in.choice("plane", joint::MitrePlane::bisecting);
  if (known_kind && (out.kind == How::Kind::mitre || out.kind == How::Kind::butt)) return;
  out.hole = in.choice("hole", kHoles, enters(out.kind));
}

/// A hole has no groove by zones.
void check_hole_groove(Reader& in, const How& how, const bevel::GrooveRule& groove,
                       std::string_view pointer) {
  if (how.hole && std::holds_alternative<bevel::ZonedGroove>(groove))
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = std::string(pointer),
              .hint = "the hole of a joint takes no zones"},
             in.find("groove"));
}

/// Checks that the joint has no gap if its zones set the root gap.
void check_zone_gaps(Reader& in, const How& how, const bevel::GrooveRule& groove) {
  const auto* zoned = std::get_if<bevel::ZonedGroove>(&groove);
  if (zoned != nullptr && zoned->has_root_gaps() && how.gap > 0.0)
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "gap_mm",
              .got = Json{how.gap},
              .limit = Json{0.0},
              .unit = "mm",
              .hint = "the groove's zones set the root gap: omit gap_mm"},
             in.find("gap_mm"));
}

void check_root_face(Reader& in, const bevel::TableSpec& cut) {
  if (cut.root_face > 0.0 && cut.contact != bevel::Contact::inner)
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "root_face_mm",
              .hint = "a root face requires contact inner"},
             in.find("root_face_mm"));
}

/// Decodes how detected joints are made, and how ends and holes are cut if their joint does not
/// override it.
bevel::TableSpec decode_defaults(Reader& in, FrameRequest& out) {
  const bool laser = out.preset == Preset::tube_laser;
  const auto decode = [&](Reader& d) {
    bevel::TableSpec cut;
    out.spec.found.kind =
        d.choice("kind", kOnly<How::Kind::set_on, How::Kind::set_in>, How::Kind::set_on);
    decode_how(d, d.understood("kind"), out.spec.found);
    decode_cut(d, false, out.preset, cut);
    if (cut.root_gap > 0.0)
      d.issue({.code = ErrorCode::unsupported_combination,
               .pointer = "root_gap_mm",
               .limit = Json{0.0},
               .hint = "a joint's gap_mm is the gap at its root"},
              d.find("root_gap_mm"));
    check_hole_groove(d, out.spec.found, cut.groove, "groove");
    check_zone_gaps(d, out.spec.found, cut.groove);
    if (laser)
      (void)decode_no_tilt(d);
    else
      (void)d.choice("tilt", bevel::Tilt::axial);
    for (const auto& [name, value] : d.echo()) {
      if (name == "tilt") out.tilt = value;
      for (const auto* one : {"root_surface", "groove", "contact", "root_face_mm", "root_gap_mm",
                              "coating_mm", "smoothing"})
        if (name == one) out.end.emplace_back(name, value);
    }
    return cut;
  };
  return laser ? in.defaulted_object("defaults", decode) : in.object("defaults", decode);
}

Json echoed(Reader& in, std::string_view name) {
  for (const auto& [field, value] : in.echo())
    if (field == name) return value;
  return {};
}

/// Decodes the overrides of a joint or an end; `cut` applies to the rest.
OwnCut decode_own_cut(Reader& in, Preset preset, bevel::TableSpec& cut) {
  const bool laser = preset == Preset::tube_laser;
  for (const auto* name : {"groove", "root_face_mm", "contact"}) in.note(name);
  const bool again = in.has("contact") || in.has("root_face_mm");
  if (in.has("groove"))
    cut.groove = laser ? decode_square_groove(in)
                       : in.object("groove", [](Reader& g) { return decode_groove(g, true); });
  if (in.has("root_face_mm"))
    cut.root_face = in.number("root_face_mm", {.min = 0.0, .max = limit::wall_max_mm});
  if (in.has("contact"))
    cut.contact =
        laser ? decode_untilted_contact(in) : in.choice("contact", kNames<bevel::Contact>);
  const bool sound = (!in.has("contact") || in.understood("contact")) &&
                     (!in.has("root_face_mm") || in.understood("root_face_mm"));
  if (again && sound) {
    check_combination(cut, in);
    check_root_face(in, cut);
  }
  return {
      .groove = echoed(in, "groove"),
      .contact = echoed(in, "contact"),
      .root_face = echoed(in, "root_face_mm"),
  };
}

OwnCut decode_joint_cut(Reader& in, const How& how, Preset preset, bevel::TableSpec cut) {
  auto out = decode_own_cut(in, preset, cut);
  check_hole_groove(in, how, cut.groove, "groove");
  check_zone_gaps(in, how, cut.groove);
  in.note("tilt");
  if (in.has("tilt"))
    (void)(preset == Preset::tube_laser ? decode_no_tilt(in)
                                        : in.choice("tilt", kNames<bevel::Tilt>));
  out.tilt = echoed(in, "tilt");
  return out;
}

/// One of `ends`.
OwnEnd decode_own_end(Reader& in, const NamedMembers& members, Preset preset,
                      bevel::TableSpec cut) {
  OwnEnd out{.member = known_member(in, members.ids, in.text("member"), "member"),
             .end = in.choice("end", kNames<joint::End>)};
  out.cut = decode_own_cut(in, preset, cut);
  for (const auto* name : {"smoothing", "kerf_mm"}) in.note(name);
  if (in.has("smoothing")) {
    if (preset == Preset::tube_laser)
      decode_no_smoothing(in, cut);
    else
      (void)in.object("smoothing", decode_smoothing);
  }
  if (in.has("kerf_mm")) (void)in.number("kerf_mm", kKerf);
  out.cut.smoothing = echoed(in, "smoothing");
  out.cut.kerf = echoed(in, "kerf_mm");
  return out;
}

void decode_own_ends(Reader& in, const NamedMembers& members, const bevel::TableSpec& cut,
                     FrameRequest& out) {
  in.note("ends");
  if (!in.has("ends")) return;
  std::set<std::pair<std::size_t, joint::End>> said;
  out.ends = in.array("ends", {.min = 0, .max = kMostJoints}, [&](Reader& e) {
    auto own = decode_own_end(e, members, out.preset, cut);
    if (!e.refused() && !said.emplace(own.member, own.end).second)
      e.issue({.code = ErrorCode::duplicate_id,
               .pointer = "end",
               .hint = "the cut of this end is already specified"},
              e.find("end"));
    return own;
  });
}

/// The two of `between`, the member first.
void decode_between(Reader& in, const BodyIndex& bodies, frame::StatedJoint& out) {
  const auto ids = in.text_column("between", {.min = 2, .max = 2});
  if (ids.size() != 2) return;
  auto a = known_body(in, bodies, ids[0], "between/0");
  auto b = known_body(in, bodies, ids[1], "between/1");
  if (!a || !b) return;
  using Of = BodyRef::Of;
  if (a->of != Of::members) std::swap(a, b);
  const bool none = a->of != Of::members;
  if (none || ids[0] == ids[1])
    in.issue({.code = ErrorCode::bad_choice,
              .pointer = "between",
              .hint = none ? "one of the two must be a member" : "a member cannot join itself"},
             in.find("between"));
  out.member = a->index;
  out.with = b->index;
  out.other = b->of == Of::others;
  out.plate = b->of == Of::plates;
}

/// Checks that an end is named if it is not detected: for `others`, and for joints that are only
/// stated.
void decode_named_end(Reader& in, bool by_nearness, frame::StatedJoint& out) {
  in.note("end");
  if (!in.has("end")) return;
  out.end = in.choice("end", kNames<joint::End>);
  if (by_nearness && out.of_members() && !in.refused())
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "end",
              .hint = "within_mm finds the ends of members; omit it"},
             in.find("end"));
}

void decode_joint(Reader& in, const BodyIndex& bodies, const bevel::TableSpec& cut,
                  FrameRequest& out) {
  frame::StatedJoint joint;
  decode_between(in, bodies, joint);
  decode_named_end(in, out.spec.within.has_value(), joint);
  const auto kind = in.tag("kind", kNames<How::Kind>);
  joint.how.kind = kind.value_or(How::Kind::set_on);
  const bool tabs = joint.how.kind == How::Kind::tab_slot;
  if (!kind) note_tab_slots(in);
  if (!tabs) decode_how(in, kind.has_value(), joint.how);
  if (joint.plate)
    check_plate_joint(in, kind.has_value(), joint);
  else if (kind && joint.other && joint.how.kind != How::Kind::set_on)
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "kind",
              .limit = Json{"set_on"},
              .hint = "bodies in `others` are not cut: use joint set_on"},
             in.find("kind"));
  else if (joint.other && joint.how.hole)
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "hole",
              .limit = Json{"none"},
              .hint = "a body in others is not cut, so it has no hole"},
             in.find("hole"));
  if (tabs) {
    out.tabs.push_back(decode_tab_slots(in, out.spec.joints.size()));
    out.cuts.push_back(cut_with_tabs());
  } else {
    out.cuts.push_back(decode_joint_cut(in, joint.how, out.preset, cut));
  }
  out.spec.joints.push_back(joint);
}

/// If there are more others than may be named, omits those that no joint names, because they cut
/// nothing.
void leave_out_others(Reader& in, FrameRequest& out) {
  const auto given = out.spec.others.size();
  std::vector<bool> named(given, given <= kMostOthers);
  for (const auto& joint : out.spec.joints)
    if (joint.other) named[joint.with] = true;
  std::vector<std::size_t> place(given);
  std::vector<frame::Other> kept;
  for (std::size_t i = 0; i < given; ++i) {
    if (!named[i]) continue;
    place[i] = kept.size();
    kept.push_back(std::move(out.spec.others[i]));
    out.others.push_back(i);
  }
  if (kept.size() > kMostOthers)
    in.issue({.code = ErrorCode::wrong_count,
              .pointer = "others",
              .got = Json{static_cast<double>(kept.size())},
              .limit = Json{static_cast<double>(kMostOthers)},
              .hint = "at most 1000 of the others may have a joint"});
  for (auto& joint : out.spec.joints)
    if (joint.other) joint.with = place[joint.with];
  out.others_left_out = given - kept.size();
  out.spec.others = std::move(kept);
}

void decode_once(Reader& in, FrameRequest& out) {
  bevel::TableSpec unused;
  decode_torch_and_kerf(in, out.preset, unused);
  (void)decode_sampling(in);
  in.defaulted_object("allowances", [](Reader& a) {
    a.number("clamping_mm", kAllowance, 0.0);
    return a.number("facing_mm", kAllowance, 0.0);
  });
  in.number("density_kg_m3", kDensity, 7850.0);
  for (const auto& [name, value] : in.echo())
    for (const auto* one :
         {"preset", "kerf_mm", "torch", "sampling", "allowances", "density_kg_m3", "accept"})
      if (name == one) out.once.emplace_back(name, value);
}

/// Returns whether any member has its own.
bool any(const std::vector<Json>& of_members) {
  return std::ranges::any_of(of_members, [](const Json& own) { return !(own == Json{}); });
}

/// A limit holds for the parts that it is measured for. Those of cut-outs need none, because a
/// shop's limits are in every request; the others need a part that has them.
void check_frame_accepts(Reader& in, const FrameRequest& frame) {
  const auto& spec = frame.spec;
  const bool sound = in.sound("members");
  const auto round = [](const joint::Member& m) { return !m.section; };
  const auto hole = [](const frame::StatedJoint& joint) { return joint.how.hole && !joint.plate; };
  check_accepts(in, {.preset = frame.preset,
                     .round = !sound || std::ranges::any_of(spec.members, round),
                     .cutouts = true,
                     .holes = spec.found.hole || std::ranges::any_of(spec.joints, hole)});
}

}  // namespace

FrameRequest decode_frame_request(Reader& in) {
  FrameRequest out;
  out.preset = decode_preset(in);
  auto members = decode_named_members(in, out.preset);
  std::vector<WorldCutter> others;
  in.note("others");
  if (in.has("others"))
    others = in.array("others", {.min = 0, .max = kMostOthersGiven}, decode_world_cutter);
  out.spec.plates = decode_plates(in);
  const auto bodies = body_index(in, members, others, out.spec.plates);
  out.spec.members = members.members;
  out.walls = members.walls;
  out.sections = members.sections;
  out.cutouts = std::move(members.cutouts);
  out.texts = std::move(members.texts);
  for (auto& one : others) out.spec.others.push_back({std::move(one.partner), std::move(one.name)});
  if (const auto within =
          in.optional_object("connect", [](Reader& c) { return c.number("within_mm", kDistance); }))
    out.spec.within = *within;
  const auto cut = decode_defaults(in, out);
  in.note("joints");
  if (in.has("joints"))
    in.array("joints", {.min = 0, .max = kMostJoints}, [&](Reader& j) {
      decode_joint(j, bodies, cut, out);
      return 0;
    });
  leave_out_others(in, out);
  decode_own_ends(in, members, cut, out);
  out.alike_within = in.number("alike_within_mm", kAlike, kAlikeByDefault);
  in.note("merge_in_line");
  if (in.has("merge_in_line")) out.merge = in.flag("merge_in_line");
  if (out.merge && (any(out.cutouts) || any(out.texts) || !out.tabs.empty()))
    in.issue({.code = ErrorCode::unsupported_combination,
              .pointer = "merge_in_line",
              .hint = "cut-outs, slots and texts are placed from a member's own ends; draw merged "
                      "members as one"},
             in.find("merge_in_line"));
  check_frame_accepts(in, out);
  decode_once(in, out);
  return out;
}

}  // namespace tubecut::api
