#pragma once

// Computes the curve along which a tube must be cut to fit its partners.
//
// Idea: on each line of the target parallel to its axis, the cut is at the contact with a partner
// that is furthest along +z. Each contact has a closed form, and exact events (the curve passes to
// another partner, leaves a partner, or crosses a corner of a partner) divide it into smooth
// segments.
//
// Example: a tube of 60.3 x 4 on a chord of 114.3 at 60 deg.
//     joint::IntersectionSpec spec;
//     spec.target = {60.3 / 2, 4};
//     spec.partners = {joint::TubeCutter{114.3 / 2, Angle::deg(60)}};
//     spec.sampling.uniform_points = 360;
//     const auto cut = joint::intersect(spec).value();
//     const double length = cut.profiles[1].length;  // mm, on the outer surface: 208.4

#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/joint/contour.hpp"
#include "core/joint/cutters/cutter.hpp"
#include "core/joint/sampling.hpp"
#include "core/joint/target.hpp"

namespace tubecut::joint {

/// Converts every partner to a cutter.
///
/// Errors  zero_length, parallel_axes (cutters/i/axis).
[[nodiscard]] Result<std::vector<Cutter>> resolve(std::span<const Partner> partners);

enum class Surfaces { inner, outer, both };

struct IntersectionSpec {
  Target target;
  std::vector<Partner> partners;
  Surfaces surfaces = Surfaces::both;
  Sampling sampling;
};

/// The curve of the cut on one surface of the target. Angles in rad, lengths in mm.
struct Profile {
  bool outer = false;
  double radius = 0.0;
  std::vector<double> phi, z;
  std::vector<std::size_t> cutter;  // index among the partners
  std::vector<Event> events;
  double length = 0.0;     // true length of the closed curve
  double developed = 0.0;  // 2 pi radius
};

struct Intersection {
  std::vector<Profile> profiles;
  std::vector<Warning> warnings;
};

/// Computes the curves along which the target's inner and outer surface meet the partners.
///
/// Errors  those of `resolve`, `trace` and `sample`; member_consumed (target/length).
/// Source  docs/theory/intersections-and-bevels.md, sections 1 and 3.
[[nodiscard]] Result<Intersection> intersect(const IntersectionSpec& spec);

/// Verifies the answer in 3D: distances by cross product, heights by solving the quadratic of line
/// and cylinder.
[[nodiscard]] std::vector<Check> verify(const IntersectionSpec& spec, const Intersection& answer);

/// Returns warnings for partners that no generator meets, or whose axes are nearly parallel to the
/// target's.
[[nodiscard]] std::vector<Warning> partner_warnings(const Contour& contour);

/// Returns the error member_consumed if the curve extends beyond the target's far end.
[[nodiscard]] Result<void> check_length(const Target& target, std::span<const double> z);

}  // namespace tubecut::joint
