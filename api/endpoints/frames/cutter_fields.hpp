#pragma once

#include <Eigen/Core>
#include <cmath>

#include "api/wire/json.hpp"
#include "core/base/angle.hpp"
#include "core/joint/cutters/cutter.hpp"

/// Numbers of the parts that a frame requests.
namespace tubecut::api::written {

/// Rounds numbers to their significant digits, so that equal parts have equal texts: lengths to
/// 1e-6 mm, angles to 1e-11 deg, directions to 1e-12, because an axis may be given by a far foot.
inline Json tidy(double value, double to) {
  const double out = std::round(value * to) / to;
  return Json{out == 0.0 ? 0.0 : out};
}
inline Json mm(double value) { return tidy(value, 1e6); }
inline Json deg(Angle angle) {
  const auto out = tidy(angle.deg(), 1e11);
  return out == Json{360.0} ? Json{0.0} : out;
}
inline Json vector(const Eigen::Vector3d& v, double to) {
  return Json{Json::Array{tidy(v.x(), to), tidy(v.y(), to), tidy(v.z(), to)}};
}
inline Json point(const Eigen::Vector3d& v) { return vector(v, 1e6); }
inline Json direction(const Eigen::Vector3d& v) { return vector(v, 1e12); }
inline Json axis(const Eigen::Vector3d& at, const Eigen::Vector3d& along) {
  return Json{Json::Object{{"point_mm", point(at)}, {"direction", direction(along)}}};
}

/// A cutter's own fields but `kind`: one case for every kind.
struct Fields {
  using All = Json::Object;
  All operator()(const joint::TubeCutter& t) const {
    return {{"outer_diameter_mm", mm(2.0 * t.radius)},
            {"inclination_deg", deg(t.inclination)},
            {"clocking_deg", deg(t.clocking)},
            {"offset_mm", mm(t.offset)},
            {"height_mm", mm(t.height)}};
  }
  All operator()(const joint::AxisTube& t) const {
    return {{"outer_diameter_mm", mm(2.0 * t.radius)},
            {"axis", axis(t.axis.point, t.axis.direction)}};
  }
  All operator()(const joint::PlaneCutter& p) const {
    return {{"point_mm", point(p.point)}, {"normal", direction(p.normal)}};
  }
  All operator()(const joint::RectangularTubeCutter& t) const {
    return {{"width_mm", Json{t.width}},
            {"height_mm", Json{t.height}},
            {"corner_radius_mm", Json{t.corner}},
            {"axis", axis(t.point, t.direction)},
            {"up", direction(t.up)}};
  }
  All operator()(const joint::ConeCutter& c) const {
    return {{"outer_diameter_mm", mm(2.0 * c.radius)},
            {"half_angle_deg", deg(c.half_angle)},
            {"axis", axis(c.point, c.direction)}};
  }
  All operator()(const joint::ElbowCutter& e) const {
    return {{"outer_diameter_mm", mm(2.0 * e.radius)},
            {"bend_radius_mm", Json{e.bend_radius}},
            {"bend_deg", deg(e.bend)},
            {"axis", axis(e.point, e.direction)},
            {"inwards", direction(e.inwards)}};
  }
};

}  // namespace tubecut::api::written
