#include "core/cutout/tab_slot.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/elementary.hpp"

namespace tubecut::cutout {
namespace {

using Eigen::Vector2d;
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

/// x of a place of a radius at a distance from the middle plane.
double out_at(double radius, double y) { return std::sqrt((radius - y) * (radius + y)); }

/// By how much a place u, v from a rectangle's middle lies beyond its round corner, mm.
double beyond_corner(double u, double v, const Eigen::Vector2d& half, double corner) {
  const double a = std::abs(u) - (half.x() - corner), b = std::abs(v) - (half.y() - corner);
  return a > 0.0 && b > 0.0 ? elementary::hypot(a, b) - corner
                            : -std::numeric_limits<double>::infinity();
}

/// The lines along a tab's axis that tell how it lies in a round wall, at x = 0, from its middle.
std::vector<Vector2d> lines_of(const RoundTab& tab) {
  std::vector<Vector2d> corners, out;
  for (const auto& [a, b] : {std::pair{-0.5, -0.5}, {-0.5, 0.5}, {0.5, 0.5}, {0.5, -0.5}})
    corners.push_back(a * tab.width + b * tab.thickness);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto &from = corners[i], &to = corners[(i + 1) % corners.size()];
    out.push_back(from);
    const double y = tab.middle.x() + from.x(), way = to.x() - from.x();
    if (y * (y + way) < 0.0) out.push_back(from - y / way * (to - from));
  }
  return out;
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
      out = std::max(out, beyond_corner(x, y, {half_length, half_width}, corner));
    }
  return out;
}

double RoundTab::nearest() const { return std::max(0.0, std::abs(middle.x()) - half().x()); }
double RoundTab::farthest() const { return std::abs(middle.x()) + half().x(); }
double RoundTab::deep(const RoundWall& wall) const {
  return out_at(wall.outer, nearest()) - out_at(wall.inner, nearest());
}

RoundSlot slot_in_round(const RoundTab& tab, const RoundWall& wall, const Vector2d& clearance) {
  const Vector2d half = tab.half() + clearance;
  RoundSlot out{.low = tab.middle.x() - half.x(), .high = tab.middle.x() + half.x()};
  const auto turn = [&](double y, bool towards_middle) {
    return elementary::asin(y / (towards_middle ? wall.outer : wall.inner));
  };
  const double from = turn(out.low, out.low > 0.0), to = turn(out.high, out.high < 0.0);
  out.turn = 0.5 * (from + to);
  out.round = wall.outer * (to - from);
  const double nearest = std::max(0.0, std::abs(tab.middle.x()) - half.x());
  const double top = out_at(wall.outer, nearest);
  const double bottom = out_at(wall.inner, std::abs(tab.middle.x()) + half.x());
  out.along = 2.0 * half.y() + (top - bottom) * std::abs(tab.lean);
  out.z = tab.middle.y() + 0.5 * (top + bottom) * tab.lean;
  return out;
}

double tab_lacks(const RoundTab& tab, const RoundWall& wall, const RoundSlot& slot, RoundCut cut,
                 const Vector2d& clearance, double corner) {
  const bool square = cut == RoundCut::square;
  const double around = square ? 0.5 * slot.round / wall.outer : 0.0;
  const Vector2d half(0.5 * (square ? slot.round : slot.high - slot.low), 0.5 * slot.along);
  double out = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTabDepths; ++i)
    for (const auto& line : lines_of(tab)) {
      const double share = static_cast<double>(i) / (kTabDepths - 1);
      const double radius = wall.outer + share * (wall.inner - wall.outer);
      const double y = tab.middle.x() + line.x();
      const double z = tab.middle.y() + line.y() + tab.lean * out_at(radius, y) - slot.z;
      const double low = square ? radius * elementary::sin(slot.turn - around) : slot.low;
      const double high = square ? radius * elementary::sin(slot.turn + around) : slot.high;
      out = std::max({out, low + clearance.x() - y, y + clearance.x() - high,
                      std::abs(z) + clearance.y() - half.y()});
      const double u = square ? wall.outer * (elementary::asin(y / radius) - slot.turn)
                              : y - 0.5 * (slot.low + slot.high);
      out = std::max(out, beyond_corner(u, z, half, corner));
    }
  return out;
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
