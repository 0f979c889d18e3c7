#pragma once

// Computes the bevel table of one cut end: heights of both edges and the torch's angle B by phi.
//
// Idea: the groove rule gives a B at each row, the partners give the smallest B that keeps them out
// of the wall, and the smoothing gives a B that the swing axis can follow. The finished surface and
// the torch line follow from the result, and `verify` checks both by other formulas.
//
// Example: a tube of 60.3 x 4 on a chord of 114.3 at 60 deg, with a kerf of 1.5 mm.
//     bevel::TableSpec spec;
//     spec.target = {60.3 / 2, 4};
//     spec.partners = {joint::TubeCutter{114.3 / 2, Angle::deg(60)}};
//     spec.sampling.uniform_points = 360;
//     spec.kerf = 1.5;
//     spec.smoothing = bevel::NoSmoothing{};
//     const auto table = bevel::table(spec).value();
//     const double b = table.b[90] * kDegPerRad;  // deg, at phi = 90 deg: 15.0

#include <optional>
#include <variant>
#include <vector>

#include "core/base/angle.hpp"
#include "core/base/error.hpp"
#include "core/bevel/beam/beam.hpp"
#include "core/bevel/beam/penetration.hpp"
#include "core/bevel/smoothing/smoothing.hpp"
#include "core/bevel/table/angles.hpp"
#include "core/bevel/table/gap_map.hpp"
#include "core/joint/intersection.hpp"
#include "core/joint/joint.hpp"

