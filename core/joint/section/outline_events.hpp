#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/joint/section/section_place.hpp"

/// For the contour of a section only: where one flat or arc of it may have events.
namespace tubecut::joint::detail {

struct OutlineEvents {
  std::vector<double> places;  // s, not reduced to one turn, in any order; some are no events
  struct Kink {
    double s;
    std::size_t cutter;
  };
  std::vector<Kink> kinks;
  struct Hidden {
    std::size_t cutter;
    double s;
  };
  std::vector<Hidden> hidden;  // where an elbow's bend hides a lower part of it
};

/// `wide`: a radius about the axis that the section lies within; `scan`: mm between places where
/// what has no closed form is looked at.
struct OutlineEventSpec {
  std::span<const PreparedCutter> cutters;
  const section::Curve& curve;
  double wide, scan;
};
[[nodiscard]] OutlineEvents outline_events(const OutlineEventSpec& spec,
                                           const section::OutlineSegment& segment);

/// Returns true if these cutters have one surface, to rounding; false if one is an elbow.
[[nodiscard]] bool same_surface(const PreparedCutter& a, const PreparedCutter& b, double wide);

/// Returns which faces lie on the cutter's silhouette, to rounding. Its height is a straight line
/// there.
[[nodiscard]] std::array<bool, 4> grazed_faces(const PreparedCutter& cutter,
                                               const section::Curve& curve);

}  // namespace tubecut::joint::detail
