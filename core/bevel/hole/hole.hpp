#pragma once

// Computes the hole in a chord for a branch, and the end of the branch that fits it.
//
// Idea: the hole is a curve over the branch's own phase, because it turns around the branch. Its
// wall is cut along lines that keep the gap to the branch, within the torch's tilt and range.
//
// Example: a branch of 60.3 x 4, set on a chord of 114.3 x 6.
//     bevel::HoleSpec spec;
//     spec.chord = {114.3 / 2, 6};
//     spec.branch = joint::TubeCutter{60.3 / 2};
//     spec.branch_wall = 4;
//     spec.sampling.uniform_points = 360;
//     const auto cut = bevel::hole(spec).value();
//     const double length = cut.holes[0].length_total;  // mm, of the root: 166.7

#include <optional>
#include <variant>
#include <vector>

#include "core/bevel/table/table.hpp"
#include "core/joint/intersection.hpp"
#include "core/joint/joint.hpp"

namespace tubecut::bevel {

using joint::JointKind;

enum class Tilt {
  axial,  // the torch swings only in the chord's axial plane: the machines of this service
  free,   // it also tilts across: the wall has the requested groove on all sides
  none    // it does not tilt: the wall is square to the chord, as wide as the branch requires
};

/// The branch by the four numbers of its axis, or by its axis line; the direction points out of the
/// chord into the branch. In the chord's frame; the radius is the branch's outer one.
using BranchPlacement = std::variant<joint::TubeCutter, joint::AxisTube>;

struct HoleSpec {
  joint::Target chord;
  BranchPlacement branch;
  double branch_wall = 0.0;
  JointKind kind = JointKind::set_on;  // mitre is invalid here
  double gap = 0.0;                    // between the surfaces that face each other, normal to them
  std::optional<double> depth = {};    // set-in: the branch's end below the chord's outer surface;
                                       // empty: flush with the bore
  GrooveRule groove;  // set-on: on the branch's end; else on the hole's edge, from the branch
  Tilt tilt = Tilt::axial;
  TorchRange torch;  // free: at most `max` from the surface's normal
  double kerf = 0.0;
  joint::Sampling sampling;
};

/// The gap between the two cut surfaces, one entry per node.
struct FitUp {
  std::vector<double> root, face,
      least;  // at the root, at the other edge, smallest across the wall
  // Straight between the nodes, because the machine interpolates them; least_between by an
  // enclosure, within 3e-4:
  double least_between = 0.0, greatest_root_between = 0.0;
  // The position of that minimum: on the branch's end in its frame (set-on), else on the hole's
  // wall in the chord's. Its depth is measured from the requested gap.
  Penetration nearest;
};

/// One hole, parametrised by the branch's own phase. Its curves are closed in (phi, z) and turn
/// around the branch, not around the chord: phi is continuous, within 90 deg of the branch's side,
/// and may leave [0, 360) deg. The torch line runs inside the curve.
struct Hole {
  bool far = false;
  std::vector<double> branch_phi, length;  // along the root curve
  std::vector<double> phi, z, developed;   // finished edge on the chord's outer surface
  std::vector<double> phi_inner, z_inner;  // on its bore
  std::vector<double> dihedral, groove;    // between the surfaces; of the wall as cut
  std::vector<double> b, a;                // towards +z; towards growing phi (tilt free)
  std::vector<double> beam;                // metal along the torch line
  std::vector<double> torch_phi, torch_z;  // torch axis on the outer surface
  std::vector<double> torch_phi_inner, torch_z_inner;
  double length_total = 0.0;  // of the root curve
  BeamProof torch_line;       // the metal that the kerf removes and leaves along it
  FitUp fit;
};

/// The branch's own end, in its frame: z along the branch out of the chord, phi from the common
/// perpendicular; the same phases as the hole's nodes. It equals bevel::table with the root on the
/// inner wall and contact inner: set-on with the groove, set-in flush with the cylinder `depth`
/// below the chord's outer surface.
struct BranchEnd {
  joint::TubeCutter chord;  // the partner that cuts it
  std::vector<double> phi, z_inner, z_outer, b;
};

struct HoleCut {
  std::vector<Hole> holes;          // near side first
  std::optional<BranchEnd> branch;  // absent for `through`
  std::vector<Warning> warnings;
};

/// Computes the hole in a chord for a branch, the matching end of the branch, and the fit of the
/// two.
///
/// The torch's axis runs half a kerf off the wall. It runs further off if a round beam of the
/// kerf's width would enter the chord, at nodes or between them (`torch_line`).
///
/// Frame     z along the chord, phi from x towards y. B > 0: the outer edge lies further towards
///           +z.
/// Errors    open_profile (branch; phi intervals of the branch: it extends beyond the chord's
///           side), edge_crosses (branch; phi intervals of the branch: the wall's lines cross),
///           no_contact, parallel_axes, zero_length, out_of_range, torch_range, too_many_nodes,
///           cancelled.
/// Accuracy  the root's gap within 1e-9 mm of the requested one at the nodes, and nowhere less
///           across the wall. Between nodes, both edges are straight in (phi, z), and the gap falls
///           below it by at most the sampling's tolerance (nodes are added until `entering` finds
///           no such gap). On a bare grid this holds only at the nodes: if the gap falls short by
///           more than joint::Tolerance's, the result has the warning `enters_partner`.
/// Source    docs/theory/intersections-and-bevels.md, section 8.
[[nodiscard]] Result<HoleCut> hole(const HoleSpec& spec);

/// Verifies the answer in 3D: distances of its own points to the axes, by cross products.
[[nodiscard]] std::vector<Check> verify(const HoleSpec& spec, const HoleCut& cut);

/// Computes the branch's four numbers.
///
/// Errors  as joint::place, at branch/axis.
[[nodiscard]] Result<joint::TubeCutter> branch_tube(const BranchPlacement& branch);

}  // namespace tubecut::bevel
