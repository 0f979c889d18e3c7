#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/bevel/hole/hole.hpp"
#include "core/bevel/section/section_table.hpp"
#include "core/bevel/table/table.hpp"
#include "core/joint/intersection.hpp"
#include "core/joint/section/section_intersection.hpp"
#include "core/part/part.hpp"
#include "core/part/section/section_part.hpp"
#include "core/section/section.hpp"

namespace tubecut::api {

/// A closed curve on a cylinder. phi is continuous; on a curve round the tube it runs from 0 to
/// 2 pi and ends at the height it began with, on a hole's the first point is not repeated.
struct CylinderCurve {
  double radius = 0.0;  // mm
  std::vector<double> phi, z;

  [[nodiscard]] bool empty() const { return phi.empty(); }
  /// Length of the polyline on the developed surface.
  [[nodiscard]] double developed_length(bool closing) const;
};

/// A chord and the branch of its hole, by their names if they have some.
struct NamedHole : bevel::HoleSpec {
  std::string chord_name, branch_name;
};

/// One cut as drawings show it: finished edges on both walls, the torch's line on the outer one.
struct CutOutline {
  std::string name;
  CylinderCurve outer, inner, torch;  // any may be empty
  bool around = true;                 // it goes round the tube; else it is a hole
  std::string label = {};             // of a hole: "H1 for B2"
  bool sunk = false;                  // a circle whose edges are those of its countersink
};

/// A segment of an end's outer edge that one partner cuts: its position, and the minimum depth of
/// the waste there.
struct PartnerSpan {
  double phi_from = 0.0, phi_to = 0.0, z = 0.0;
  std::size_t partner = 0;
  bool finish = false;  // of a part
};

/// A bent surface laid flat: x = radius * phi, y = z. Frame of the result it comes from. On a
/// section, phi is the share of its girth in rad, and the radius that of a circle of this girth.
struct Development {
  double outer_radius = 0.0;
  double wall = 0.0;
  std::vector<CutOutline> cuts;
  std::vector<double> junctions;  // phi, rad, on the surface that holds the root
  std::vector<PartnerSpan> spans = {};
  std::vector<part::Mark> marks = {};            // of a part
  bool whole = false;                            // a part, with both its ends
  std::string name = {};                         // of a part, or of a chord that has holes only
  std::optional<section::Section> section = {};  // of a tube that is not round

  /// Whether a cut goes round the tube; else there are holes only.
  [[nodiscard]] bool around() const;
};

[[nodiscard]] Development developed(const bevel::TableSpec& spec, const bevel::Table& table);
[[nodiscard]] Development developed(const joint::IntersectionSpec& spec,
                                    const joint::Intersection& cut);
[[nodiscard]] Development developed(const NamedHole& spec, const bevel::HoleCut& cut);

/// Where the edge of a section's bore is drawn: on the outline of the bore, whose girth is smaller,
/// or outside, where the lines across the wall begin.
enum class BoreOn { bore, outside };
[[nodiscard]] Development developed(const section::Section& section,
                                    const joint::SectionIntersection& cut, BoreOn on);
[[nodiscard]] Development developed(const section::Section& section,
                                    const bevel::SectionTable& table, BoreOn on);
/// Returns "hole for B2", if the branch has a name.
[[nodiscard]] std::string for_branch(const std::string& hole, const std::string& branch);
/// One hole of a chord, by a name.
[[nodiscard]] CutOutline outline(const joint::Target& chord, const bevel::Hole& hole,
                                 std::string name);
/// A part as it is cut: start, finish, then the holes and the cut-outs in their
/// order, in the part's frame.
[[nodiscard]] Development developed(const part::PartSpec& spec, const part::Part& part);

/// A part that is not round.
[[nodiscard]] Development developed(const part::SectionPartSpec& spec,
                                    const part::SectionPart& part, BoreOn on);

/// Returns "60.3 x 4 mm", or "100 x 50 x 4 mm, corner radius 8 mm" of a section: height along x
/// first.
[[nodiscard]] std::string tube_size(const Development& development);

/// Position of a hole's label on the outside, its middle at phi: in the hole, below its upper edge
/// and clear of a mark at its middle; above the hole if it is too small. `room`: mm, for its width.
struct LabelPlace {
  double phi = 0.0, z = 0.0, room = 0.0;
};
[[nodiscard]] LabelPlace label_place(const CutOutline& hole);

/// Bounds of all curves: phi and z.
struct Extent {
  double phi_from = 0.0, phi_to = 0.0, z_from = 0.0, z_to = 0.0;
};
[[nodiscard]] Extent extent(const Development& development);

}  // namespace tubecut::api
