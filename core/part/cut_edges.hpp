#pragma once

#include <algorithm>
#include <limits>
#include <string_view>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/base/error.hpp"
#include "core/bevel/table/table.hpp"
#include "core/joint/joint.hpp"
#include "core/part/edge.hpp"
#include "core/part/part.hpp"

/// The two edges of a cut end as parts of a part, of a round tube's table or of a section's.
namespace tubecut::part {

/// Return the smallest and the largest z of an end's cut, over both walls.
template <class Table>
[[nodiscard]] double lowest(const Table& t) {
  return std::min(std::ranges::min(t.z_inner), std::ranges::min(t.z_outer));
}
template <class Table>
[[nodiscard]] double highest(const Table& t) {
  return std::max(std::ranges::max(t.z_inner), std::ranges::max(t.z_outer));
}

/// Return the lowest and the highest z of the kerf: half a kerf across the beam beyond its axis.
template <class Table>
[[nodiscard]] double lowest_kerf(const Table& t, double kerf) {
  double out = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < t.torch_outer.size(); ++i) {
    const double beyond = 0.5 * kerf / elementary::cos(t.b[i]);
    out = std::min(out, std::min(t.torch_outer[i], t.torch_inner[i]) - beyond);
  }
  return out;
}
template <class Table>
[[nodiscard]] double highest_kerf(const Table& t, double kerf) {
  double out = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < t.torch_outer.size(); ++i) {
    const double beyond = 0.5 * kerf / elementary::cos(t.b[i]);
    out = std::max(out, std::max(t.torch_outer[i], t.torch_inner[i]) + beyond);
  }
  return out;
}

/// Returns the length of the root curve without its set-in parts, because those are welded around
/// their hole.
template <class Table>
[[nodiscard]] double welded_length(const bevel::TableSpec& spec, const Table& t) {
  const auto set_in = [&](std::size_t row) {
    const auto& stated = bevel::stated_joint(spec, t.cutter[row]);
    return stated && stated->kind == joint::JointKind::set_in;
  };
  double out = 0.0;
  bool whole = true;
  for (std::size_t i = 0; i < t.length.size(); ++i)
    if (set_in(i))
      whole = false;
    else
      out += (i + 1 < t.length.size() ? t.length[i + 1] : t.length_total) - t.length[i];
  return whole ? t.length_total : out;
}

/// Returns the lengths of a part along z, and of its welds.
template <class Part, class Spec>
[[nodiscard]] Lengths lengths_along(const Part& p, const Spec& spec, double work_point) {
  const auto &s = p.start.table, &f = p.finish.table;
  return {.work_point = work_point,
          .longest = highest(f) - lowest(s),
          .shortest = lowest(f) - highest(s),
          .blank = highest_kerf(f, p.finish.spec.kerf) - lowest_kerf(s, p.start.spec.kerf) +
                   spec.clamping + spec.facing,
          .weld = p.start.weld_length + p.finish.weld_length};
}

/// The part as its check dimensions see it: fills in edges and roots of both ends. `edge(table, z)`
/// makes an edge of a column.
template <class Shape, class Part, class MakeEdge>
void fill_edges(const Part& p, const MakeEdge& edge, Shape& out) {
  out.start_outer = edge(p.start.table, p.start.table.z_outer);
  out.start_inner = edge(p.start.table, p.start.table.z_inner);
  out.finish_outer = edge(p.finish.table, p.finish.table.z_outer);
  out.finish_inner = edge(p.finish.table, p.finish.table.z_inner);
  out.start_root_outer = p.start.spec.root_surface == bevel::RootSurface::outer;
  out.finish_root_outer = p.finish.spec.root_surface == bevel::RootSurface::outer;
}

/// One wall of a part: where the start's cut ends it, and the finish's.
struct WallEnds {
  Edge start, finish;
};

/// Checks that the two cuts of a wall do not meet. Both are straight between their nodes.
/// Errors  member_consumed (target/length).
[[nodiscard]] Result<void> check_left(const std::vector<WallEnds>& walls, double length);

/// Adds warnings under a path.
void carry(std::vector<Warning> warnings, std::string_view parent, std::vector<Warning>& out);

}  // namespace tubecut::part
