#include "core/cutout/tab_slot.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/elementary.hpp"

namespace tubecut::cutout {
namespace {

using Eigen::Vector3d;

constexpr int kTabDepths = 33;

/// The shadow of a tab on the wall's outside as it moves along its axis.
struct TabShadow {
  Vector3d width, thickness;  // its sides
  Vector3d way;               // of the tab from the outside to the bore, along the wall
};

TabShadow shadow_of(const Tab& tab, const PlaneWall& wall) {
  const auto& d = tab.axis;
  const auto& n = wall.normal;
  const double into = d.dot(n);
  const auto along_axis = [&](const Vector3d& v) -> Vector3d { return v - v.dot(n) / into * d; };
  const Vector3d slide = d - into * n;
  return {tab.width * along_axis(tab.face.cross(d)), tab.thickness * along_axis(tab.face),
          wall.thickness / std::abs(into) * slide};
}

/// A prism's far side on a wall of radius rho: how far in from the outside it lies at a distance
/// from the tube's axis.
double below_outside(const RoundWall& wall, double half) {
  return wall.outer - std::sqrt((wall.inner - half) * (wall.inner + half));
}

}  // namespace

PlaneSlot slot_in_plane(const Tab& tab, const PlaneWall& wall, const TabClearance& clearance) {
  const auto shadow = shadow_of(tab, wall);
  PlaneSlot out;
  out.along = wall.normal.cross(tab.face).normalized();
  out.across = out.along.cross(wall.normal);
  const auto side = [&](const Vector3d& direction, double free) {
    return std::abs(shadow.width.dot(direction)) + std::abs(shadow.thickness.dot(direction)) +
           std::abs(shadow.way.dot(direction)) + 2.0 * free;
  };
  out.length = side(out.along, clearance.width);
  out.width = side(out.across, clearance.thickness);
  out.middle = 0.5 * shadow.way;
  return out;
}

double tab_lacks(const Tab& tab, const PlaneWall& wall, const PlaneSlot& slot,
                 const TabClearance& clearance, double corner) {
  const auto shadow = shadow_of(tab, wall);
  const double half_length = 0.5 * slot.length, half_width = 0.5 * slot.width;
  double out = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTabDepths; ++i)
    for (const auto& [a, b] : {std::pair{-0.5, -0.5}, {-0.5, 0.5}, {0.5, -0.5}, {0.5, 0.5}}) {
      const double share = static_cast<double>(i) / (kTabDepths - 1);
      const Vector3d at =
          share * shadow.way + a * shadow.width + b * shadow.thickness - slot.middle;
      const double x = std::abs(at.dot(slot.along)), y = std::abs(at.dot(slot.across));
      out =
          std::max({out, x + clearance.width - half_length, y + clearance.thickness - half_width});
      const double u = x - (half_length - corner), v = y - (half_width - corner);
      if (u > 0.0 && v > 0.0) out = std::max(out, elementary::hypot(u, v) - corner);
    }
  return out;
}

RoundSlot slot_in_round(const RoundSlot& tab, const RoundSlot& clearance) {
  return {tab.along + 2.0 * clearance.along, tab.round + 2.0 * clearance.round};
}

RoundSlot developed_slot(const RoundSlot& prism, const RoundWall& wall) {
  return {prism.along,
          2.0 * wall.outer * elementary::asin(std::min(1.0, 0.5 * prism.round / wall.inner))};
}

RoundSlot slot_in_round(const Tab& tab, double alpha, const RoundWall& wall,
                        const TabClearance& clearance) {
  const auto lean = elementary::sincos(alpha);
  const double round = tab.width + 2.0 * clearance.width;
  return {tab.thickness / lean.sin + below_outside(wall, 0.5 * round) * lean.cos / lean.sin +
              2.0 * clearance.thickness,
          round};
}

double largest_slot_corner(const TabClearance& clearance) {
  const auto& [c, t] = clearance;
  return c + t + std::sqrt(2.0 * c * t);
}

double shoulder_stands_off(double fillet, double clearance) {
  if (!(fillet > clearance)) return 0.0;
  return fillet - std::sqrt(clearance * (2.0 * fillet - clearance));
}

}  // namespace tubecut::cutout
