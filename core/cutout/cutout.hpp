#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/bevel/hole/hole.hpp"
#include "core/cutout/cone.hpp"
#include "core/cutout/laying.hpp"
#include "core/cutout/pattern.hpp"
#include "core/cutout/shape.hpp"

namespace tubecut::cutout {

enum class Wall {
  normal,     // straight along the anchor's normal, through the near wall
  through,    // the same, through both
  developed,  // laid on the outside
};

struct Anchor {  // where a cut-out's local plane touches the part
  enum class From { start, finish };
  enum class Zero { work_point, long_point };
  double z = 0.0;  // mm, into the part
  From from = From::start;
  Zero zero = Zero::work_point;
  double phi = 0.0;  // rad, in the part's frame; on a section the share of its girth, or
  bool opposite = false;
  // On a section, instead of phi: 1 to 4, and mm from the middle of this face as s grows.
  int face = 0;
  double offset = 0.0;
};

/// A cone about a circle's axis, at its anchor.
struct Countersink {
  double diameter = 0.0;  // mm, in the plane that touches the outside
  double angle = 0.0;     // rad, from side to side
};

struct Spec {
  std::string id;
  Shape shape;
  double turn = 0.0;    // rad, about the anchor, from +z towards growing phi
  bool as_cut = false;  // hollow corners tighter than the kerf stay as the beam leaves them
  Anchor at;
  Wall wall = Wall::normal;
  bevel::Tilt tilt = bevel::Tilt::axial;
  Pattern pattern;
  std::optional<Countersink> countersink = {};  // of a circle
  bool on_one_flat = false;                     // of a section: its shape follows from this face
};

/// The tube that is cut, and the heights that anchors count from.
struct Ground {
  joint::Target tube;
  std::optional<section::Wall> section = {};  // of a tube that is not round
  double start_long = 0.0, start_work = 0.0;
  double finish_long = 0.0, finish_work = 0.0;
  double kerf = 0.0;
  double tolerance = 0.01;        // see Cutting
  double most_lean = 0.5 * kPi;   // rad, of the torch across
  double most_swing = 0.5 * kPi;  // rad, of the torch to either side along the tube
};

/// Returns z of an anchor in the part's frame.
[[nodiscard]] double height_of(const Anchor& at, const Ground& ground);

inline constexpr std::size_t kMostCutouts = 2'000;
inline constexpr std::size_t kMostRows = 200'000;

/// One shape on one side of the wall, about its anchor: cut-outs that are alike share it.
struct Mould {
  Laying laying;
  Chain chain;
  bool as_cut = false;
  bevel::Hole rows;  // phases and heights from the anchor
  Taken taken;
  Flat centre = Flat::Zero();     // deep in the scrap
  std::optional<Cone> cone = {};  // of a countersink; the chain is its circle that touches
  /// Of a slit: the torch's line and where it pierces; its chain is what the beam takes.
  struct Line {
    SlitLine line;
    Slit::Pierce pierce = Slit::Pierce::middle;
    [[nodiscard]] bool operator==(const Line&) const = default;
  };
  std::optional<Line> slit = {};
};

/// One cut-out of one wall, in the part's frame.
struct Instance {
  std::size_t asked = 0;  // index of the spec
  std::string name;       // "id", in a pattern "id.3" or "id.3.1"
  std::size_t mould = 0;
  // Of the anchor, on the near side. The bore of a section has phases of its own.
  double phi = 0.0, phi_inner = 0.0, z = 0.0;
  int face = 0;         // of a section
  double offset = 0.0;  // mm, of the anchor from the middle of this face
  bool sunk = false;    // a circle whose edges are those of its cone, the next instance
};

struct Layout {
  std::vector<Mould> moulds;
  std::vector<Instance> instances;

  [[nodiscard]] const Mould& mould_of(const Instance& one) const { return moulds[one.mould]; }
  [[nodiscard]] bool empty() const { return instances.empty(); }
};

/// Lays every cut-out on its wall. On a section, a countersink, a slit and what is `on_one_flat`
/// lie within one flat of it.
///
/// Errors  at cutouts/k: out_of_range, contour_open, contour_crosses, open_profile (shape),
///         pattern_wraps, out_of_range (pattern), torch_range (tilt); those of check_cone. Of a
///         section: out_of_range
///         (shape, at/offset, at/girth or pattern: beyond the flat), unsupported_combination
///         (pattern/faces: without the anchor's own face). All of them at once.
/// Source  docs/theory/cutouts.md.
[[nodiscard]] Result<Layout> lay(const std::vector<Spec>& specs, const Ground& ground);

/// What a countersink is for the fitter: spent_beam, countersink_open; one of each a spec.
[[nodiscard]] std::vector<Warning> cone_warnings(const Layout& layout, double kerf);

/// "bolt.3", "bolt.3 far", "bolt.3 countersink".
[[nodiscard]] std::string title_of(const Layout& layout, const Instance& one);

/// An instance's rows in the part's frame.
[[nodiscard]] bevel::Hole placed(const Layout& layout, const Instance& one);

/// Every mould proved by its own points in space: the edges against the chain, the torch's line
/// against the wall, the volume ring by ring.
[[nodiscard]] std::vector<Check> verify(const Layout& layout, const Ground& ground);

/// What a mould, or all cut-outs, take of the wall, mm^3: ring by ring, each by Gauss along the
/// segments.
[[nodiscard]] double volume_by_rings(const Mould& mould);
[[nodiscard]] double volume_by_rings(const Layout& layout);

/// "cutouts/3": where errors about a spec point.
[[nodiscard]] std::string path_of(std::size_t asked);

/// How the chain of a spec lies: its tilt decides whether a straight wall is a prism.
[[nodiscard]] Lay lay_of(Wall wall, bevel::Tilt tilt);

/// The shape turned in its local plane.
///
/// Errors  those of drawn.
[[nodiscard]] Result<Chain> chain_of(const Spec& spec);

/// The diameter, a slot's width or a rectangle's shorter side, mm; nothing of a contour.
[[nodiscard]] std::optional<double> least_size(const Shape& shape);

}  // namespace tubecut::cutout
