#include "core/part/section/section_part.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/part/cut_edges.hpp"
#include "core/part/opening_order.hpp"
#include "core/part/place.hpp"
#include "core/part/section/section_tabs.hpp"
#include "core/part/text_clearance.hpp"

namespace tubecut::part {
namespace {

using bevel::SectionTable;

constexpr double kHoleTolerance = 0.01;  // mm: a bolt hole stays round, however coarse the ends are

Edge outer_edge(const SectionTable& t) { return edge_over_girth(t, t.z_outer); }
Edge inner_edge(const SectionTable& t) { return edge_over_girth(t, t.z_inner); }

/// Cuts the end in its own frame.
Result<SectionEnd> cut_end(const SectionPartSpec& spec, bool finish) {
  const auto& asked = finish ? spec.finish : spec.start;
  SectionEnd out{.spec = asked.cut};
  out.spec.target.length = spec.length;
  TRY(out.own, under(joint::end_name(finish), bevel::section_table(spec.section, out.spec)));
  const section::Wall wall(spec.section);
  if (asked.welded) {
    out.weld_length = welded_length(out.spec, out.own);
    out.groove_volume = groove_volume(wall, out.spec, out.own);
  }
  const auto& tabs = finish ? spec.finish_tabs : spec.start_tabs;
  if (!tabs.empty())
    TRY(under(joint::end_name(finish), add_tabs({wall, out.spec, tabs, finish}, out)));
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  return out;
}

/// Returns the end's plane, if one plane alone cuts it.
const joint::PlaneCutter* only_plane(const bevel::TableSpec& spec) {
  return spec.partners.size() == 1 ? std::get_if<joint::PlaneCutter>(&spec.partners.front())
                                   : nullptr;
}

/// Returns that plane if the outer edge lies in it: else a saw along it would cut another length.
const joint::PlaneCutter* sawn_plane(const SectionEnd& end) {
  constexpr double kSawn = 0.05;  // mm
  const auto* plane = only_plane(end.spec);
  if (plane == nullptr) return nullptr;
  const Eigen::Vector3d normal = plane->normal.normalized();
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < end.own.at.size(); ++i) {
    const auto& p = end.own.at[i].point;
    const double off = normal.dot(Eigen::Vector3d(p.x(), p.y(), end.own.z_outer[i]) - plane->point);
    low = std::min(low, off);
    high = std::max(high, off);
  }
  return high - low <= kSawn ? plane : nullptr;
}

/// Measures the end on the middle of each face and corner, and across each face.
void measure_faces(const section::Curve& outer, bool finish, SectionEnd& end) {
  const auto edge = outer_edge(end.table);
  const double girth = outer.girth();
  // At a jump the part ends where it is shorter.
  const auto z = [&](double s) {
    const auto span = edge.at(s / girth * kTwoPi);
    return finish ? span.low : span.high;
  };
  const auto* plane = sawn_plane(end);
  for (int face = 1; face <= 4; ++face) {
    auto& cut = end.faces[static_cast<std::size_t>(face - 1)];
    const double half = outer.half_flat(face);
    cut.z = z(outer.on_face(face, 0.0));
    end.corners[static_cast<std::size_t>(face - 1)] = z(outer.on_corner(face, 0.25 * kPi));
    if (half <= 0.0) continue;
    const double middle = outer.on_face(face, 0.0);
    cut.angle = elementary::atan2(z(middle + half) - z(middle - half), 2.0 * half);
    if (plane == nullptr) continue;
    Eigen::Vector2d n = section::Curve::face_normal(face);
    const Eigen::Vector3d up = plane->normal.normalized() * (plane->normal.z() < 0.0 ? -1.0 : 1.0);
    if (finish) n.y() = -n.y();  // of the end's own frame
    cut.tilt = elementary::asin(std::clamp(up.head<2>().dot(n), -1.0, 1.0));
  }
}

GirthPoint girth_point(const SectionTable& t, bool upwards) {
  const auto i = outer_edge(t).extreme(upwards);
  return {t.at[i].s, t.z_outer[i]};
}

std::vector<SectionMark> marks(const SectionPartSpec& spec, const SectionPart& p) {
  const double from = p.start.faces[0].z, to = p.finish.faces[0].z;
  std::vector<SectionMark> out{{Mark::Kind::datum_line, "0", 0.0, from, to}};
  if (!spec.name.empty()) {
    const double middle = 0.5 * (from + to);
    out.push_back({Mark::Kind::part_mark, spec.name, 0.0, middle, middle});
  }
  const double dz = -lowest(p.start.own);
  for (auto mark : spec.partners) {
    mark.z_from += dz;
    mark.z_to += dz;
    out.push_back(std::move(mark));
  }
  return out;
}

std::vector<Step> sequence_of(const SectionPart& p) {
  std::vector<Step> out;
  for (std::size_t i = 0; i < p.marks.size(); ++i)
    out.push_back({Step::What::mark, i, p.marks[i].z_from, p.marks[i].z_to});
  for (const auto& step : cutout_order(p.cutouts)) out.push_back(step);
  const auto end = [&](Step::What what, const SectionTable& t) {
    out.push_back({what, 0, lowest(t), highest(t)});
  };
  end(Step::What::finish, p.finish.table);
  end(Step::What::start, p.start.table);
  return out;
}

Lengths lengths(const SectionPartSpec& spec, const SectionPart& p) {
  const section::Wall wall(spec.section);
  auto out = lengths_along(p, spec, spec.length);
  out.volume = end_volume(wall, p.finish.spec, p.finish.table) -
               end_volume(wall, p.start.spec, p.start.table);
  for (const auto& one : p.cutouts.instances) out.volume -= p.cutouts.mould_of(one).taken.volume;
  out.mass = out.volume * 1e-9 * spec.density;
  return out;
}

SectionShape shape_of(const SectionPartSpec& spec, const SectionPart& p) {
  SectionShape out{.section = spec.section};
  fill_edges(p, edge_over_girth, out);
  return out;
}

/// Places both ends in the part's frame.
void assemble(const SectionPartSpec& spec, SectionPart& out) {
  const section::Wall wall(spec.section);
  const double dz = -lowest(out.start.own);
  out.frame = spec.start_frame;
  out.frame.origin -= dz * spec.start_frame.rows.row(2).transpose();
  out.start.table = shifted(out.start.own, dz);
  out.finish.table = shifted(seen_from_start(wall, out.finish.own, spec.length), dz);
  for (auto* end : {&out.start, &out.finish}) {
    const bool finish = end == &out.finish;
    end->longest = girth_point(end->table, finish);
    end->shortest = girth_point(end->table, !finish);
    measure_faces(wall.outer(), finish, *end);
  }
  for (std::size_t i = 0; i < out.faces.size(); ++i)
    out.faces[i] = {out.finish.faces[i].z - out.start.faces[i].z,
                    out.finish.corners[i] - out.start.corners[i]};
  out.marks = marks(spec, out);
}

}  // namespace

