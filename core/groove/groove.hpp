#pragma once

// Computes a groove whose filler has the same area in every section of a pipe junction.
//
// Idea: in each section the chord is an arc of an ellipse, so the height of the groove that gives
// the area has a closed form. `survey` checks on 720 sections that the groove exists everywhere.
//
// Example: a branch of 160 x 12 set into a chord of 300 x 14, with 120 mm^2 of filler.
//     groove::GrooveSpec spec;
//     spec.chord = {300, 14};
//     spec.branch = {160, 12};
//     spec.root_face = {4, 2};
//     spec.filler = groove::FillerArea{120};
//     const auto groove = groove::groove(spec).value();
//     const double height = groove.height_min;  // mm: 8.46

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/base/error.hpp"
#include "core/groove/joint_geometry.hpp"
#include "core/groove/section.hpp"
#include "core/groove/surface.hpp"

namespace tubecut::groove {

/// A reported section.
struct GrooveSection {
  Angle omega;  // about the branch axis from the heel half plane
  Angle phi;    // of the bevel table of the same joint (same inclination, clocking 0, offset =
                // eccentricity)
  Eigen::Vector2d p1, p2, p3;  // x from the branch axis, y along it, mm
  double height = 0.0;         // h, mm
  double root_z = 0.0;         // of curve 3, mm
  std::optional<double>
      ellipse_a;  // semi-axis of the chord's section across the branch, mm; empty for a line pair
  Areas areas;
  Ruling ruling;
  CurvePoints curves;
  Angle groove_angle;  // beta, of the groove line to the branch axis
};

/// The same joint with a groove line at one constant angle.
struct Comparison {
  double height = 0.0;              // of that groove, mm
  std::vector<double> filler_area;  // per reported section, axial, mm^2; negative where its edge
                                    // would lie in the chord
  double filler_volume = 0.0;       // mm^3
};

struct Groove {
  std::vector<GrooveSection> sections;
  double area = 0.0;  // requested or found filler area, in the section that `area_in` names, mm^2
  double least_area = 0.0;                    // below it the groove vanishes somewhere, mm^2
  double height_min = 0.0, height_max = 0.0;  // over 720 sections, mm
  double filler_volume = 0.0;                 // mm^3
  double weld_length = 0.0;                   // along curve 3, mm
  std::optional<Comparison> compare;
  std::vector<Warning> warnings;
};

/// Computes the equal-area groove of a joint. Branch frame: z along the branch axis away from the
/// chord, x along the common perpendicular; omega from +y towards -x.
///
/// Errors    of `joint_geometry` and `survey`.
/// Accuracy  sections 1e-12 relative; volume and length as in `survey`.
/// Cost      1 ms and 1 us per section.
/// Source    docs/theory/grooves-and-milling.md, sections 1-5.
[[nodiscard]] Result<Groove> groove(const GrooveSpec& spec);

/// Computes one section anywhere around the joint, in the form of `groove`.
///
/// Errors  of `joint_geometry` and `section`.
[[nodiscard]] Result<GrooveSection> section_at(const GrooveSpec& spec, Angle omega);

/// Verifies an answer by formulas independent of those that computed it.
///
/// Cost    about 3 ms.
[[nodiscard]] std::vector<Check> verify(const GrooveSpec& spec, const Groove& groove);

}  // namespace tubecut::groove
