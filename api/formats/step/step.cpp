#include "api/formats/step/step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/formats/bevel_table_formats.hpp"
#include "api/formats/drawing/part_edges.hpp"
#include "api/formats/mesh/cut_solid.hpp"
#include "api/formats/mesh/tube_solid.hpp"
#include "api/formats/step/step_solid.hpp"
#include "api/formats/text.hpp"
#include "api/stop.hpp"
#include "core/base/elementary.hpp"
#include "core/cutout/rows.hpp"
#include "core/part/edge.hpp"
#include "core/part/hole_volume.hpp"

namespace tubecut::api {
namespace {

constexpr double kFlat = 1e-9;  // mm: a cut square to the axis

WallCurve curve_of(const bevel::CutWall& wall, std::vector<bool> corners, const Caption& caption,
                   const WallCurve::EdgePlanes& planes = {}) {
  if (caption.view == "straight") return WallCurve::straight(wall, planes);
  corners.resize(wall.gaps(), false);
  return WallCurve::smooth(wall, corners, planes);
}

TubeCut end_cut(TubeCut::Kind kind, const bevel::TableSpec& spec, const bevel::Table& table,
                const Caption& caption) {
  const std::string name(joint::end_name(kind == TubeCut::Kind::finish));
  ask();
  const auto wall = bevel::finished_wall(spec, table);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& edge : wall.edges) {
    const auto [least, most] = std::ranges::minmax(edge.z);
    low = std::min(low, least);
    high = std::max(high, most);
  }
  if (high - low <= kFlat) return {kind, name, low};
  return {kind, name, curve_of(wall, corners(spec, table), caption)};
}

TubeCut hole_cut(const joint::Target& tube, const bevel::Hole& hole, std::string name,
                 const Caption& caption) {
  ask();
  const bevel::CutWall wall{.edges = {{tube.inner_radius(), hole.phi_inner, hole.z_inner},
                                      {tube.outer_radius, hole.phi, hole.z}},
                            .turn = 0.0};
  return {TubeCut::Kind::hole, std::move(name), curve_of(wall, {}, caption)};
}

constexpr double kCloseRows = 1e-3;  // mm

/// The rows of a mould that the part was cut by, so nothing but a stop of the job refuses them.
bevel::Hole close_rows(const cutout::Mould& mould) {
  auto rows = cutout::rows(mould, {.tolerance = kCloseRows});
  if (!rows) ask();
  return std::move(rows).value();
}

/// A cone's mould by close rows: lines across its wall are those of the cone and of its circle.
WallCurve cone_curve(const joint::Target& tube, const cutout::Mould& mould, double turn, double z,
                     const Caption& caption) {
  ask();
  const auto& cone = *mould.cone;
  auto rows = close_rows(mould);
  const double met = tube.outer_radius - cone.depth();
  std::vector<double> land_phi, land_z;
  for (std::size_t i = 0; i < rows.phi.size(); ++i) {
    const auto w =
        elementary::sincos(kTwoPi * static_cast<double>(i) / static_cast<double>(rows.phi.size()));
    land_phi.push_back(turn + elementary::atan2(0.5 * cone.hole * w.sin, met));
    land_z.push_back(z + 0.5 * cone.hole * w.cos);
    for (auto* phi : {&rows.phi, &rows.phi_inner}) (*phi)[i] += turn;
    for (auto* at : {&rows.z, &rows.z_inner}) (*at)[i] += z;
  }
  bevel::CutWall wall{.edges = {{tube.inner_radius(), rows.phi_inner, rows.z_inner},
                                {tube.outer_radius, rows.phi, rows.z}},
                      .turn = 0.0};
  if (cutout::cone_wall(mould.laying, cone) == cutout::ConeWall::whole)
    return curve_of(wall, {}, caption);
  wall.edges.insert(wall.edges.begin() + 1, {met, land_phi, land_z});
  return curve_of(wall, {}, caption, {{}, WallCurve::EdgePlane{turn, met}, {}});
}

/// A cut-out's mould by close rows, with a corner at every end of its segments.
WallCurve cutout_curve(const joint::Target& tube, const cutout::Mould& mould, double turn, double z,
                       const Caption& caption) {
  ask();
  constexpr double kAtCorner = 1e-9;  // mm
  auto rows = close_rows(mould);
  std::vector<bool> corners;
  for (std::size_t i = 0; i < rows.phi.size(); ++i)
    corners.push_back(
        mould.chain.size() > 1 && std::ranges::any_of(mould.chain, [&](const cutout::Segment& s) {
          const double phi = mould.laying.phase(mould.laying.turn(s.from.y(), tube.outer_radius));
          return std::abs(s.from.x() - rows.z[i]) < kAtCorner &&
                 std::abs(phi - rows.phi[i]) * tube.outer_radius < kAtCorner;
        }));
  for (auto* column : {&rows.phi, &rows.phi_inner})
    for (double& phi : *column) phi += turn;
  for (auto* column : {&rows.z, &rows.z_inner})
    for (double& at : *column) at += z;
  return curve_of({.edges = {{tube.inner_radius(), rows.phi_inner, rows.z_inner},
                             {tube.outer_radius, rows.phi, rows.z}},
                   .turn = 0.0},
                  std::move(corners), caption);
}

std::string print(const joint::Target& tube, const std::vector<TubeCut>& cuts,
                  const Caption& caption) {
  return print_step(tube_solid(tube.inner_radius(), tube.outer_radius, cuts),
                    product_of(tube, {}, caption), caption);
}

/// Position of a hole relative to the cuts of both ends.
enum class Lies { on_part, off_part, across_a_cut };

Lies lies(const part::Part& part, const bevel::Hole& hole) {
  bool below = true, above = true, clear = true;
  for (const bool outer : {false, true}) {
    const auto edge = [&](const bevel::Table& t) {
      return part::Edge{t.phi, outer ? t.z_outer : t.z_inner};
    };
    const auto start = edge(part.start.table), finish = edge(part.finish.table);
    const auto& phi = outer ? hole.phi : hole.phi_inner;
    const auto& z = outer ? hole.z : hole.z_inner;
    for (std::size_t i = 0; i < phi.size(); ++i) {
      const bool low = z[i] <= start.at(phi[i]).high, high = z[i] >= finish.at(phi[i]).low;
      below = below && low;
      above = above && high;
      clear = clear && !low && !high;
    }
  }
  if (below || above) return Lies::off_part;
  return clear ? Lies::on_part : Lies::across_a_cut;
}

[[noreturn]] void refuse(const std::string& why) {
  throw UnfitOption{"format", why + ": step prints no such solid"};
}

}  // namespace