cutout::Ground cutout_ground(const SectionPartSpec& spec, const SectionPart& part) {
  const double work = -lowest(part.start.own);
  return {.tube = {.outer_radius = spec.section.outer().girth() / kTwoPi,
                   .wall = spec.section.wall,
                   .length = spec.length},
          .section = section::Wall(spec.section),
          .start_work = work,
          .finish_long = highest(part.finish.table),
          .finish_work = work + spec.length,
          .kerf = spec.cutouts.kerf,
          .tolerance = std::min(spec.cutouts.tolerance, kHoleTolerance),
          .most_lean = spec.cutouts.most_lean,
          .most_swing = spec.cutouts.most_swing};
}

Result<SectionPart> section_part(const SectionPartSpec& spec) {
  SectionPart out;
  for (const bool finish : {false, true}) {
    TRY(auto end, cut_end(spec, finish));
    // A plane square to the axis has no relevant warnings.
    if ((finish ? spec.finish : spec.start).welded)
      carry(end.own.warnings, joint::end_name(finish), out.warnings);
    (finish ? out.finish : out.start) = std::move(end);
  }
  assemble(spec, out);
  const auto &s = out.start.table, &f = out.finish.table;
  TRY(check_left({{inner_edge(s), inner_edge(f)}, {outer_edge(s), outer_edge(f)}}, spec.length));
  TRY(add_cutouts_and_texts(spec, out));
  out.sequence = sequence_of(out);
  out.clocking = clocking_between(spec.start.cut.partners, spec.finish.cut.partners);
  out.lengths = lengths(spec, out);
  out.check_dimensions = check_dimensions(shape_of(spec, out));
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  return out;
}

}  // namespace tubecut::part
