#include "api/wire/tables.hpp"

#include "api/formats/bevel_table_formats.hpp"
#include "core/base/angle.hpp"
#include "core/bevel/table/zone_gaps.hpp"

namespace tubecut::api {
namespace {

/// Degrees of equally spaced angles are exactly 360 i / n, not that through radians and back.
Columns& angles(Columns& out, std::string_view name, const std::vector<double>& radians,
                bool equally) {
  if (!equally) return out.degrees(name, radians);
  std::vector<double> grid(radians.size());
  for (std::size_t i = 0; i < grid.size(); ++i)
    grid[i] = 360.0 * static_cast<double>(i) / static_cast<double>(grid.size());
  return out.column(name, std::move(grid));
}

/// One value of every row of a table held by rows.
template <class Rows, class F>
auto each(const Rows& rows, F value) {
  std::vector<decltype(value(rows.front()))> out;
  out.reserve(rows.size());
  for (const auto& row : rows) out.push_back(value(row));
  return out;
}

}  // namespace

Columns bevel_columns(const bevel::TableSpec& spec, const bevel::Table& t) {
  Columns out;
  angles(out, "phi_deg", t.phi, !spec.sampling.tolerance)
      .column("developed_mm", t.developed)
      .column("length_mm", t.length)
      .integers("cutter", t.cutter)
      .column("z_inner_mm", t.z_inner)
      .column("z_outer_mm", t.z_outer)
      .degrees("dihedral_deg", t.dihedral)
      .degrees("groove_deg", t.groove)
      .degrees("tau_deg", t.tau)
      .degrees("gamma_deg", t.gamma)
      .degrees("flush_deg", t.flush)
      .where_any("dz_per_branch_mm", t.dz_branch)
      .where_any("dz_per_chord_mm", t.dz_chord)
      .degrees("b_raw_deg", t.b_raw)
      .degrees("b_required_deg", t.b_required)
      .degrees("b_deg", t.b)
      .column("gap_mm", t.gap)
      .column("beam_mm", t.beam)
      .column("torch_inner_mm", t.torch_inner)
      .column("torch_outer_mm", t.torch_outer)
      .flags("corner", corners(spec, t));
  if (spec.root_face > 0.0) out.column("z_face_mm", t.z_face).degrees("b_face_deg", t.b_face);
  if (const auto* zoned = std::get_if<bevel::ZonedGroove>(&spec.groove))
    out.texts("zone", each(t.zone, [&](std::size_t i) { return zoned->zones[i].id; }));
  if (const auto* zoned = std::get_if<bevel::ZonedGroove>(&spec.groove);
      zoned != nullptr && zoned->has_root_gaps())
    out.column("root_gap_mm", bevel::root_gaps(spec, t));
  if (spec.untilted)
    out.column("gap_inner_mm", t.gaps.square.inner)
        .column("gap_outer_mm", t.gaps.square.outer)
        .column("bevelled_gap_inner_mm", t.gaps.bevelled.inner)
        .column("bevelled_gap_outer_mm", t.gaps.bevelled.outer);
  return out;
}

std::vector<std::string> bevel_column_names(const bevel::TableSpec& spec) {
  bevel::TableSpec with;  // determines which columns exist, without rows
  with.root_face = spec.root_face;
  with.groove = spec.groove;
  with.untilted = spec.untilted;
  return each(bevel_columns(with, {}).all(), [](const Column& column) { return column.name; });
}

const std::vector<std::string>& bevel_column_names() {
  static const auto kNames = [] {
    bevel::TableSpec every;  // column
    every.root_face = 1.0;
    bevel::ZonedGroove zoned;
    zoned.zones.push_back({.root_gap = 0.0});
    every.groove = zoned;
    every.untilted = true;
    return bevel_column_names(every);
  }();
  return kNames;
}

Columns profile_columns(const joint::Profile& p, const joint::Sampling& sampling) {
  Columns out;
  angles(out, "phi_deg", p.phi, !sampling.tolerance)
      .column("z_mm", p.z)
      .integers("cutter", p.cutter);
  return out;
}

Columns hole_columns(const bevel::HoleSpec& spec, const bevel::Hole& h) {
  Columns out;
  angles(out, "branch_phi_deg", h.branch_phi, !h.far && !spec.sampling.tolerance)
      .column("length_mm", h.length)
      .degrees("phi_deg", h.phi)
      .column("z_mm", h.z)
      .column("developed_mm", h.developed)
      .degrees("phi_inner_deg", h.phi_inner)
      .column("z_inner_mm", h.z_inner)
      .degrees("dihedral_deg", h.dihedral)
      .degrees("groove_deg", h.groove)
      .degrees("b_deg", h.b)
      .degrees("a_deg", h.a)
      .column("beam_mm", h.beam)
      .degrees("torch_phi_deg", h.torch_phi)
      .column("torch_z_mm", h.torch_z)
      .degrees("torch_phi_inner_deg", h.torch_phi_inner)
      .column("torch_z_inner_mm", h.torch_z_inner);
  return out;
}

Columns cutout_columns(const bevel::Hole& rows) {
  return Columns()
      .degrees("phi_deg", rows.phi)
      .column("z_mm", rows.z)
      .column("developed_mm", rows.developed)
      .degrees("phi_inner_deg", rows.phi_inner)
      .column("z_inner_mm", rows.z_inner)
      .degrees("b_deg", rows.b)
      .degrees("a_deg", rows.a)
      .degrees("torch_phi_deg", rows.torch_phi)
      .column("torch_z_mm", rows.torch_z)
      .degrees("torch_phi_inner_deg", rows.torch_phi_inner)
      .column("torch_z_inner_mm", rows.torch_z_inner);
}

Columns fit_up_columns(const bevel::Hole& h) {
  return Columns()
      .column("root_mm", h.fit.root)
      .column("face_mm", h.fit.face)
      .column("least_mm", h.fit.least);
}

Columns branch_columns(const bevel::HoleSpec& spec, const bevel::BranchEnd& end) {
  Columns out;
  angles(out, "phi_deg", end.phi, !spec.sampling.tolerance)
      .column("z_inner_mm", end.z_inner)
      .column("z_outer_mm", end.z_outer)
      .degrees("b_deg", end.b);
  return out;
}

Columns section_columns(const groove::Groove& g) {
  using S = const groove::GrooveSection&;
  const auto of = [&](auto value) { return each(g.sections, value); };
  return Columns()
      .degrees("omega_deg", of([](S s) { return s.omega.rad(); }))
      .degrees("phi_deg", of([](S s) { return s.phi.rad(); }))
      .column("root_z_mm", of([](S s) { return s.root_z; }))
      .column("height_mm", of([](S s) { return s.height; }))
      .column("p1_x_mm", of([](S s) { return s.p1.x(); }))
      .column("p1_y_mm", of([](S s) { return s.p1.y(); }))
      .column("p2_x_mm", of([](S s) { return s.p2.x(); }))
      .column("p2_y_mm", of([](S s) { return s.p2.y(); }))
      .column("p3_x_mm", of([](S s) { return s.p3.x(); }))
      .column("p3_y_mm", of([](S s) { return s.p3.y(); }))
      // 0 if the chord's section is a pair of lines, which has no such axis
      .column("ellipse_a_mm", of([](S s) { return s.ellipse_a.value_or(0.0); }))
      .column("area_a_mm2", of([](S s) { return s.areas.a; }))
      .column("area_b_mm2", of([](S s) { return s.areas.b; }))
      .column("area_c_mm2", of([](S s) { return s.areas.c; }))
      .column("area_d_mm2", of([](S s) { return s.areas.d; }))
      .column("area_e_mm2", of([](S s) { return s.areas.e; }))
      .degrees("twist_deg", of([](S s) { return s.ruling.twist.rad(); }))
      .degrees("groove_angle_deg", of([](S s) { return s.groove_angle.rad(); }));
}

Columns curve_columns(const groove::Groove& g, Eigen::Vector3d groove::CurvePoints::*curve) {
  const auto of = [&](int k) {
    return each(g.sections, [=](const groove::GrooveSection& s) { return (s.curves.*curve)[k]; });
  };
  return Columns().column("x_mm", of(0)).column("y_mm", of(1)).column("z_mm", of(2));
}

Columns compare_columns(const groove::Comparison& compare) {
  return Columns().column("filler_area_mm2", compare.filler_area);
}

Columns position_columns(const groove::MillPath& path) {
  using P = const groove::MillPosition&;
  const auto of = [&](auto value) { return each(path.positions, value); };
  return Columns()
      .degrees("omega_deg", of([](P p) { return p.omega.rad(); }))
      .degrees("c_deg", of([](P p) { return p.at.c.rad(); }))
      .column("x_mm", of([](P p) { return p.at.x; }))
      .column("z_mm", of([](P p) { return p.at.z; }))
      .degrees("b_deg", of([](P p) { return p.at.b.rad(); }))
      .column("dz_mm", of([](P p) { return p.by.dz; }))
      .degrees("db_deg", of([](P p) { return p.by.db; }))
      .column("overcut_before_mm", of([](P p) { return p.before.over; }))
      .column("undercut_before_mm", of([](P p) { return p.before.under; }))
      .column("overcut_mm", of([](P p) { return p.after.over; }))
      .column("undercut_mm", of([](P p) { return p.after.under; }))
      .column("gap_before_mm", of([](P p) { return p.before.largest; }))
      .column("gap_mm", of([](P p) { return p.after.largest; }))
      .column("grid_overcut_before_mm", of([](P p) { return p.grid_before.over; }))
      .column("grid_undercut_before_mm", of([](P p) { return p.grid_before.under; }))
      .column("grid_overcut_mm", of([](P p) { return p.grid.over; }))
      .column("grid_undercut_mm", of([](P p) { return p.grid.under; }))
      .column("certificate_mm", of([](P p) { return p.certificate; }))
      .integers("evaluations", of([](P p) { return p.evaluations; }))
      .flags("qualified", of([](P p) { return p.qualified; }))
      .flags("optimised", of([](P p) { return p.optimised; }));
}

Columns feed_columns(const cutoff::FeedCurve& curve) {
  return Columns()
      .column("t_s", curve.table.time)
      .column("feed_mm", curve.table.feed)
      .column("stroke_mm", curve.table.stroke)
      .column("cylinder_speed_mm_s", curve.table.speed)
      .column("cylinder_acceleration_mm_s2", curve.table.acceleration);
}

}  // namespace tubecut::api
