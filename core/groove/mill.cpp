#include "core/groove/mill.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/base/rounding.hpp"
#include "core/base/try.hpp"

namespace tubecut::groove {
namespace {

/// Machine Z grows against the branch axis if the end looks up.
double z_sign(Mount mount) { return mount == Mount::end_up ? -1.0 : 1.0; }

std::vector<Issue> number_issues(const Mill& mill, const Setup& setup) {
  std::vector<Issue> issues;
  const auto finite = [&issues](const char* member, double value, const char* unit) {
    if (!std::isfinite(value))
      issues.push_back({.code = ErrorCode::not_finite, .member = member, .unit = unit});
  };
  finite("mill/half_angle", mill.half_angle.deg(), "deg");
  finite("mill/tip_radius", mill.tip_radius, "mm");
  finite("mill/length", mill.length, "mm");
  finite("setup/pivot_length", setup.pivot_length, "mm");
  finite("setup/z_zero", setup.z_zero, "mm");
  finite("setup/c_zero", setup.c_zero.deg(), "deg");
  finite("setup/overrun", setup.overrun, "mm");
  return issues;
}

std::vector<Issue> shape_issues(const Mill& mill, const Setup& setup) {
  std::vector<Issue> issues;
  const auto refuse = [&issues](ErrorCode code, const char* member, double got, double limit,
                                const char* unit) {
    issues.push_back({.code = code, .member = member, .got = got, .limit = limit, .unit = unit});
  };
  const double kappa = mill.half_angle.deg();
  if (!(kappa >= 0.0 && kappa < 90.0))
    refuse(ErrorCode::tool, "mill/half_angle", kappa, 90.0, "deg");
  if (mill.tip_radius < 0.0 || (mill.tip_radius == 0.0 && kappa == 0.0))
    refuse(ErrorCode::tool, "mill/tip_radius", mill.tip_radius, 0.0, "mm");
  if (mill.length <= 0.0) refuse(ErrorCode::tool, "mill/length", mill.length, 0.0, "mm");
  if (setup.direction != 1 && setup.direction != -1)
    refuse(ErrorCode::tool, "setup/direction", setup.direction, 1.0, "");
  if (setup.overrun < 0.0)
    refuse(ErrorCode::out_of_range, "setup/overrun", setup.overrun, 0.0, "mm");
  if (setup.pivot_length < 0.0)
    refuse(ErrorCode::setup, "setup/pivot_length", setup.pivot_length, 0.0, "mm");
  if (setup.mount != Mount::end_up && setup.mount != Mount::end_down)
    refuse(ErrorCode::setup, "setup/mount", double(setup.mount), 1.0, "");
  return issues;
}

std::vector<Issue> fit_issues(const JointGeometry& joint, const Survey& survey, const Mill& mill,
                              const Setup& setup) {
  std::vector<Issue> issues;
  const Cone cone{mill};
  const double longest = elementary::hypot(joint.groove_width, survey.height_max) + setup.overrun;
  if (cone.generatrix < longest)
    issues.push_back({.code = ErrorCode::tool_short,
                      .member = "mill/length",
                      .got = mill.length,
                      .limit = rounded_up(longest * cone.cos_k),
                      .unit = "mm",
                      .hint = "the generatrix must reach from curve 3 to curve 4 everywhere"});
  // If the generatrix's normal m points inward (beta + kappa > 90 deg), the tip's face leans over
  // the root face.
  const double kappa = mill.half_angle.deg();
  const double lean = setup.direction > 0 ? survey.groove_angle_max.deg() + kappa
                                          : std::max(survey.groove_angle_max.deg() - kappa,
                                                     kappa - survey.groove_angle_min.deg());
  if (joint.root_height > 0.0 && lean > 90.0)
    issues.push_back({.code = ErrorCode::root_collision,
                      .member = "mill/half_angle",
                      .got = kappa,
                      .limit = rounded_down(kappa - (lean - 90.0)),
                      .unit = "deg"});
  return issues;
}

}  // namespace

Cone::Cone(const Mill& mill) {
  const auto [s, c] = elementary::sincos(mill.half_angle.rad());
  sin_k = s;
  cos_k = c;
  tip_radius = mill.tip_radius;
  length = mill.length;
  back_radius = tip_radius + length * s / c;
  generatrix = length / c;
}

double Cone::solid(double rho, double l) const {
  const double flank_distance = flank(rho, l);
  if (l <= 0.0 && rho <= tip_radius) return -l;
  if (l >= length && rho <= back_radius) return l - length;
  if (flank_distance <= 0.0 && l >= 0.0 && l <= length)
    return std::max({flank_distance, -l, l - length});
  const double along = l * cos_k + (rho - tip_radius) * sin_k;
  if (along < 0.0) return elementary::hypot(rho - tip_radius, l);
  if (along > generatrix) return elementary::hypot(rho - back_radius, l - length);
  return flank_distance;
}

Cone::Rise Cone::solid_rise(double rho, double l) const {
  const double distance = solid(rho, l), along = l * cos_k + (rho - tip_radius) * sin_k;
  if (distance == -l) return {0.0, -1.0};
  if (distance == l - length) return {0.0, 1.0};
  if (distance <= 0.0 || (along >= 0.0 && along <= generatrix)) return flank_rise();
  const bool tip = along < 0.0;
  return {(rho - (tip ? tip_radius : back_radius)) / distance, (tip ? l : l - length) / distance};
}

FlankFoot Cone::foot(const ToolPose& pose, const Eigen::Vector3d& p) const {
  const Meridian m = meridian(pose, p);
  const double in_plane = m.across / m.rho, sideways = p.y() / m.rho;
  FlankFoot out;
  out.distance = (m.rho - tip_radius) * cos_k - m.l * sin_k;
  out.gradient = {cos_k * in_plane * pose.axis.y() - sin_k * pose.axis.x(), cos_k * sideways,
                  -cos_k * in_plane * pose.axis.x() - sin_k * pose.axis.y()};
  out.along = m.l * cos_k + (m.rho - tip_radius) * sin_k;
  return out;
}

ToolPose initial_pose(const JointGeometry& joint, const Section& section, const Mill& mill,
                      const Setup& setup) {
  const Cone cone{mill};
  const double ruling = elementary::hypot(joint.groove_width, section.height);
  const Eigen::Vector2d up(joint.groove_width / ruling, section.height / ruling);
  const Eigen::Vector2d air(up.y(), -up.x());
  const Eigen::Vector2d e = double(setup.direction) * up;
  const double before = setup.direction > 0 ? setup.overrun : cone.generatrix - setup.overrun;
  const Eigen::Vector2d across = air * cone.cos_k - e * cone.sin_k;
  const Eigen::Vector2d p1(section.toe.x1, section.toe.y1);
  return {p1 - before * e + cone.tip_radius * across, e * cone.cos_k + air * cone.sin_k};
}

ToolPose moved(const ToolPose& pose, const Setup& setup, Hold hold, Increment by) {
  const double sg = z_sign(setup.mount);
  const auto [s, c] = elementary::sincos(by.db);
  // B tilts the axis from machine Z towards X; against the branch axis for end_up.
  const Eigen::Vector2d axis(pose.axis.x() * c + sg * pose.axis.y() * s,
                             pose.axis.y() * c - sg * pose.axis.x() * s);
  const Eigen::Vector2d lift(0.0, sg * by.dz);
  if (hold == Hold::tip) return {pose.tip + lift, axis};
  return {pose.tip + lift + setup.pivot_length * (pose.axis - axis), axis};
}

AxisPosition axis_position(const ToolPose& pose, const Setup& setup, Angle omega) {
  const double sg = z_sign(setup.mount);
  const Eigen::Vector2d pivot = pose.tip + setup.pivot_length * pose.axis;
  const double turned = setup.c_zero.rad() - sg * omega.rad();
  return {.c = Angle::rad(turned - kTwoPi * std::floor(turned / kTwoPi)),
          .x = pivot.x(),
          .z = setup.z_zero + sg * pivot.y(),
          .b = Angle::rad(elementary::atan2(pose.axis.x(), sg * pose.axis.y()))};
}

ToolPose tool_pose(const AxisPosition& axes, const Setup& setup) {
  const double sg = z_sign(setup.mount);
  const auto [s, c] = elementary::sincos(axes.b.rad());
  const Eigen::Vector2d axis(s, sg * c);
  return {Eigen::Vector2d(axes.x, sg * (axes.z - setup.z_zero)) - setup.pivot_length * axis, axis};
}

Result<void> check_tool(const JointGeometry& joint, const Survey& survey, const Mill& mill,
                        const Setup& setup) {
  TRY(no_issues(number_issues(mill, setup)));
  TRY(no_issues(shape_issues(mill, setup)));
  return no_issues(fit_issues(joint, survey, mill, setup));
}

}  // namespace tubecut::groove
