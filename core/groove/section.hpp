#pragma once

#include <optional>
#include <tl/expected.hpp>

#include "core/base/angle.hpp"
#include "core/base/error_codes.hpp"
#include "core/groove/joint_geometry.hpp"

namespace tubecut::groove {

/// Sine and cosine of omega.
struct Direction {
  double sin = 0.0;
  double cos = 1.0;
};

/// Returns the direction of a section. If an angle is within its own rounding (4e-16 rad per
/// revolution) of a quarter turn, it is that quarter turn, so that the two longitudinal sections
/// are exact.
[[nodiscard]] Direction direction(Angle omega);

/// The weld's two ends on the chord, P1 and P2, in section coordinates: x from the branch axis, y
/// along it. Lengths in mm.
struct Toe {
  double x1 = 0.0, y1 = 0.0;
  double x2 = 0.0, y2 = 0.0;
  double D = 0.0, dy = 0.0;           // P2 - P1, without cancellation
  double t1 = 0.0, q1 = 0.0;          // P1 on the chord's circle t^2 + q^2 = R^2
  double t2 = 0.0, q2 = 0.0;          // P2 likewise
  double slope1 = 0.0, slope2 = 0.0;  // dy/dx of the chord at P1 and P2
  double theta = 0.0;                 // angle of the arc P1 P2 on that circle
  double half_sin = 0.0;              // sin(theta / 2)
  double bow = 0.0;                   // S_C, between chord line P1 P2 and arc, mm^2
};

/// Signed areas of a section, mm^2: A + B + C + D = E.
struct Areas {
  double a = 0.0, b = 0.0, c = 0.0, d = 0.0, e = 0.0;
};

/// One section of the groove. P3 = (branch radius, y3).
struct Section {
  Angle omega = {};
  Direction dir = {};
  Toe toe = {};
  double height = 0.0;  // h, from P1 up to P3
  double y3 = 0.0;
  double z3_d = 0.0;      // d y1 / d omega, mm/rad
  double height_d = 0.0;  // d h / d omega, mm/rad
  double D_d = 0.0;       // d D / d omega, mm/rad
};

/// Computes P1, P2 and the bow of the section in direction `dir`; `near` is a guess of D, mm.
///
/// Errors    no_p2, p2_ambiguous.
/// Accuracy  |P1 P2| = c and both points on the chord within 1e-13 (R + r) / sin(alpha); worst seen
///           5e-16.
/// Cost      about 4 Newton steps, 2 from a neighbour's guess, never more than 120 (50 Newton, then
///           bisection).
/// Source    docs/theory/grooves-and-milling.md, 4.1 and 4.2.
[[nodiscard]] tl::expected<Toe, ErrorCode> toe(const JointGeometry& joint, Direction dir,
                                               std::optional<double> near = {});

/// Computes the whole section: closed-form height and derivatives. `survey` checks the signs that
/// make it a groove.
///
/// Errors    as `toe`.
/// Accuracy  1e-12 relative; worst seen 1.6e-15 against the golden file's 34 digits.
/// Source    docs/theory/grooves-and-milling.md, 4.3 and 4.6.
[[nodiscard]] tl::expected<Section, ErrorCode> section(const JointGeometry& joint, Angle omega,
                                                       std::optional<double> near = {});

/// Computes the chord's outer surface in the section in direction `dir`, over x from the branch
/// axis; empty beyond its silhouette. mm
[[nodiscard]] std::optional<double> chord_height(const JointGeometry& joint, Direction dir,
                                                 double x);

/// Computes the filler area of the axial section of a groove of this height there.
[[nodiscard]] double filler_area(const JointGeometry& joint, const Toe& toe, double height);

[[nodiscard]] Areas areas(const JointGeometry& joint, const Section& section);

/// Returns the factor from the joint's area to that of the axial section: 1 unless its areas are
/// equal in normal sections.
[[nodiscard]] double axial_factor(const JointGeometry& joint, Direction dir);

/// Returns 1 / cos psi: the axial section's area over the normal one's, to first order in the
/// seam's curvature.
[[nodiscard]] double first_order_factor(const JointGeometry& joint, Direction dir, const Toe& toe);

}  // namespace tubecut::groove