namespace tubecut::bevel {

enum class RootSurface { inner, outer };
enum class Contact { inner, outer, automatic, none };

enum class Along { developed, length };

struct EnvelopeSmoothing {
  BevelRateLimits limits;  // of the swing axis along the path
  Along along = Along::developed;
  bool refine = true;
};
struct HermiteSmoothing {
  std::optional<int> transition_points = 15;  // empty: the smallest that keeps the limit (`auto`)
};
struct NoSmoothing {};
using Smoothing = std::variant<EnvelopeSmoothing, HermiteSmoothing, NoSmoothing>;

struct TableSpec {
  joint::Target target;
  std::vector<joint::Partner> partners;
  std::vector<std::optional<joint::Joint>>
      stated;  // how the partners are joined; empty: not stated
  joint::Sampling sampling;
  RootSurface root_surface = RootSurface::inner;
  GrooveRule groove;
  Dihedral dihedral = Dihedral::weld_side;
  Contact contact = Contact::inner;
  double root_face = 0.0;  // height of the land at the root, across the wall; contact inner only
  double root_gap = 0.0;   // distance of the cut to every partner, normal to it
  double coating = 0.0;    // thickness on every partner
  double kerf = 0.0;
  TorchRange torch;
  bool untilted = false;  // the head is square to the wall everywhere: see `table`
  Smoothing smoothing;
  Angle mutation_limit = Angle::deg(10);  // larger steps of the smoother's input are listed
};

/// The table, one entry per node, ascending phi; two nodes at a jump. Angles in rad, lengths in mm.
struct Table {
  std::vector<double> phi, developed, length;
  std::vector<std::size_t> cutter;
  std::vector<double> z_inner, z_outer;  // the finished part
  std::vector<double> z_face, b_face;  // outer edge and elevation of the land; empty without a land
  std::vector<std::size_t> zone;       // of the groove rule's table; empty without such a table
  std::vector<double> dihedral, groove, tau, gamma, flush;
  std::vector<double> b_raw, b_required,
      b;  // rule within the torch range; smallest that keeps partners out; the cut
  std::vector<double> gap;   // root opening: z_inner less the envelope on the inner wall
  GapMap gaps;               // of an untilted cut
  std::vector<double> beam;  // metal along the torch line
  std::vector<double> torch_inner, torch_outer;  // the torch axis, kerf applied
  BeamProof torch_line;  // the metal that the kerf removes and leaves along it
  bool inward = false;   // B counts as published: positive = elevation seen inwards
  std::vector<joint::Event> inner_events, outer_events;
  struct Step {
    double phi, step;
  };
  std::vector<Step> mutations;
  struct Window {
    double phi, step;
    bool kept_before;
    double from, to;                // phi
    double slope_start, slope_end;  // rad/mm
  };
  std::vector<Window> windows;
  struct Binding {
    double from, to;     // phi
    double groove_lost;  // largest reduction of the bevel angle
    double root_gap;     // largest root opening there, mm
  };
  std::vector<Binding> torch_binds;
  double length_total = 0.0, developed_total = 0.0;
  Multipliers multipliers;  // of the smoothing, of every node of its path; empty unless refined
  Penetration penetration;  // of the finished surface, at rows and between them; solid: the partner
  std::vector<Warning> warnings;
  std::vector<double> dz_branch, dz_chord;  // of the rows: RadiusRates of the root's z
};

/// Computes the bevel table of one cut end: contour, angles, contact, smoothing, finished surface
/// and torch line.
///
/// Contact inner: the root's inner edge lies on the partners' envelope at the inner wall, and B is
/// at least the angle that keeps every partner out. Contact automatic: the cut is lifted until it
/// just touches; B is the same except for the torch's range, so that the root opens (`gap`) only
/// where the torch binds; with the square rule B is 0. Contact outer: the outer edge lies on the
/// envelope at the outer wall.
///
/// Between two rows both edges, and that of a land, are straight in (phi, z), with every sampling,
/// because the machine interpolates its rows; at each phi the wall is straight across. Every format
/// and part uses this surface. `penetration` is its deepest point. With a tolerance and any contact
/// but none, it is at most the tolerance (normal to the partner). Otherwise, a depth above the
/// tolerance, or on a bare grid above that of joint::Tolerance, gives the warning `enters_partner`.
///
/// Partners count as grown by coating + root_gap, so the cut keeps that distance to their metal;
/// `gap` is the opening beyond that. If a partner's joint is stated, the partner counts as that
/// joint's seat: root_gap must be 0 or its gap; if the target is set into it, the cut is flush,
/// without groove. Root gaps of zones: zone_gaps.hpp. A root face of height f is a land from the
/// inner edge to the radius r_in + f, square to the axis, or as steep as a partner requires; the
/// bevel begins at its outer edge, and `torch_*` is the bevel's line.
///
/// An `untilted` cut has B = 0 on every row, also where an end is set in; it requires the square
/// rule and any contact except inner. `gaps` contains the gaps that it leaves at both edges, and
/// those of a flush bevel of the same end.
///
/// The torch's axis is lowered only as far as a round beam of the kerf's width needs to stay out of
/// the finished part, at rows and between them (`torch_line`). With a tolerance the table also has
/// the rows that the bends of this line need.
///
/// Frame     z along the target from the cut end into the kept member, phi from x towards y; B > 0:
///           outer edge further into the part.
/// Errors    open_profile, no_contact, parallel_axes, member_consumed, torch_range,
///           sampling_not_uniform, smoothing_not_converged, smoothing_enters, cut_enters (contact
///           outer), out_of_range (groove/zones, root_face, kerf), joint_contradicts (root_gap),
///           transition_too_long, unsupported_combination, too_many_nodes, cancelled.
/// Accuracy  `penetration` is exact within 3e-4 mm, by an enclosure.
/// Source    docs/theory/intersections-and-bevels.md, sections 2, 5 and 6.
[[nodiscard]] Result<Table> table(const TableSpec& spec);

/// Errors  wrong_count, out_of_range (groove/zones/i).
[[nodiscard]] Result<void> check_groove(const GrooveRule& groove);

/// Returns the stated joint of partner i, if any.
[[nodiscard]] const std::optional<joint::Joint>& stated_joint(const TableSpec& spec, std::size_t i);

/// Returns the partners grown by coating and (smallest) root gap, or to their seat.
[[nodiscard]] Result<std::vector<joint::Cutter>> grown_partners(const TableSpec& spec);

/// Returns views of the finished surface's rows: inner edge, the land's, outer edge.
[[nodiscard]] CutWall finished_wall(const TableSpec& spec, const Table& table);

/// Returns true if `table` keeps `penetration` below `penetration_limit`.
[[nodiscard]] bool promises_no_penetration(const TableSpec& spec);
/// Returns the sampling's tolerance; for a bare grid its default. mm
[[nodiscard]] double penetration_limit(const TableSpec& spec);

/// Verifies the table from its own numbers by independent formulas: 3D distances, normals from
/// gradients, half tangents.
[[nodiscard]] std::vector<Check> verify(const TableSpec& spec, const Table& table);

}  // namespace tubecut::bevel
