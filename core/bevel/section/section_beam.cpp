#include "core/bevel/section/section_beam.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/math/mixed.hpp"

namespace tubecut::bevel {

using Eigen::Vector3d;

double beam_depth(const SectionSurface& surface, const SectionTable& table, std::size_t row,
                  double share, double kerf) {
  constexpr int kAlong = 20, kAcross = 6;
  const double half = 0.5 * kerf, reach = surface.beam_reach(kerf);
  const auto next = surface.next(row);
  const auto own = surface.line(row, share);
  const auto laid = [&](const std::vector<double>& z) {
    return math::mixed(z[row], z[next], share);
  };
  const Vector3d head = SectionSurface::place(own, 0.0, laid(table.torch_outer));
  const Vector3d foot = SectionSurface::place(own, own.wall, laid(table.torch_inner));
  const Vector3d axis = (head - foot).normalized();
  const Vector3d side(-own.at.normal.y(), own.at.normal.x(), 0.0), up = axis.cross(side);
  double worst = -std::numeric_limits<double>::infinity();
  const auto see_at = [&](const SectionSurface::Line& line, double depth) {
    const Vector3d off = SectionSurface::place(line, depth, surface.z(line, depth)) - head;
    const double u = off.dot(side);
    const double v = off.x() * own.at.normal.x() + off.y() * own.at.normal.y();
    if (!(std::abs(u) < half) || v < -(own.wall + kerf)) return;
    worst = std::max(worst, std::sqrt((half - u) * (half + u)) - off.dot(up));
  };
  const auto see = [&](const SectionSurface::Line& line) {
    for (int a = 0; a <= kAcross; ++a) see_at(line, line.wall * a / kAcross);
    see_at(line, line.wall - surface.land());
  };
  const auto see_s = [&](double s) {
    const double there = s - table.girth * std::floor(s / table.girth);
    see(surface.line_at(surface.row_before(there), there));
  };
  surface.rows_near(row, reach, [&](std::size_t i) { see(surface.line(i, 0.0)); });
  for (int k = -kAlong; k <= kAlong; ++k) {
    const double sine = elementary::sin(0.5 * kPi * k / kAlong);
    see_s(own.at.s + half * sine);
    if (reach * std::abs(sine) > half) see_s(own.at.s + reach * sine);
  }
  return worst;
}

}  // namespace tubecut::bevel
