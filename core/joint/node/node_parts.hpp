#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "core/joint/nearness.hpp"
#include "core/joint/node/in_line.hpp"
#include "core/joint/node/node.hpp"
#include "core/joint/node/shape.hpp"

/// For `solve` only.
namespace tubecut::joint::detail {

/// Compares by priority, size and position in the list: a total order.
[[nodiscard]] bool goes_before(const NodeSpec& spec, std::size_t a, std::size_t b);
/// Returns the member's name, or "member 3".
[[nodiscard]] std::string called(const NodeSpec& spec, std::size_t member);
/// Computes the sine of the angle between two members.
[[nodiscard]] double sine_between(const Member& a, const Member& b);

/// The members that join each end: others in index order, with their distances.
using Joined = std::vector<std::vector<Touch>>;
/// Errors  as `solve`, of members and links.
[[nodiscard]] Result<Joined> connected(const NodeSpec& spec);

/// For each end that joins nothing, the member that was probably intended: the nearest within three
/// times the reach. Unless the member's other end already joins that one, because a short branch is
/// always near; or that one ends on the member, which runs past it; or the two lie next to each
/// other.
using Missed = std::vector<std::optional<Touch>>;
[[nodiscard]] Result<Missed> missed(const NodeSpec& spec, const Joined& joined);

inline constexpr double kInLine = 0.00872653549837393;  // sin 0.5 deg: two ends face each other
inline constexpr double kNearParallel = 0.08715574274765817;  // sin 5 deg

/// The plane of a mitre at one of its two ends, along the world's axes: `point` from the end,
/// `normal` into its member.
struct Mitre {
  Eigen::Vector3d point, normal;
  double eccentricity = 0.0;  // sum of the distances of the two axes from the point
};
/// The stated joints, applied.
struct Applied {
  using Pair = std::pair<std::size_t, std::size_t>;
  std::map<Pair, Joint> joints;  // of two members, the earlier first
  std::map<Pair, Mitre> mitres;  // of an end (2 i, 2 i + 1) and the member with which it is mitred
  std::set<Pair> found;          // found joints, which are not stated
};

/// Returns true if a chord that continues where the branch ends cuts it by priority and size.
[[nodiscard]] bool may_cut(const Member& chord, const Member& branch);
/// Returns true if it does, or carries an end that lies inside it, and continues: its nearer end
/// lies `inside` mm beyond the branch's axis. `within`: the joining distance, mm.
[[nodiscard]] bool runs_past(const Member& chord, const Member& branch, End end, double inside,
                             double within);

/// The end that continues another, and the angle out of line; rad.
struct Mate {
  std::size_t end = 0;
  double angle = 0.0;
};
/// Members in line, and the order of alike members.
struct Lines {
  std::vector<std::optional<Mate>> mates;  // of each end; symmetric
  std::vector<std::size_t> line;           // of each member: the earliest of its line
  std::vector<std::size_t> rank;           // among the alike members of its line
  std::set<Applied::Pair> first;           // the first continues where the second ends, and cuts it

  /// Returns true if `a` cuts `b` where they join. Two members never cut each other, because the
  /// order is by priority, which continues where the other ends and is as wide, diameter, and the
  /// position of the earliest of each line.
  [[nodiscard]] bool goes_before(const NodeSpec& spec, std::size_t a, std::size_t b) const;
  /// The same without the rule for continuing members: a total order.
  [[nodiscard]] bool listed_before(const NodeSpec& spec, std::size_t a, std::size_t b) const;
};
/// Pairs each end that joins and is in line with its best continuation; empty when two are equally
/// good, or if a joint of another kind is stated.
[[nodiscard]] Lines lines_of(const NodeSpec& spec, const Joined& joined);
/// Returns true if members between two ends in line continue there and cut both on all sides.
[[nodiscard]] bool separated(const NodeSpec& spec, const Joined& joined, const Lines& lines,
                             std::size_t p, std::size_t q);

/// Returns the distance of a point on a tube's extended surface beyond the tube: 0 if another tube
/// continues it there; `by` is the step down to that one.
struct Short {
  double by = 0.0;  // mm
  std::optional<std::size_t> instead = {};
  bool past_mitre = false;  // beyond a plane at which the tube is mitred
};
[[nodiscard]] Short short_of(const NodeSpec& spec, const Lines& lines, std::size_t end,
                             const Eigen::Vector3d& at);

/// Returns the distance, mm, from which on an end is not taken for one of a stated joint, because
/// the cut would move it by more than anybody draws it short or long.
[[nodiscard]] inline double far_end(const Member& a, const Member& b) {
  return 1.5 * (a.reach() + b.reach());
}

/// Applies the stated joints to the joining members: members that pass through each other are
/// separated; mitred members join only at the two ends that are nearest to each other.
/// Errors  joint_contradicts, no_contact, out_of_range (members/i/joints/j).
[[nodiscard]] Result<Applied> apply_joints(const NodeSpec& spec, const Lines& lines,
                                           Joined& joined);
/// Separates the members of which one is stated to pass through the other.
void part_passing(const NodeSpec& spec, Joined& joined);
/// Mitres the ends in line without a stated joint and without anything between them.
void join_lines(const NodeSpec& spec, const Lines& lines, Joined& joined, Applied& out);

/// Returns the distances from either end along its axis to where two mitred axes meet, mm; midway
/// between both points is their plane.
[[nodiscard]] std::pair<double, double> meeting(const NodeSpec& spec, std::size_t p, std::size_t q);
/// Mitres two ends of two members without a joint, which join nowhere else.
void mitre_ends(const NodeSpec& spec, std::size_t p, std::size_t q, Joined& joined, Applied& out);

/// Returns true if the joint of two members is set on.
[[nodiscard]] bool is_set_on(const Applied& applied, std::size_t member, std::size_t other);

/// Who joins whom, and how.
struct Joints {
  const NodeSpec& spec;
  const Applied& applied;
  const Lines& lines;
  const Joined& joined;
};

/// The surface on which an end lies: as `partner_of`, at the joint's seat.
using Seat = std::variant<TubeCutter, PlaneCutter, RectangularTubeCutter>;
[[nodiscard]] Seat seat_of(const CutBy& cut);
[[nodiscard]] std::vector<PreparedCutter> prepared_seats(const MemberEnd& end);

/// Returns true if every generator of radius rho, or through an outline, meets some.
[[nodiscard]] bool closed(std::span<const PreparedCutter> cutters, double rho);
[[nodiscard]] bool closed(std::span<const Cutter> cutters, const section::Curve& outline);

/// Where a cutter holds an end.
struct Presence {
  bool anywhere = false;   // true if it cuts some generator
  bool passes = false;     // true if it meets none that runs a little inside the surface
  bool flush = false;      // true if, beyond its own ends, it is flush with another that cuts
  bool there = false;      // true if it cuts one within its own ends
  bool consumes = false;   // true if it cuts one beyond the target's other end
  double highest = 0.0;    // of its contacts, from the end, mm
  double nearest = 1e300;  // smallest distance of contacts beyond its own ends to them, mm
};
/// Sets open, consumed and the ghosts of one end, and returns a Presence for each cutter. The scan
/// is skipped if bounds already show that there is nothing to find, and all cutters are present.
std::vector<Presence> inspect(const Joints& joints, MemberEnd& end);

/// Adds the warnings about one end. `missed`: the member that it probably should have met.
void warn(const Joints& joints, const MemberEnd& end, const std::optional<Touch>& missed,
          std::vector<Warning>& out);

}  // namespace tubecut::joint::detail
