#pragma once

#include <optional>
#include <stop_token>
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
  std::optional<int> transition_points = 15;  // empty: the least that keeps the limit (`auto`)
};
struct NoSmoothing {};
using Smoothing = std::variant<EnvelopeSmoothing, HermiteSmoothing, NoSmoothing>;

struct TableSpec {
  joint::Target target;
  std::vector<joint::Partner> partners;
  std::vector<std::optional<joint::Joint>>
      stated;  // how the partners are joined; empty: nobody says
  joint::Sampling sampling;
  RootSurface root_surface = RootSurface::inner;
  GrooveRule groove;
  Dihedral dihedral = Dihedral::weld_side;
  Contact contact = Contact::inner;
  double root_face = 0.0;  // height of the land at the root, across the wall; contact inner only
  double root_gap = 0.0;   // the cut stands off every partner by this much, normal to it
  double coating = 0.0;    // thickness on every partner
  double kerf = 0.0;
  TorchRange torch;
  bool untilted = false;  // the head stands square to the wall everywhere: see `table`
  Smoothing smoothing;
  Angle mutation_limit = Angle::deg(10);  // larger steps of the smoother's input are listed
};

/// The table, one entry per node, ascending phi; two nodes at a jump. Angles in rad, lengths in mm.
struct Table {
  std::vector<double> phi, developed, length;
  std::vector<std::size_t> cutter;
  std::vector<double> z_inner, z_outer;  // the finished part
  std::vector<double> z_face, b_face;    // outer edge and elevation of the land; empty without one
  std::vector<std::size_t> zone;         // of the groove rule's table; empty without one
  std::vector<double> dihedral, groove, tau, gamma, flush;
  std::vector<double> b_raw, b_required,
      b;                     // rule within the torch range; least that keeps partners out; the cut
  std::vector<double> gap;   // root opening: z_inner less the envelope on the inner wall
  GapMap gaps;               // of an untilted cut
  std::vector<double> beam;  // metal along the torch line
  std::vector<double> torch_inner, torch_outer;  // the torch axis, kerf applied
  BeamProof torch_line;                          // what the kerf takes and leaves along it
  bool inward = false;  // B counts as published: positive = elevation seen inwards
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
    double groove_lost;  // largest angle by which the bevel was cut back
    double root_gap;     // largest root opening there, mm
  };
  std::vector<Binding> torch_binds;
  double length_total = 0.0, developed_total = 0.0;
  Multipliers multipliers;  // of the smoothing, of every node of its path; empty unless refined
  Penetration penetration;  // of the finished surface, at rows and between them; solid: the partner
  std::vector<Warning> warnings;
  std::vector<double> dz_branch, dz_chord;  // of the rows: RadiusRates of the root's z
};

/// The bevel table of one cut end: contour, angles, contact, smoothing, finished surface and torch
/// line.
///
/// Contact inner: the root's inner edge lies on the partners' envelope at the inner wall, and B is
/// at least what keeps every partner out. Contact automatic: the cut is lifted until it just
/// touches; B is the same but for the torch's range, so that the root opens (`gap`) only where the
/// torch binds; with the square rule B is 0. Contact outer: the outer edge lies on the envelope at
/// the outer wall.
///
/// Between two rows both edges, and that of a land, run straight in (phi, z), with every sampling:
/// what a machine does that interpolates its rows, and what every format and part goes on with. At
/// each phi the wall is straight across. `penetration` is the deepest place of that whole surface,
/// round the seam too. With a tolerance and any contact but none it is never deeper than the
/// tolerance (normal to the partner); elsewhere a depth above the tolerance, or above that of
/// joint::Tolerance on a bare grid, is the warning `enters_partner`.
///
/// Partners count as grown by coating + root_gap, so the cut stays that far off their metal; gap is
/// what opens beyond that. One whose joint is stated counts as that joint's seat: its own gap, from
/// which root_gap must not differ; where the target is set into it, the cut lies flush at the
/// depth, without groove. Root gaps of zones: zone_gaps.hpp. A root face of height f is a land from
/// the inner edge to the radius r_in + f, square to the axis, or as steep as a partner makes it;
/// the bevel begins at its outer edge, and `torch_*` is the bevel's line.
///
/// An `untilted` cut has B = 0 on every row, where an end is set in too; it goes with the square
/// rule and any contact but inner. What that leaves open at both edges, and what a flush bevel of
/// the same end would leave, stands in `gaps`.
///
/// The torch's axis is lowered no further than a round beam of the kerf's width needs to stay out
/// of the finished part, rows and what lies between them (`torch_line`). With a tolerance it also
/// has the rows that its own bends need.
///
/// Frame     z along the target from the cut end into the kept member, phi from x towards y; B > 0:
///           outer edge further into the part.
/// Errors    open_profile, no_contact, parallel_axes, member_consumed, torch_range,
///           sampling_not_uniform, smoothing_not_converged, smoothing_enters, cut_enters (contact
///           outer), out_of_range (groove/zones, root_face, kerf), joint_contradicts (root_gap),
///           transition_too_long, unsupported_combination, too_many_nodes, cancelled.
/// Accuracy  `penetration` is stated within 3e-4 mm, by an enclosure.
/// Source    docs/theory/intersections-and-bevels.md, sections 2, 5 and 6.
[[nodiscard]] Result<Table> table(const TableSpec& spec, const std::stop_token& stop = {});

/// Errors  wrong_count, out_of_range (groove/zones/i).
[[nodiscard]] Result<void> check_groove(const GrooveRule& groove);

/// How partner i is joined, where somebody says.
[[nodiscard]] const std::optional<joint::Joint>& stated_joint(const TableSpec& spec, std::size_t i);

/// The partners as the cut must see them: grown by coating and (least) root gap, or to their seat.
[[nodiscard]] Result<std::vector<joint::Cutter>> grown_partners(const TableSpec& spec);

/// The finished surface by its rows: inner edge, the land's, outer edge. Views of the table.
[[nodiscard]] CutWall finished_wall(const TableSpec& spec, const Table& table);

/// May the finished surface enter no partner by more than `penetration_limit`, between rows either?
[[nodiscard]] bool promises_no_penetration(const TableSpec& spec);
/// The sampling's tolerance; on a bare grid the one it has by default. mm
[[nodiscard]] double penetration_limit(const TableSpec& spec);

/// The table proved from its own numbers by other formulas: 3D distances, normals from gradients,
/// half tangents.
[[nodiscard]] std::vector<Check> verify(const TableSpec& spec, const Table& table,
                                        const std::stop_token& stop = {});

}  // namespace tubecut::bevel
