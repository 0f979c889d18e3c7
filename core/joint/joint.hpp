#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/base/names.hpp"

namespace tubecut::joint {

enum class JointKind {
  set_on,   // the branch stands on the chord; the hole is its bore
  set_in,   // the branch enters the chord's wall; the hole clears its outer surface
  through,  // the branch passes through both walls: two such holes, and no cut end
  mitre     // both end at the plane between them: no chord, no branch and no hole
};

/// The plane that both tubes of a mitre end at.
enum class MitrePlane {
  bisecting,        // leans alike to both axes
  corner_to_corner  // through the corners of the two outlines: unlike tubes meet edge to edge there
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

/// Of an end told by a flag.
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

/// What one member says of how it and another are joined.
struct StatedJoint {
  std::size_t member = 0, with = 0;
  Joint joint;
  std::string at = {};  // what issues call it; empty: members/i/joints/j, of that member's own
};

/// By how much a partner's surface is to be grown so that an end of this joint lies on it: the gap
/// and what coats the partner; less the depth of a set-in branch; half of a mitre's gap, which its
/// two faces share. A joint nobody has stated is set on with the gap `unstated`. A set-in joint has
/// its depth.
[[nodiscard]] double seat(const std::optional<Joint>& stated, double coating, double unstated);

}  // namespace tubecut::joint
