#include "core/part/part.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/math/rotation.hpp"
#include "core/part/cut_edges.hpp"
#include "core/part/hole_volume.hpp"
#include "core/part/opening_order.hpp"
#include "core/part/place.hpp"
#include "core/part/text_clearance.hpp"
#include "core/part/volume.hpp"

namespace tubecut::part {
namespace {

using bevel::Table;

/// Cuts the end in its own frame, rotated so that its phi = 0 is the part's.
Result<End> cut_end(const PartSpec& spec, bool finish) {
  const auto& asked = finish ? spec.finish : spec.start;
  End out{.spec = asked.cut};
  const Angle by = finish ? spec.zero : -spec.zero;
  for (auto& partner : out.spec.partners) partner = turned(partner, by);
  TRY(out.own, under(joint::end_name(finish), bevel::table(out.spec)));
  if (!asked.welded) return out;
  out.weld_length = welded_length(out.spec, out.own);
  out.groove_volume = groove_volume(out.spec, out.own);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  return out;
}

Result<void> cut_holes(const PartSpec& spec, Part& out) {
  for (std::size_t i = 0; i < spec.holes.size(); ++i) {
    auto asked = spec.holes[i].hole;
    asked.branch = turned(asked.branch, -spec.zero);
    const auto at = "holes/" + std::to_string(spec.holes[i].asked);
    TRY(auto cut, under(at, bevel::hole(asked)));
    carry(cut.warnings, at, out.warnings);
    out.hole_specs.push_back(std::move(asked));
    out.hole_cuts.push_back(std::move(cut));
  }
  return {};
}

Edge outer_edge(const Table& t) { return {t.phi, t.z_outer}; }
Edge inner_edge(const Table& t) { return {t.phi, t.z_inner}; }

/// The outside and the bore between the two cuts.
std::vector<WallEnds> walls_of(const Part& p) {
  return {{inner_edge(p.start.table), inner_edge(p.finish.table)},
          {outer_edge(p.start.table), outer_edge(p.finish.table)}};
}

Lengths lengths(const PartSpec& spec, const Part& p) {
  auto out = lengths_along(p, spec, *spec.target.length);
  out.volume = end_volume(p.finish.spec, p.finish.table) - end_volume(p.start.spec, p.start.table) -
               holes_volume(spec.target, p);
  for (const auto& one : p.cutouts.instances) out.volume -= p.cutouts.mould_of(one).taken.volume;
  out.mass = out.volume * 1e-9 * spec.density;
  return out;
}

/// Returns the marks on the finished part: the datum line, the part's mark, the positions of
/// branches.
std::vector<Mark> marks(const PartSpec& spec, const Part& p, double dz) {
  const double from = outer_edge(p.start.table).at(0.0).high;
  const double to = outer_edge(p.finish.table).at(0.0).low;
  std::vector<Mark> out{{Mark::Kind::datum_line, "0", 0.0, from, to}};
  if (!spec.name.empty()) {
    const double middle = 0.5 * (from + to);
    out.push_back({Mark::Kind::part_mark, spec.name, 0.0, middle, middle});
  }
  for (auto mark : spec.partners) {
    mark.phi = math::whole_turn(mark.phi - spec.zero.rad());
    mark.z_from += dz;
    mark.z_to += dz;
    out.push_back(std::move(mark));
  }
  return out;
}

std::string asked_hole(const PartSpec& spec, std::size_t hole) {
  return "holes/" + std::to_string(spec.holes[hole].asked);
}

/// Warns of holes that run into each other, because no wall is left between them for either weld.
/// Each requested hole gets one warning that names the earlier ones; the two sides of a through
/// hole may meet too.
void warn_of_meeting(const PartSpec& spec, const Part& p, std::vector<Warning>& out) {
  std::map<std::size_t, std::set<std::size_t>> met;
  for (std::size_t j = 0; j < p.holes.size(); ++j)
    for (std::size_t i = 0; i < j && !stopped(); ++i)
      if (holes_meet(spec.target, p.holes[i].hole, p.holes[j].hole))
        met[p.holes[j].asked].insert(p.holes[i].asked);
  for (const auto& [hole, others] : met) {
    std::string names;
    for (const auto other : others)
      names += (names.empty() ? "" : ", ") +
               (other == hole ? "its own other side" : asked_hole(spec, other));
    out.push_back({.code = WarningCode::holes_meet,
                   .member = asked_hole(spec, hole),
                   .detail = "it cuts into " + names});
  }
}

/// Where a hole's edge leaves the wall between the two cuts.
struct Beyond {
  bool anywhere = false;  // at some node
  bool start = true;      // at every node, at the start
  bool finish = true;     // at every node, at the finish
};

Beyond beyond(const Part& p, const bevel::Hole& hole) {
  Beyond out;
  for (const bool outer : {false, true}) {
    const auto a = outer ? outer_edge(p.start.table) : inner_edge(p.start.table);
    const auto b = outer ? outer_edge(p.finish.table) : inner_edge(p.finish.table);
    const auto& phi = outer ? hole.phi : hole.phi_inner;
    const auto& z = outer ? hole.z : hole.z_inner;
    for (std::size_t i = 0; i < phi.size() && !stops(i); ++i) {
      const bool below = z[i] <= a.at(phi[i]).high, above = z[i] >= b.at(phi[i]).low;
      out.anywhere = out.anywhere || below || above;
      out.start = out.start && below;
      out.finish = out.finish && above;
    }
  }
  return out;
}

/// Checks the holes against the cuts. A hole entirely in the scrap is an error of the request; one
/// that extends into a cut may be intended, and so may one side of a brace that passes through.
Result<void> see_holes(const PartSpec& spec, const Part& p, std::vector<Warning>& out) {
  std::vector<Beyond> at;
  std::set<std::size_t> on_part;
  for (const auto& placed : p.holes) {
    at.push_back(beyond(p, placed.hole));
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    if (!at.back().start && !at.back().finish) on_part.insert(placed.asked);
  }
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto member = asked_hole(spec, p.holes[i].asked);
    const bool off = at[i].start || at[i].finish;
    const std::string where = "beyond the cut at the " + std::string(joint::end_name(!at[i].start));
    if (off && !on_part.contains(p.holes[i].asked))
      return fail({.code = ErrorCode::hole_off_part, .member = member, .hint = "it lies " + where});
    if (at[i].anywhere)
      out.push_back({.code = WarningCode::hole_meets_end,
                     .member = member,
                     .detail = off ? "one of its two sides lies wholly " + where
                                   : "its edge reaches into the cut at an end"});
  }
  return {};
}

/// A prism near the bore's side has far more metal along its lines than the wall is thick.
void warn_of_grazing(const PartSpec& spec, Part& out) {
  constexpr double kThick = 3.0;  // walls
  const double outer = spec.target.outer_radius, inner = spec.target.inner_radius();
  std::set<std::size_t> warned;
  for (const auto& one : out.cutouts.instances) {
    const auto& mould = out.cutouts.mould_of(one);
    if (mould.laying.lay() != cutout::Lay::prism || !warned.insert(one.asked).second) continue;
    const auto box = bounds(mould.chain);
    const double b = std::max(box.most.y(), -box.least.y());
    const double metal = std::sqrt(outer * outer - b * b) - std::sqrt(inner * inner - b * b);
    if (metal > kThick * spec.target.wall)
      out.warnings.push_back({.code = WarningCode::grazes,
                              .member = cutout::path_of(one.asked) + "/shape",
                              .detail = brief(metal) + " mm of metal along the line"});
  }
}

EdgePoint edge_point(const Table& t, bool upwards) {
  const auto edge = outer_edge(t);
  const auto i = edge.extreme(upwards);
  return {edge.phi[i], edge.z[i]};
}

Shape shape_of(const PartSpec& spec, const Part& p) {
  Shape out{.outer_radius = spec.target.outer_radius, .wall = spec.target.wall};
  fill_edges(
      p,
      [](const Table& t, const std::vector<double>& z) {
        return Edge{t.phi, z};
      },
      out);
  return out;
}

joint::MemberFrame part_frame(const PartSpec& spec, double dz) {
  joint::MemberFrame out;
  out.rows = math::turn_about_z(-spec.zero.rad()) * spec.start_frame.rows;
  out.origin = spec.start_frame.origin - dz * spec.start_frame.rows.row(2).transpose();
  return out;
}

/// Computes all results that follow from the two ends and the holes.
void assemble(const PartSpec& spec, Part& out) {
  const double length = *spec.target.length;
  const double dz = -lowest(out.start.own);
  out.frame = part_frame(spec, dz);
  out.start.table = shifted(out.start.own, dz);
  if (stopped()) return;
  out.finish.table = shifted(seen_from_start(out.finish.own, length), dz);
  if (stopped()) return;
  out.start.longest = edge_point(out.start.table, false);
  out.start.shortest = edge_point(out.start.table, true);
  out.finish.longest = edge_point(out.finish.table, true);
  out.finish.shortest = edge_point(out.finish.table, false);
  for (std::size_t i = 0; i < out.hole_cuts.size(); ++i)
    for (const auto& hole : out.hole_cuts[i].holes) {
      if (stopped()) return;
      out.holes.push_back({shifted(hole, dz), i});
    }
  out.marks = marks(spec, out, dz);
}

}  // namespace

