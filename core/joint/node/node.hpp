#pragma once

// Finds at every end of every member which members join it, which of them cut it, and where.
//
// Idea: an order of the members (see `NodeSpec`) determines which member cuts which, so two members
// never cut each other. Each cut end gets its own frame, in which `intersect` and `bevel::table`
// work.
//
// Example: a brace from the middle of a chord; the chord cuts its start.
//     joint::NodeSpec spec;
//     spec.members = {{{0, 0, 0}, {2000, 0, 0}, 57.15, 5},
//                     {{1000, 0, 0}, {1500, 0, 866}, 30.15, 4}};
//     spec.connect = joint::Within{1};
//     const auto nodes = joint::solve(spec).value();
//     const auto& cut = nodes.ends[2].cut_by[0];  // the start of member 1, cut by member 0
//     const double deg = cut.placement.tube.inclination.deg();  // between the axes: 60.0

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/variant.hpp"
#include "core/joint/intersection.hpp"
#include "core/joint/joint.hpp"
#include "core/joint/node/member.hpp"
#include "core/joint/placement.hpp"

namespace tubecut::joint {

/// Maximum number of cutters of one end.
inline constexpr std::size_t kMostCutters = 64;

/// An end joins a member if its distance to that member's axis, between its ends, is at most
/// `distance` plus the member's radius. For a section, its reach replaces the radius.
struct Within {
  double distance = 0.0;
};
/// One end joins only these members.
struct Link {
  std::size_t member = 0;
  End end = End::start;
  std::vector<std::size_t> to;
};

/// Members that meet at one or more nodes. Of two that join, the one that cuts the other has:
///   1. the lower priority number;
///   2. if equal, the axis that continues where the other member ends, if both are of one size (by
///      `Within`), or the other, although larger, is not the wider across both axes;
///   3. the larger diameter, or larger side of a section;
///   4. else the earlier place in `members`; for members in line, that of the earliest of the line.
/// If no joint of two is stated, they are set on without a gap; if they are in line (in_line.hpp)
/// and nothing between them cuts both on all sides, they are mitred.
struct NodeSpec {
  std::vector<Member> members;
  Variant<Within, std::vector<Link>> connect;
  std::vector<StatedJoint> joints = {};  // stated by either of the two, or equally by both
  std::size_t found = 0;  // number of entries at the end of `joints` that were detected
};

/// Returns the stated joint of two members, the first of two that differ; nullptr if none.
[[nodiscard]] const Joint* stated_joint(const NodeSpec& spec, std::size_t a, std::size_t b);

/// One member that cuts an end. Lengths in mm.
struct CutBy {
  std::size_t member = 0;
  Placement placement;  // in the frame of the end; its line's point is the member's start
  std::optional<PlaneCutter> plane = {};  // of a mitre, in the same frame: cuts instead of the tube
  std::optional<RectangularTubeCutter> box = {};  // of a section, likewise; the placement's tube
                                                  // has its reach as radius
  std::optional<Joint> stated = {};               // the stated joint, if any; set-in with its depth
  double gap = 0.0;           // distance from the end to the segment of the member's axis
  double eccentricity = 0.0;  // distance of the axes; of a mitre at its plane
  bool ghost = false;         // the cut follows it beyond one of its own ends
  double missing = 0.0;       // how far the cut follows it beyond its metal, mm; if another member
                              // continues it, the step between the two
  std::optional<std::size_t> instead = {};  // that member, if its surface is lower there
  bool past_mitre = false;                  // true if it is missing beyond a mitre of the member
};

/// One end of one member, and its cut.
struct MemberEnd {
  std::size_t member = 0;
  End end = End::start;
  MemberFrame frame;
  std::vector<CutBy> cut_by;  // the chord first
  bool free = false;          // joins nothing
  bool open = false;          // some generator meets no cutter
  bool overhangs = false;     // the same, but by at most kSlightOverhang
  bool consumed = false;      // the cut extends beyond the member's other end
};

/// Returns the body that cuts: the member's tube or section, or a mitre's plane.
[[nodiscard]] Partner partner_of(const CutBy& cut);

/// Fraction of the member's reach that counts as near in `cuts_anywhere`: more than a cutter rises
/// between two samples.
inline constexpr double kHidden = 0.005;
/// Returns for each of `cut_by` whether it is on or near the outermost surface at any of 180
/// samples, on the outside or the bore. If others hide a cutter everywhere, returns false for it.
[[nodiscard]] std::vector<bool> cuts_anywhere(const Member& member, const MemberEnd& end);

struct Nodes {
  std::vector<MemberEnd> ends;  // start and finish of each member, in their order
  std::vector<Warning> warnings;
};

/// Finds the joining members at every end, which of them cut it, and where. Phase zero of an end is
/// `up` if given, otherwise the direction in which its chord has clocking 0; an end without cutters
/// takes the world axis furthest from its own (the first of equals).
///
/// A found member cuts an end only if it is present there: if all its contacts lie beyond its own
/// ends, or where other members have cut it away, it does not cut. A found member within 5 deg of
/// parallel does not cut either, if its cut would extend beyond the other end (parallel_members).
///
/// A stated joint changes who cuts: for through, neither cuts the other; for mitre, a plane cuts
/// both. The plane passes through the point where the axes are nearest to each other (if they are
/// in line, or that point is far from the ends: midway between the ends) at equal angles to both.
///
/// Errors    zero_length, bad_reference_direction (members/i...; members/i/up: a section without
///           it); those of section::check (members/i/...); wrong_count (more than kMostCutters join
///           one end); ambiguous_connection (two passing members, alike in
///           priority and diameter, equally near); joint_contradicts, no_contact, out_of_range
///           (members/i/joints/j: both sides differ; the two do not meet; the depth);
///           unsupported_combination (members/i/joints/j/plane: corner to corner, and a section is
///           turned out of the plane of both axes); out_of_range (a link's index); cancelled.
/// Accuracy  world -> numbers -> world 1e-12 relative (worst seen: see tests/core/joint/node_test).
/// Cost      memory linear in members; time as `touches`, and 1 us for each cutter, 10 us for each
///           end whose cut may pass its partners' ends.
/// Source    docs/theory/intersections-and-bevels.md, section 1.1.
[[nodiscard]] Result<Nodes> solve(const NodeSpec& spec);

/// The target and partners of one cut end, in the form for `intersect` and `bevel::table`, and the
/// indices of the members.
struct EndJoint {
  Target target;
  std::vector<Partner> partners;
  std::vector<std::optional<Joint>> stated;  // of each partner
  std::size_t member = 0;
  std::vector<std::size_t> cutters;
  std::vector<Warning> warnings;                 // those of `solve` about this end
  std::optional<section::Section> section = {};  // of a target that is not round
};

/// Returns the path of an end in issues and warnings: "members/3/start".
[[nodiscard]] std::string place_of(std::size_t member, End end);

/// Errors  as `solve`; no_contact (members/i: nothing cuts this end).
[[nodiscard]] Result<EndJoint> joint_at(const NodeSpec& spec, std::size_t member, End end);
[[nodiscard]] EndJoint joint_of(const NodeSpec& spec, const MemberEnd& end);
/// Returns the surfaces on which the end lies, for its curves.
[[nodiscard]] std::vector<Partner> seats(const EndJoint& joint);

/// Verifies the answer against the centre-lines in the world: axes by cross products, angles by
/// half tangents, and who cuts whom from the rules.
[[nodiscard]] std::vector<Check> verify(const NodeSpec& spec, const Nodes& nodes);

}  // namespace tubecut::joint
