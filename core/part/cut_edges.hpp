#pragma once

#include <algorithm>
#include <limits>
#include <string_view>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/base/error.hpp"
#include "core/bevel/section/section_table.hpp"
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

/// Return true if two rows have one place, as the two of a jump.
[[nodiscard]] inline bool same_place(const bevel::Table& t, std::size_t i, std::size_t j) {
  return t.phi[i] == t.phi[j];
}
[[nodiscard]] inline bool same_place(const bevel::SectionTable& t, std::size_t i, std::size_t j) {
  return t.at[i].s == t.at[j].s;
}

/// Return true if an event of either wall lies at a row.
[[nodiscard]] inline bool at_event(const bevel::Table& t, std::size_t i) {
  const auto here = [&](const joint::Event& event) { return event.phi == t.phi[i]; };
  return std::ranges::any_of(t.inner_events, here) || std::ranges::any_of(t.outer_events, here);
}
[[nodiscard]] inline bool at_event(const bevel::SectionTable& t, std::size_t i) {
  return t.corner[i];
}

/// Calls see(partner, mm) with each stretch of an end's root curve, in the end's own frame. No
/// partner depends on the direction around the tube: a jump lies on the higher partner, which is
/// lost there; a junction's own row may be either's, so the row beyond the stretch's other end
/// counts; a stretch that could be either's counts half for both.
template <class Table, class See>
void each_root_stretch(const bevel::TableSpec& spec, const Table& t, const See& see) {
  const bool outer = spec.root_surface == bevel::RootSurface::outer;
  const auto n = t.length.size();
  const auto height = [&](std::size_t i) { return outer ? t.z_outer[i] : t.z_inner[i] - t.gap[i]; };
  const auto either = [&](std::size_t i) {
    const bool jump =
        same_place(t, i, i + 1 < n ? i + 1 : 0) || same_place(t, i, i > 0 ? i - 1 : n - 1);
    return !jump && at_event(t, i);
  };
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = i + 1 < n ? i + 1 : 0;
    // Lengths count from the datum, where no row need lie.
    const double length = t.length[j] + (j > 0 ? 0.0 : t.length_total) - t.length[i];
    double first = 0.5;
    if (t.cutter[i] == t.cutter[j])
      first = 1.0;
    else if (same_place(t, i, j))
      first = height(i) > height(j) ? 1.0 : height(i) < height(j) ? 0.0 : 0.5;
    else if (either(i) != either(j))
      first = either(j) ? 1.0 : 0.0;
    see(t.cutter[i], first * length);
    if (first < 1.0) see(t.cutter[j], (1.0 - first) * length);
  }
}

/// Returns the length of the root curve without its set-in parts, because those are welded around
/// their hole.
template <class Table>
[[nodiscard]] double welded_length(const bevel::TableSpec& spec, const Table& t) {
  double out = 0.0;
  bool whole = true;
  each_root_stretch(spec, t, [&](std::size_t partner, double length) {
    const auto& stated = bevel::stated_joint(spec, partner);
    if (stated && stated->kind == joint::JointKind::set_in)
      whole = false;
    else
      out += length;
  });
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