cutout::Ground cutout_ground(const PartSpec& spec, const Part& part) {
  const double work = -lowest(part.start.own);
  return {.tube = spec.target,
          .start_work = work,
          .finish_long = highest(part.finish.table),
          .finish_work = work + *spec.target.length,
          .kerf = spec.cutouts.kerf,
          .tolerance = spec.cutouts.tolerance,
          .most_lean = spec.cutouts.most_lean,
          .most_swing = spec.cutouts.most_swing};
}

Result<Part> part(const PartSpec& spec) {
  if (!spec.target.length)
    return fail({.code = ErrorCode::missing_field, .member = "target/length"});
  Part out;
  for (const bool finish : {false, true}) {
    TRY(auto end, cut_end(spec, finish));
    // A plane square to the axis has no relevant warnings.
    if ((finish ? spec.finish : spec.start).welded)
      carry(end.own.warnings, joint::end_name(finish), out.warnings);
    (finish ? out.finish : out.start) = std::move(end);
  }
  TRY(cut_holes(spec, out));
  assemble(spec, out);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  TRY(check_left(walls_of(out), *spec.target.length));
  TRY(see_holes(spec, out, out.warnings));
  warn_of_meeting(spec, out, out.warnings);
  TRY(add_cutouts_and_texts(spec, out));
  warn_of_grazing(spec, out);
  out.clocking = clocking_between(spec.start.cut.partners, spec.finish.cut.partners);
  out.lengths = lengths(spec, out);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  out.check_dimensions = check_dimensions(shape_of(spec, out));
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  out.sequence = sequence(out);
  return out;
}

}  // namespace tubecut::part
