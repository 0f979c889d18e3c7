#pragma once

#include <map>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "core/joint/nearness.hpp"
#include "core/joint/node.hpp"

/// For `solve` only.
namespace tubecut::joint::detail {

/// Does `a` cut `b` where they join? A total order, so two members never cut each other.
[[nodiscard]] bool goes_before(const NodeSpec& spec, std::size_t a, std::size_t b);
/// The member's name, or "member 3".
[[nodiscard]] std::string called(const NodeSpec& spec, std::size_t member);
/// Sine of the angle between two members.
[[nodiscard]] double sine_between(const Member& a, const Member& b);

/// What joins each end: others in index order, with how near they are.
using Joined = std::vector<std::vector<Touch>>;

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
};

/// Applies what is stated to what joins: members that pass through each other are parted, those
/// mitred join at the two ends that are nearest to each other, and there alone.
/// Errors  joint_contradicts, no_contact, out_of_range (members/i/joints/j).
[[nodiscard]] Result<Applied> apply_joints(const NodeSpec& spec, Joined& joined);

/// The surface an end lies on: as `partner_of`, at the joint's seat.
using Seat = std::variant<TubeCutter, PlaneCutter>;
[[nodiscard]] Seat seat_of(const CutBy& cut);
/// Those that cut an end, prepared.
[[nodiscard]] std::vector<PreparedCutter> prepared_seats(const MemberEnd& end);

/// Sets open, consumed and the ghosts of one end; the scan is left out where bounds already say
/// that there is nothing to find.
void inspect(const NodeSpec& spec, MemberEnd& end);

}  // namespace tubecut::joint::detail
