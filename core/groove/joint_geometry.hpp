#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"
#include "core/groove/periodic_spline.hpp"

namespace tubecut::groove {

/// A pipe of the joint. Lengths in mm.
struct Pipe {
  double outer_diameter = 0.0;
  double wall = 0.0;  // 0 < wall < radius
};

/// The rectangle that remains at the branch's end below the groove. Lengths in mm.
struct RootFace {
  double height = 0.0;  // a >= 0, along the branch axis
  double width = 0.0;   // b, 0 < b < branch wall
};

/// The section in which the filler area is constant.
enum class AreaIn : std::uint8_t {
  axial,   // the half plane through the branch axis
  normal,  // the plane normal to the seam
};

struct FillerArea {
  double area = 0.0;  // mm^2
};
/// The area that gives this groove height in the section at `at`.
struct FillerHeight {
  double height = 0.0;  // mm
  Angle at;
};
using Filler = std::variant<FillerArea, FillerHeight>;

/// A groove line at one constant angle, measured from the square cut.
struct FixedBevel {
  Angle bevel = Angle::deg(45);  // 0 <= bevel < 90 deg
};

/// A set-in branch and its equal-area groove. The chord axis lies in the half plane omega = 0, 180
/// deg.
struct GrooveSpec {
  Pipe chord;
  Pipe branch;
  RootFace root_face;
  Angle inclination =
      Angle::deg(90);         // alpha, between the axes, (0, 90] deg; omega = 0 is the heel
  double eccentricity = 0.0;  // of the chord axis along +x of the branch frame, mm
  Filler filler = FillerArea{};
  AreaIn area_in = AreaIn::axial;
  int sections = 24;  // reported sections, uniform from omega = 0
  std::optional<FixedBevel> compare;
};

/// A checked joint: the input of every formula of the groove. Lengths in mm.
struct JointGeometry {
  double chord_radius = 0.0;   // R
  double bore_radius = 0.0;    // R - delta1
  double branch_radius = 0.0;  // r
  double inner_radius = 0.0;   // r_in = r - delta2
  double root_radius = 0.0;    // rho3 = r_in + b
  double groove_width = 0.0;   // H = delta2 - b, radial
  double weld_width = 0.0;     // c = 2 H, along the chord
  double root_height = 0.0;    // a
  double eccentricity = 0.0;
  double sin_a = 1.0;  // of the inclination
  double cos_a = 0.0;
  double area = 0.0;  // filler area, mm^2, in the section that `area_in` names
  /// Ratio of the axial sections' area to `area`, at equal steps from omega = 0; empty: 1.
  std::optional<PeriodicSpline> area_factor = {};
};

inline constexpr int kMaxSections = 20000;

/// Computes the joint of a spec. It checks only single fields and the filler's reference section;
/// `survey` checks whether the groove exists all around.
///
/// Errors  not_finite, out_of_range, wall, root_width, angle, no_pierce, area; no_p2 and
///         p2_ambiguous at the reference section of a filler height; `area` also if normal sections
///         cannot be made equal.
/// Source  docs/theory/grooves-and-milling.md, sections 1 and 9.
[[nodiscard]] Result<JointGeometry> joint_geometry(const GrooveSpec& spec);

/// Returns an angle as degrees with enough digits for a message.
[[nodiscard]] std::string degrees_text(Angle angle);

}  // namespace tubecut::groove
