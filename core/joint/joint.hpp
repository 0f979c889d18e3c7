#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/base/names.hpp"

namespace tubecut::joint {

enum class JointKind {
  set_on,   // the branch is set on the chord; the hole is its bore
  set_in,   // the branch enters the chord's wall; the hole clears its outer surface
  through,  // the branch passes through both walls: two such holes, and no cut end
  mitre     // both end at the plane between them: no chord, no branch and no hole
};

/// The plane at which both tubes of a mitre end.
enum class MitrePlane {
  bisecting,        // at equal angles to both axes
  corner_to_corner  // through the corners of the two outlines: unequal tubes meet edge to edge
                    // there
};

enum class End { start, finish };  // of a member

}  // namespace tubecut::joint

namespace tubecut {

template <>
inline constexpr auto kNames<joint::JointKind> =
    std::to_array<Option<joint::JointKind>>({{"set_on", joint::JointKind::set_on},
                                             {"set_in", joint::JointKind::set_in},
                                             {"through", joint::JointKind::through},
                                             {"mitre", joint::JointKind::mitre}});
template <>
inline constexpr auto kNames<joint::End> = std::to_array<Option<joint::End>>(
    {{"start", joint::End::start}, {"finish", joint::End::finish}});

}  // namespace tubecut

namespace tubecut::joint {

/// Returns the name of an end given by a flag.
[[nodiscard]] constexpr std::string_view end_name(bool finish) {
  return name_of(finish ? End::finish : End::start);
}

/// How two members that meet are joined. Lengths in mm.
struct Joint {
  JointKind kind = JointKind::set_on;
  double gap = 0.0;  // between the surfaces that face each other, normal to them; mitre: the faces
  std::optional<double> depth = {};  // set-in: the branch's end below the chord's outer surface;
                                     // empty: flush with the bore
  MitrePlane plane = MitrePlane::bisecting;
  friend bool operator==(const Joint&, const Joint&) = default;
};

/// A member's statement of its joint with another.
struct StatedJoint {
  std::size_t member = 0, with = 0;
  Joint joint;
  std::string at = {};  // its path in issues; empty: members/i/joints/j, of that member's own
};

/// Returns the distance by which a partner's surface is grown so that an end of this joint lies on
/// it: the gap and the partner's coating; less the depth of a set-in branch; half of a mitre's gap,
/// because its two faces share it. If no joint is stated, it is set on with the gap `unstated`. A
/// set-in joint must have its depth.
[[nodiscard]] double seat(const std::optional<Joint>& stated, double coating, double unstated);

}  // namespace tubecut::joint
