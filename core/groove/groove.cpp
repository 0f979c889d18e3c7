#include "core/groove/groove.hpp"

#include <cmath>
#include <utility>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/groove/survey.hpp"

namespace tubecut::groove {
namespace {

/// The bevel table's target frame is the branch frame rotated by half a turn, its phi counted from
/// x: phi = omega - 90 deg.
Angle table_phi(double turn) {
  const double from_x = turn - 0.25;
  return Angle::rad(kTwoPi * (from_x < 0.0 ? from_x + 1.0 : from_x));
}

GrooveSection report(const JointGeometry& joint, const Section& section) {
  GrooveSection out;
  const Toe& p = section.toe;
  out.omega = section.omega;
  out.p1 = {p.x1, p.y1};
  out.p2 = {p.x2, p.y2};
  out.p3 = {joint.branch_radius, section.y3};
  out.height = section.height;
  out.root_z = p.y1;
  if (section.dir.sin != 0.0) out.ellipse_a = joint.chord_radius / std::abs(section.dir.sin);
  out.areas = areas(joint, section);
  out.ruling = ruling(joint, section);
  out.curves = curve_points(joint, section);
  out.groove_angle = groove_angle(joint, section);
  return out;
}

}  // namespace

Result<Groove> groove(const GrooveSpec& spec) {
  TRY(const auto joint, joint_geometry(spec));
  const double fixed_height =
      spec.compare ? joint.groove_width * elementary::tan(spec.compare->bevel.rad()) : 0.0;
  TRY(auto whole, survey(joint, fixed_height));
  Groove out;
  out.area = joint.area;
  out.least_area = whole.least_area;
  out.height_min = whole.height_min;
  out.height_max = whole.height_max;
  out.filler_volume = whole.filler_volume;
  out.weld_length = whole.weld_length;
  out.warnings = std::move(whole.warnings);
  if (spec.compare) out.compare = Comparison{fixed_height, {}, whole.fixed_volume};
  for (int i = 0; i < spec.sections; ++i) {
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    const auto found = section(joint, Angle::rad(kTwoPi * i / spec.sections));
    if (!found) return fail({.code = found.error(), .member = "branch/wall"});
    out.sections.push_back(report(joint, *found));
    out.sections.back().phi = table_phi(double(i) / spec.sections);
    if (out.compare)
      out.compare->filler_area.push_back(filler_area(joint, found->toe, fixed_height));
  }
  return out;
}

Result<GrooveSection> section_at(const GrooveSpec& spec, Angle omega) {
  TRY(const auto joint, joint_geometry(spec));
  const auto found = section(joint, omega);
  if (!found) return fail({.code = found.error(), .member = "branch/wall"});
  auto out = report(joint, *found);
  const double turns = omega.rad() / kTwoPi;
  out.phi = table_phi(turns - std::floor(turns));
  return out;
}

}  // namespace tubecut::groove