Product product_of(const std::string& size, const std::string& member, const Caption& caption) {
  Product out{.id = member, .name = "tube " + size + " mm", .revision = {}};
  for (const auto& [key, text] : caption.reference) {
    if (key == "part") out.id = text;
    if (key == "revision") out.revision = text;
  }
  if (out.id.empty()) out.id = caption.input_sha256.substr(0, 16);
  return out;
}

Product product_of(const joint::Target& tube, const std::string& member, const Caption& caption) {
  return product_of(fixed(2.0 * tube.outer_radius, 3) + " x " + fixed(tube.wall, 3), member,
                    caption);
}

std::string bevel_table_step(const bevel::TableSpec& spec, const bevel::Table& table,
                             const Caption& caption) {
  return print(spec.target,
               {end_cut(TubeCut::Kind::start, spec, table, caption),
                {TubeCut::Kind::finish, "far end", far_end(spec, table)}},
               caption);
}

std::string hole_step(const bevel::HoleSpec& spec, const bevel::HoleCut& cut,
                      const Caption& caption) {
  const auto& tube = spec.chord;
  std::vector<TubeCut> cuts;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < cut.holes.size(); ++i) {
    const auto& hole = cut.holes[i];
    if (i > 0 && part::holes_meet(tube, cut.holes[0], hole)) refuse("the holes of both sides meet");
    for (const auto* z : {&hole.z, &hole.z_inner}) {
      const auto [least, most] = std::ranges::minmax(*z);
      low = std::min(low, least);
      high = std::max(high, most);
    }
    cuts.push_back(hole_cut(tube, hole, hole.far ? "hole, far side" : "hole", caption));
  }
  cuts.push_back({TubeCut::Kind::start, "end", low - tube.outer_radius});
  cuts.push_back({TubeCut::Kind::finish, "end", high + tube.outer_radius});
  return print(tube, cuts, caption);
}

TubeSolid part_solid(const part::PartSpec& spec, const part::Part& part, const Caption& caption) {
  const auto& tube = spec.target;
  std::vector<TubeCut> cuts{
      end_cut(TubeCut::Kind::start, part.start.spec, part.start.table, caption),
      end_cut(TubeCut::Kind::finish, part.finish.spec, part.finish.table, caption)};
  std::vector<const bevel::Hole*> kept;
  const bool some_meet = std::ranges::any_of(
      part.warnings, [](const Warning& w) { return w.code == WarningCode::holes_meet; });
  for (std::size_t i = 0; i < part.holes.size(); ++i) {
    const auto& hole = part.holes[i].hole;
    const auto where = lies(part, hole);
    if (where == Lies::off_part) continue;
    if (where == Lies::across_a_cut) refuse("a hole reaches into the cut at an end");
    for (const auto* other : kept)
      if (some_meet && part::holes_meet(tube, *other, hole)) refuse("two holes meet");
    kept.push_back(&hole);
    cuts.push_back(hole_cut(tube, hole, "hole " + std::to_string(i), caption));
  }
  const auto& layout = part.cutouts;
  for (std::size_t i = 0; i < layout.instances.size(); ++i) {
    const auto& one = layout.instances[i];
    const auto& mould = layout.mould_of(one);
    if (one.sunk) continue;
    if (mould.cone && cutout::cone_wall(mould.laying, *mould.cone) == cutout::ConeWall::mixed)
      refuse("the land of countersink " + one.name + " does not go all round");
    cuts.push_back({TubeCut::Kind::hole, "cut-out " + cutout_tag(layout, i),
                    mould.cone ? cone_curve(tube, mould, one.phi, one.z, caption)
                               : cutout_curve(tube, mould, one.phi, one.z, caption)});
  }
  return tube_solid(tube.inner_radius(), tube.outer_radius, cuts);
}

std::string part_step(const part::PartSpec& spec, const part::Part& part, const Caption& caption) {
  return print_step(part_solid(spec, part, caption), product_of(spec.target, spec.name, caption),
                    caption);
}

}  // namespace tubecut::api
