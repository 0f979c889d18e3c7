#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/variant.hpp"
#include "core/joint/intersection.hpp"
#include "core/joint/joint.hpp"
#include "core/joint/placement.hpp"

namespace tubecut::joint {

/// Cutters one end may have.
inline constexpr std::size_t kMostCutters = 64;

/// A tube by its centre-line in the world. Lengths in mm.
struct Member {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d finish = Eigen::Vector3d::UnitX();
  double outer_radius = 0.0;
  double wall = 0.0;
  int priority = 0;                        // a lower number cuts a higher one
  std::optional<Eigen::Vector3d> up = {};  // phi = 0 on this side at both ends; empty: the chord's
  std::string name = {};                   // for messages only

  [[nodiscard]] const Eigen::Vector3d& at(End end) const {
    return end == End::start ? start : finish;
  }
  /// From an end towards the other.
  [[nodiscard]] Eigen::Vector3d into(End end) const {
    return at(end == End::start ? End::finish : End::start) - at(end);
  }
};

/// An end joins every member whose axis, between its ends, is within `distance` + that member's
/// radius.
struct Within {
  double distance = 0.0;
};
/// One end joins just these members.
struct Link {
  std::size_t member = 0;
  End end = End::start;
  std::vector<std::size_t> to;
};

/// Members that meet at one or more nodes. Of two that join, the one with the lower priority
/// number, then the larger diameter cuts the other; of two alike (found by `Within`) the one that
/// goes on where the other ends, then the earlier place in the list, of pieces in line that of the
/// earliest: two never cut each other. Two whose joint nobody states are set on without a gap; in
/// line (in_line.hpp) and with nothing between them that cuts both all round, they are mitred.
struct NodeSpec {
  std::vector<Member> members;
  Variant<Within, std::vector<Link>> connect;
  std::vector<StatedJoint> joints = {};  // said by either of the two, or alike by both
  std::size_t found = 0;                 // the last so many of them: nobody has said them
};

/// What members state of their joint; nullptr where neither does. Of two that differ, the first.
[[nodiscard]] const Joint* stated_joint(const NodeSpec& spec, std::size_t a, std::size_t b);

/// One member that cuts an end. Lengths in mm.
struct CutBy {
  std::size_t member = 0;
  Placement placement;  // in the frame of the end; its line's point is the member's start
  std::optional<PlaneCutter> plane = {};  // of a mitre, in the same frame: cuts instead of the tube
  std::optional<Joint> stated = {};       // how they are joined, if stated; set-in with its depth
  double gap = 0.0;                       // from the end to the member's axis between its ends
  double eccentricity = 0.0;              // distance of the axes; of a mitre at its plane
  bool ghost = false;                     // the cut follows it beyond one of its own ends
  double missing = 0.0;                   // so far, mm; or where another continues it, by how much
  std::optional<std::size_t> instead = {};  // that one lies lower
};

/// One end of one member, and what is cut there.
struct MemberEnd {
  std::size_t member = 0;
  End end = End::start;
  MemberFrame frame;
  std::vector<CutBy> cut_by;  // the chord first
  bool free = false;          // joins nothing
  bool open = false;          // some generator meets no cutter
  bool consumed = false;      // the cut reaches beyond the member's other end
};

/// What cuts: the member's tube, or a mitre's plane.
[[nodiscard]] Partner partner_of(const CutBy& cut);

struct Nodes {
  std::vector<MemberEnd> ends;  // start and finish of each member, in their order
  std::vector<Warning> warnings;
};

/// Finds at every end who joins, who cuts whom, and where. Phase zero of an end: `up`; else source
/// 000's, with which its chord has clocking 0; an end without cutters takes the world axis
/// furthest from its own (the first of equals).
///
/// A member that is found cuts an end only if it is there: one whose contacts all lie beyond its
/// own ends does not. Neither does one within 5 deg of parallel whose cut would reach beyond the
/// other end (parallel_members).
///
/// A joint that is stated changes who cuts: through, neither the other; mitre, a plane both. The
/// plane passes where the axes are nearest to each other (in line, and that far from the ends:
/// midway between these) and leans alike to both.
///
/// Errors    zero_length, bad_reference_direction (members/i...); wrong_count (more than
///           kMostCutters join one end); ambiguous_connection (two passing members, alike in
///           priority and diameter, equally near); joint_contradicts, no_contact, out_of_range
///           (members/i/joints/j: both sides differ; the two do not meet; the depth); out_of_range
///           (a link's index); cancelled.
/// Accuracy  world -> numbers -> world 1e-12 relative (worst seen: see tests/core/joint/node_test).
/// Cost      memory linear in members; time as `touches`, and 1 us for each cutter, 10 us for each
///           end whose cut may pass its partners' ends.
/// Source    docs/theory/intersections-and-bevels.md, section 1.1.
[[nodiscard]] Result<Nodes> solve(const NodeSpec& spec, const std::stop_token& stop = {});

/// The target and partners of one cut end, as `intersect` and `bevel::table` take them, and which
/// members they are.
struct EndJoint {
  Target target;
  std::vector<Partner> partners;
  std::vector<std::optional<Joint>> stated;  // of each partner
  std::size_t member = 0;
  std::vector<std::size_t> cutters;
  std::vector<Warning> warnings;  // those of `solve` about this end
};

/// What issues and warnings call an end: "members/3/start".
[[nodiscard]] std::string place_of(std::size_t member, End end);

/// Errors  as `solve`; no_contact (members/i: nothing cuts this end).
[[nodiscard]] Result<EndJoint> joint_at(const NodeSpec& spec, std::size_t member, End end,
                                        const std::stop_token& stop = {});
[[nodiscard]] EndJoint joint_of(const NodeSpec& spec, const MemberEnd& end);
/// The surfaces the end lies on, for its curves.
[[nodiscard]] std::vector<Partner> seats(const EndJoint& joint);

/// The curves of every end that is cut all round: the others, and those whose member is consumed,
/// have none.
///
/// Errors  too_many_nodes (of all ends together), cancelled.
[[nodiscard]] Result<std::vector<std::optional<Intersection>>> profiles(
    const NodeSpec& spec, const Nodes& nodes, const Sampling& sampling,
    const std::stop_token& stop = {});

/// The answer held against the centre-lines in the world: axes by cross products, angles by half
/// tangents, who cuts whom by the rules alone.
[[nodiscard]] std::vector<Check> verify(const NodeSpec& spec, const Nodes& nodes,
                                        const std::stop_token& stop = {});

}  // namespace tubecut::joint
