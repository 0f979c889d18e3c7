#include "api/endpoints/frames/node_codec.hpp"

#include <algorithm>
#include <array>

#include "api/endpoints/cutouts/cutout_codec.hpp"
#include "api/endpoints/frames/renaming.hpp"
#include "api/endpoints/hole_codec.hpp"
#include "api/endpoints/joint_codec.hpp"
#include "api/limits.hpp"
#include "core/base/try.hpp"

namespace tubecut::api {
namespace {

constexpr Range kDistance{.min = 0.0, .max = limit::offset_max_mm};
constexpr Range kComponent{.min = -1e6, .max = 1e6};
constexpr int kPriorities = 1'000;
constexpr auto kMembers = static_cast<std::size_t>(limit::members_max);

constexpr std::size_t kMostJoints = 1'000;  // of one member, with others

/// A member, and its statements about its joints, with the other members still by name.
struct NamedMember {
  joint::Member member;
  bool nominal = false;
  std::vector<std::pair<std::string, joint::Joint>> joints;
  Json cutouts = {}, texts = {};
};

/// How cut-outs of a frame's members are cut.
struct CutoutRule {
  Preset preset;
  double kerf;
};

/// Decodes cut-outs and texts of a frame's member. Those of a round one are placed by its `up`.
void decode_member_cutouts(Reader& in, const CutoutRule& rule, bool sure, NamedMember& named) {
  const auto& m = named.member;
  bevel::TableSpec once;
  once.target = {.outer_radius = m.outer_radius, .wall = m.wall};
  once.kerf = rule.kerf;
  const auto cutouts =
      decode_cutouts(in, rule.preset, once, m.section ? &*m.section : nullptr, sure);
  for (const auto& [name, value] : in.echo()) {
    if (name == "cutouts" && !cutouts.all.empty()) named.cutouts = value;
    if (name == "texts" && !cutouts.texts.empty()) named.texts = value;
  }
  const bool any = !cutouts.all.empty() || !cutouts.texts.empty();
  if (!any || m.section || in.has("up")) return;
  in.issue({.code = ErrorCode::missing_field,
            .pointer = "up",
            .hint = "places of cut-outs and texts round the tube count from this side"});
}

/// Range of a member that the service does not cut: only its position matters.
constexpr Range kSomewhere{.min = -1e8, .max = 1e8};
constexpr Range kSomeSize{.min = 0.0, .max = 1e5, .open_min = true};

/// Decodes diameter and wall of any size.
TubeSection decode_any_section(Reader& in) {
  if (in.has("size")) return decode_tube_section(in, true);
  TubeSection out;
  out.outer_radius = in.number("outer_diameter_mm", kSomeSize) / 2.0;
  out.wall = in.number("wall_mm", kSomeSize);
  return out;
}

enum class MemberKind { round, rectangular_tube, flat_oval_tube };
constexpr std::array kMemberKinds{
    Option<MemberKind>{"round", MemberKind::round},
    Option<MemberKind>{"rectangular_tube", MemberKind::rectangular_tube},
    Option<MemberKind>{"flat_oval_tube", MemberKind::flat_oval_tube}};

/// Refuses an unknown kind, and the lengths of a section without one; the other fields depend on
/// it.
bool names_kind(Reader& in) {
  static constexpr std::array<std::string_view, 5> kOfSection{
      "height_mm", "width_mm", "corners", "corner_radius_mm", "inner_corner_radius_mm"};
  const bool round = in.has("outer_diameter_mm") || in.has("size");
  in.note("kind");
  if (in.has("kind"))
    in.choice("kind", kMemberKinds);
  else if (!round && std::ranges::any_of(kOfSection, [&](auto name) { return in.has(name); }))
    in.issue({.code = ErrorCode::missing_field,
              .pointer = "kind",
              .hint = "rectangular_tube or flat_oval_tube, because the member has their fields"});
  else
    return true;
  if (in.has("kind") && in.understood("kind")) return true;
  for (const auto name : kOfSection) in.note(name);
  for (const auto* name : {"size", "outer_diameter_mm", "wall_mm"}) in.note(name);
  return false;
}

/// Decodes the member's diameter and wall, or its section.
void decode_shape(Reader& in, bool any_size, NamedMember& named) {
  auto& out = named.member;
  if (is_section(in.body())) {
    const auto section = decode_section(in, decode_section_kind(in));
    out.section = section.section;
    named.nominal = section.nominal;
    out.outer_radius = out.half_size();
    out.wall = out.thickness();
    return;
  }
  if (!names_kind(in)) return;
  const auto section = any_size ? decode_any_section(in) : decode_tube_section(in, true);
  out.outer_radius = section.outer_radius;
  out.wall = section.wall;
}

NamedMember decode_member(Reader& in, bool with_joints, bool any_size = false,
                          const CutoutRule* rule = nullptr) {
  NamedMember named;
  auto& out = named.member;
  out.name = in.text("id");
  out.start = in.vector3("start_mm", any_size ? kSomewhere : kOffset);
  out.finish = in.vector3("end_mm", any_size ? kSomewhere : kOffset);
  decode_shape(in, any_size, named);
  out.priority = in.integer("priority", 0, kPriorities, 0);
  in.note("up");
  if (in.has("up") || out.section) out.up = in.vector3("up", kComponent);
  if (rule != nullptr) decode_member_cutouts(in, *rule, !any_size && !in.refused(), named);
  if (with_joints) in.note("joints");
  if (with_joints && in.has("joints"))
    named.joints = in.array("joints", {.min = 0, .max = kMostJoints}, [](Reader& j) {
      auto with = j.text("member");
      return std::pair{std::move(with), decode_joint_kind(j, kDiameter.max / 2.0, true)};
    });
  return named;
}

MemberIds decode_ids(Reader& in, const std::vector<joint::Member>& members) {
  MemberIds out;
  const auto* field = in.find("members");
  const auto* items = field == nullptr ? nullptr : field->as<Json::Array>();
  out.complete = items != nullptr && !items->empty() && items->size() == members.size();
  for (const auto& member : members) out.complete = out.complete && !member.name.empty();
  for (std::size_t i = 0; i < members.size(); ++i)
    if (!members[i].name.empty() && !out.indices.emplace(members[i].name, i).second) {
      out.complete = false;  // which member had the id that is missing now, nobody knows
      in.issue({.code = ErrorCode::duplicate_id,
                .pointer = "members/" + std::to_string(i) + "/id",
                .got = Json{members[i].name},
                .hint = "duplicate: another member has this id"});
    }
  return out;
}

/// The joints that members state, in the order of the members.
std::vector<joint::StatedJoint> stated_joints(Reader& in, const MemberIds& ids,
                                              const std::vector<NamedMember>& members) {
  std::vector<joint::StatedJoint> out;
  for (std::size_t i = 0; i < members.size(); ++i)
    for (std::size_t j = 0; j < members[i].joints.size(); ++j) {
      const auto& [with, joint] = members[i].joints[j];
      const auto pointer =
          "members/" + std::to_string(i) + "/joints/" + std::to_string(j) + "/member";
      const auto other = known_member(in, ids, with, pointer);
      if (!with.empty() && with == members[i].member.name)
        in.issue({.code = ErrorCode::bad_choice,
                  .pointer = pointer,
                  .got = Json{with},
                  .hint = "a member cannot join itself"});
      out.push_back({.member = i, .with = other, .joint = joint});
    }
  return out;
}

joint::Link decode_link(Reader& in, const MemberIds& ids) {
  joint::Link out;
  const auto own = in.text("member");
  out.member = known_member(in, ids, own, "member");
  out.end = in.choice("end", kNames<joint::End>);
  const auto to = in.text_column("to", {.min = 1, .max = joint::kMostCutters});
  for (std::size_t i = 0; i < to.size(); ++i) {
    const auto pointer = "to/" + std::to_string(i);
    const auto other = known_member(in, ids, to[i], pointer);
    if (!own.empty() && to[i] == own)
      in.issue({.code = ErrorCode::bad_choice,
                .pointer = pointer,
                .got = Json{to[i]},
                .hint = "a member cannot join itself"});
    out.to.push_back(other);
  }
  return out;
}

NodeEnd decode_end(Reader& in) {
  const auto node = decode_named_node(in);
  NodeEnd out{.node = node.spec};
  const auto id = in.text("member");
  out.member = known_member(in, node.ids, id, "member");
  if (node.ids.indices.contains(id)) out.section = section_of(node, out.member);
  out.end = in.choice("end", kNames<joint::End>);
  return out;
}

/// Target and cutters as the members that they are.
Renamings renamings(const JointSource& source) {
  const auto of = [](std::size_t i) { return "node/members/" + std::to_string(i); };
  const auto& found = source.found;
  Renamings out;
  for (std::size_t i = 0; i < found.cutters.size(); ++i)
    out.push_back({"cutters/" + std::to_string(i), of(found.cutters[i]), false});
  for (const auto* one : {"cutters", "target"}) out.push_back({one, of(found.member), false});
  return out;
}

}  // namespace

std::size_t known_member(Reader& in, const MemberIds& ids, const std::string& id,
                         const std::string& pointer) {
  const auto found = ids.indices.find(id);
  if (found != ids.indices.end()) return found->second;
  if (id.empty() || !ids.complete) return 0;  // has its issue already
  std::vector<std::string> names;
  for (const auto& [name, index] : ids.indices) names.push_back(name);
  const auto near = nearest_name(id, names);
  in.issue({.code = ErrorCode::bad_choice,
            .pointer = pointer,
            .got = Json{id},
            .hint = near.empty() ? "no member has this id" : "did you mean " + near + "?"});
  return 0;
}

NamedNode decode_named_node(Reader& in) {
  NamedNode out;
  const auto members = in.array("members", {.min = 1, .max = kMembers},
                                [](Reader& m) { return decode_member(m, true); });
  for (const auto& one : members) {
    out.spec.members.push_back(one.member);
    out.nominal.push_back(one.nominal);
  }
  out.ids = decode_ids(in, out.spec.members);
  out.spec.joints = stated_joints(in, out.ids, members);
  if (in.is<Json::Array>("connect"))
    out.spec.connect = in.array("connect", {.min = 1, .max = 2 * kMembers},
                                [&](Reader& link) { return decode_link(link, out.ids); });
  else
    out.spec.connect = in.object(
        "connect", [](Reader& c) { return joint::Within{c.number("within_mm", kDistance)}; });
  return out;
}

namespace {

/// Returns the members that are only out of range, if another one is not: those have no part, and
/// the others remain valid.
std::vector<bool> out_of_range(Reader& in, const CutoutRule& rule) {
  const auto* field = in.find("members");
  const auto* items = field == nullptr ? nullptr : field->as<Json::Array>();
  std::vector<bool> out;
  bool any = false;
  for (std::size_t i = 0; items != nullptr && i < items->size(); ++i) {
    Reader alone((*items)[i]);
    if ((*items)[i].as<Json::Object>() != nullptr) (void)decode_member(alone, false, false, &rule);
    const auto issues = alone.finish_root();
    any = any || issues.empty();
    out.push_back(!issues.empty() && std::ranges::all_of(issues, [](const FieldIssue& issue) {
      return issue.code == ErrorCode::out_of_range;
    }));
  }
  if (!any) out.assign(out.size(), false);
  return out;
}

/// Returns the fields that define a section, as a target has them.
Json::Object section_fields(const Reader& member) {
  Json::Object out;
  for (const auto& one : member.echo())
    for (const auto* name : {"kind", "size", "height_mm", "width_mm", "wall_mm", "corners",
                             "corner_radius_mm", "inner_corner_radius_mm"})
      if (one.first == name) out.push_back(one);
  return out;
}

}  // namespace

NamedMembers decode_named_members(Reader& in, Preset preset) {
  constexpr double kThickest = 0.9;  // fraction of a radius: drawn thickness of a wall that exceeds
                                     // it
  NamedMembers out;
  const auto* kerf = in.find("kerf_mm");  // read, and held against its range, later
  const auto* width = kerf == nullptr ? nullptr : kerf->as<double>();
  const CutoutRule rule{preset, width == nullptr ? 0.0 : *width};
  const auto any_size = out_of_range(in, rule);
  for (auto& one : in.array("members", {.min = 1, .max = kMembers}, [&](Reader& m) {
         const auto i = out.walls.size();
         auto member = decode_member(m, false, i < any_size.size() && any_size[i], &rule);
         out.cutouts.push_back(member.cutouts);
         out.texts.push_back(member.texts);
         out.walls.push_back(member.member.wall);
         out.sections.push_back(section_fields(m));
         return member;
       })) {
    auto& m = one.member;
    if (!(m.wall < m.outer_radius)) m.wall = kThickest * m.outer_radius;
    out.members.push_back(std::move(m));
  }
  out.ids = decode_ids(in, out.members);
  return out;
}

std::optional<SectionTarget> section_of(const NamedNode& node, std::size_t member) {
  if (member >= node.spec.members.size()) return std::nullopt;
  const auto& m = node.spec.members[member];
  if (!m.section) return std::nullopt;
  return SectionTarget{.section = *m.section,
                       .nominal = node.nominal[member],
                       .length = (m.finish - m.start).norm()};
}

void refuse_section(Reader& in, std::size_t member, const std::string& hint) {
  const auto* items = in.find("members");
  const auto* all = items == nullptr ? nullptr : items->as<Json::Array>();
  if (all == nullptr || member >= all->size()) return;
  const std::string field = (*all)[member].find("kind") != nullptr ? "kind" : "size";
  in.issue({.code = ErrorCode::unsupported_target,
            .pointer = "members/" + std::to_string(member) + "/" + field,
            .limit = Json{"round"},
            .hint = hint},
           (*all)[member].find(field));
}

bool has_section_end(const Reader& in) {
  const auto* node = in.find("node");
  const auto* name = node == nullptr ? nullptr : node->find("member");
  const auto* asked = name == nullptr ? nullptr : name->as<std::string>();
  const auto* members = node == nullptr ? nullptr : node->find("members");
  const auto* all = members == nullptr ? nullptr : members->as<Json::Array>();
  if (asked == nullptr || all == nullptr) return false;
  return std::ranges::any_of(*all, [&](const Json& one) {
    const auto* field = one.find("id");
    const auto* id = field == nullptr ? nullptr : field->as<std::string>();
    return id != nullptr && *id == *asked && is_section(one);
  });
}

JointSource decode_joint(Reader& in, Targets targets) {
  JointSource out;
  const auto which = in.exactly_one({"target", "node"});
  in.note("cutters");
  if (which == 1) {
    out.node = in.object("node", [&](Reader& n) {
      auto end = decode_end(n);
      if (end.section && targets == Targets::round)
        refuse_section(n, end.member, "ends of it are cut by " + std::string(kSectionPaths));
      return end;
    });
    if (in.has("cutters"))
      in.issue({.code = ErrorCode::exclusive_fields,
                .pointer = "cutters",
                .hint = "the node's members are the cutters"},
               in.find("cutters"));
  } else if (which == 0) {
    out.target = decode_target(in);
    out.partners = decode_cutters(in);
  }
  return out;
}

Result<JointSource> resolve(JointSource source) {
  if (!source.node) return source;
  const auto& asked = *source.node;
  TRY(source.found, under("node", joint::joint_at(asked.node, asked.member, asked.end)));
  source.target = source.found.target;
  source.partners = source.found.partners;
  source.stated = source.found.stated;
  return source;
}

Error on_node(const JointSource& source, Error error) {
  if (!source.node) return error;
  return renamed(std::move(error), renamings(source));
}

std::vector<Warning> on_node(const JointSource& source, std::vector<Warning> warnings) {
  if (!source.node) return warnings;
  warnings = renamed(std::move(warnings), renamings(source));
  for (auto& warning : under("node", source.found.warnings)) warnings.push_back(std::move(warning));
  return warnings;
}

std::vector<std::string> cutter_ids(const JointSource& source) {
  std::vector<std::string> out;
  if (source.node)
    for (const auto i : source.found.cutters) out.push_back(source.node->node.members[i].name);
  return out;
}

}  // namespace tubecut::api
