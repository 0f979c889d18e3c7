#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "core/joint/intersection.hpp"
#include "core/joint/section/section_contour.hpp"
#include "core/section/section.hpp"

namespace tubecut::joint {

/// The cut's curve on one surface of a section, along that surface's own outline.
struct SectionProfile {
  bool outer = false;
  std::vector<section::Station> at;
  std::vector<double> z;
  std::vector<std::size_t> cutter;  // index among the partners
  std::vector<SectionEvent> events;
  double length = 0.0;  // true length of the closed curve
  double girth = 0.0;   // of the outline
};

struct SectionIntersection {
  std::vector<SectionProfile> profiles;
  std::vector<Warning> warnings;
};

/// Computes the curves where the surfaces of a section leave their partners; `spec.target` gives
/// the length alone. With a tolerance the seams of both surfaces are rows.
///
/// Errors  those of `resolve`, `trace` and `sample`; member_consumed (target/length).
/// Source  docs/theory/sections.md, section 2.
[[nodiscard]] Result<SectionIntersection> intersect(const section::Section& section,
                                                    const IntersectionSpec& spec);

/// Verifies the answer in 3D: places by their distance from the outline, distances from partners,
/// heights by other formulas.
[[nodiscard]] std::vector<Check> verify(const section::Section& section,
                                        const IntersectionSpec& spec,
                                        const SectionIntersection& answer);

/// Returns the distance of a place from the outline of a rectangle with round corners, mm; negative
/// inside.
[[nodiscard]] double outline_distance(const section::Section& section, bool outer,
                                      const Eigen::Vector2d& place);

/// Returns warnings for partners that no generator meets or that are nearly parallel.
[[nodiscard]] std::vector<Warning> partner_warnings(const SectionContour& contour);

}  // namespace tubecut::joint
