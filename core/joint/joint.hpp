#pragma once

#include <cstddef>
#include <optional>

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
};

/// By how much a partner's surface is to be grown so that an end of this joint lies on it: the gap
/// and what coats the partner; less the depth of a set-in branch; half of a mitre's gap, which its
/// two faces share. A joint nobody has stated is set on with the gap `unstated`. A set-in joint has
/// its depth.
[[nodiscard]] double seat(const std::optional<Joint>& stated, double coating, double unstated);

}  // namespace tubecut::joint
