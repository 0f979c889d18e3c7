#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "api/endpoints/section_target.hpp"
#include "api/endpoints/tube_laser.hpp"
#include "api/wire/reader.hpp"
#include "core/joint/node/node.hpp"

namespace tubecut::api {

/// Indices of a node's members by id.
struct MemberIds {
  std::map<std::string, std::size_t, std::less<>> indices;
  bool complete = true;  // all ids are known, so an unknown one is an error
};
/// Returns the member whose id is `id`; `pointer` names the field for an issue.
std::size_t known_member(Reader& in, const MemberIds& ids, const std::string& id,
                         const std::string& pointer);
/// `members` of a frame, whose joints are given elsewhere.
struct NamedMembers {
  std::vector<joint::Member> members;
  std::vector<double> walls;  // as they are given: of one out of range its member has another
  std::vector<Json::Object> sections;  // of those that are not round: its fields as they are given
  std::vector<Json> cutouts, texts;    // of each, with their defaults; null without
  MemberIds ids;
};
/// If a member is out of range, it has no issue unless all are, because its part reports the error.
/// `preset`: of the request, for the members' cut-outs.
[[nodiscard]] NamedMembers decode_named_members(Reader& in, Preset preset);

struct NamedNode {
  joint::NodeSpec spec;
  MemberIds ids;
  std::vector<bool>
      nominal;  // of each member: its corners are those that a standard calculates with
};
/// Decodes `members` and `connect`: the content of a /v1/nodes request, and of `node` elsewhere.
[[nodiscard]] NamedNode decode_named_node(Reader& in);

/// Returns a member that is not round as a target; empty for a round one.
[[nodiscard]] std::optional<SectionTarget> section_of(const NamedNode& node, std::size_t member);
/// Refuses a member that is not round (unsupported_target) at its kind or size. `in` has `members`.
void refuse_section(Reader& in, std::size_t member, const std::string& hint);

/// One end of one member of a node.
struct NodeEnd {
  joint::NodeSpec node;
  std::size_t member = 0;
  joint::End end = joint::End::start;
  std::optional<SectionTarget> section = {};  // of a member that is not round
};

/// A joint given directly, or as one end of a node: exactly one of the two.
struct JointSource {
  joint::Target target = {};
  std::vector<joint::Partner> partners = {};
  std::vector<std::optional<joint::Joint>> stated = {};  // how they are joined, of a node
  std::optional<NodeEnd> node = {};
  joint::EndJoint found = {};  // of the node, once resolved
};
enum class Targets { round, any };
/// `target` with `cutters`, or `node`. `targets`: of the node's end; one that is not round is
/// refused, or is in `node->section`.
[[nodiscard]] JointSource decode_joint(Reader& in, Targets targets = Targets::round);
/// Returns true if the request's `node` asks for an end of a member that is not round.
[[nodiscard]] bool has_section_end(const Reader& in);

/// Finds target and partners of a node's end.
///
/// Errors  those of joint::joint_at, naming node/...
[[nodiscard]] Result<JointSource> resolve(JointSource source);

/// The same issue or warning, naming the node's members instead of target and cutters.
[[nodiscard]] Error on_node(const JointSource& source, Error error);
template <class T>
[[nodiscard]] Result<T> on_node(const JointSource& source, Result<T> of) {
  return std::move(of).map_error([&](Error error) { return on_node(source, std::move(error)); });
}
[[nodiscard]] std::vector<Warning> on_node(const JointSource& source,
                                           std::vector<Warning> warnings);

/// Ids of the members that cut the node's end, in the order of the index `cutter`; empty without a
/// node.
[[nodiscard]] std::vector<std::string> cutter_ids(const JointSource& source);

}  // namespace tubecut::api
