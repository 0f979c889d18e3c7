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

/// For `solve` only.
namespace tubecut::joint::detail {

/// By priority, diameter and place alone: a total order, so two members never cut each other.
[[nodiscard]] bool goes_before(const NodeSpec& spec, std::size_t a, std::size_t b);
/// The member's name, or "member 3".
[[nodiscard]] std::string called(const NodeSpec& spec, std::size_t member);
/// Sine of the angle between two members.
[[nodiscard]] double sine_between(const Member& a, const Member& b);

/// What joins each end: others in index order, with how near they are.
using Joined = std::vector<std::vector<Touch>>;
/// Errors  as `solve`, of members and links.
[[nodiscard]] Result<Joined> connected(const NodeSpec& spec, const std::stop_token& stop);

/// What each end that joins nothing may have been meant to join: the nearest member within three
/// times the reach, unless the member's other end joins that one already: a short branch is near.
using Missed = std::vector<std::optional<Touch>>;
[[nodiscard]] Result<Missed> missed(const NodeSpec& spec, const Joined& joined,
                                    const std::stop_token& stop);

/// The plane of a mitre as one of its two ends has it, along the world's axes: `point` from where
/// the end is, `normal` into its member.
struct Mitre {
  Eigen::Vector3d point, normal;
  double eccentricity = 0.0;  // distances of the two axes from the point, together
};
/// What is stated, once applied.
struct Applied {
  using Pair = std::pair<std::size_t, std::size_t>;
  std::map<Pair, Joint> joints;  // of two members, the earlier first
  std::map<Pair, Mitre> mitres;  // of an end (2 i, 2 i + 1) and the member it is mitred with
  std::set<Pair> found;          // of those joints: nobody has stated them
};

/// The end that continues another, and how far out of line; rad.
struct Mate {
  std::size_t end = 0;
  double angle = 0.0;
};
/// Members in line, and who of those that are alike goes before whom.
struct Lines {
  std::vector<std::optional<Mate>> mates;  // of each end; each is its mate's mate
  std::vector<std::size_t> line;           // of each member: the earliest of its line
  std::vector<std::size_t> rank;           // of those of its line that are alike
  std::set<Applied::Pair> first;           // of alike ones: the first goes on where the second ends

  /// Does `a` cut `b` where they join? Two members never cut each other: by priority, diameter, who
  /// goes on where the other ends, and the place of the earliest of each line.
  [[nodiscard]] bool goes_before(const NodeSpec& spec, std::size_t a, std::size_t b) const;
  /// As that, but for who goes on: a total order.
  [[nodiscard]] bool listed_before(const NodeSpec& spec, std::size_t a, std::size_t b) const;
};
/// Of ends that join and lie in line each with the one that continues it best; none where two do so
/// alike, or where a joint of another kind is stated.
[[nodiscard]] Lines lines_of(const NodeSpec& spec, const Joined& joined);
/// Does something stand between two ends in line: do members that go on there cut both all round?
[[nodiscard]] bool separated(const NodeSpec& spec, const Joined& joined, const Lines& lines,
                             std::size_t p, std::size_t q);

/// How far a place on a tube's surface, prolonged, lies beyond it: 0 where another continues it
/// there, `by` how much that one lies lower.
struct Short {
  double by = 0.0;  // mm
  std::optional<std::size_t> instead;
};
[[nodiscard]] Short short_of(const NodeSpec& spec, const Lines& lines, std::size_t end,
                             const Eigen::Vector3d& at);

/// Applies what is stated to what joins: members that pass through each other are parted, those
/// mitred join at the two ends that are nearest to each other, and there alone.
/// Errors  joint_contradicts, no_contact, out_of_range (members/i/joints/j).
[[nodiscard]] Result<Applied> apply_joints(const NodeSpec& spec, const Lines& lines,
                                           Joined& joined);
/// Mitres those ends in line of which nobody states how they are joined, and which nothing stands
/// between.
void join_lines(const NodeSpec& spec, const Lines& lines, Joined& joined, Applied& out);

/// The surface an end lies on: as `partner_of`, at the joint's seat.
using Seat = std::variant<TubeCutter, PlaneCutter>;
[[nodiscard]] Seat seat_of(const CutBy& cut);
/// Those that cut an end, prepared.
[[nodiscard]] std::vector<PreparedCutter> prepared_seats(const MemberEnd& end);

/// Every generator of radius rho meets some cutter.
[[nodiscard]] bool closed(std::span<const PreparedCutter> cutters, double rho);

/// Where a cutter holds an end.
struct Presence {
  bool anywhere = false;   // is there a generator that it cuts?
  bool there = false;      // and one where it is not beyond its own ends?
  bool consumes = false;   // or beyond the other end of what it cuts?
  double highest = 0.0;    // of its contacts, from the end, mm
  double nearest = 1e300;  // to its own ends, of what lies beyond them, mm
};
/// Sets open, consumed and the ghosts of one end; the scan is left out where bounds already say
/// that there is nothing to find, and the cutters are all there. Of each cutter.
std::vector<Presence> inspect(const NodeSpec& spec, const Lines& lines, const Applied& applied,
                              MemberEnd& end);

}  // namespace tubecut::joint::detail
