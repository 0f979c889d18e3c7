#include "core/bevel/beam_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/math/cylinder.hpp"

namespace tubecut::bevel::beam {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 2e-6;  // of the radius, of a parabola for a helix

Vector3d mixed_points(const Vector3d& a, const Vector3d& b, double u) {
  return (1.0 - u) * a + u * b;
}

}  // namespace

Surface::Surface(const BeamCut& cut, const std::stop_token& stop) : cut_(cut), axes_(cut, stop) {
  if (rows() == 0) return;
  Line here = across_wall(0, 0.0, false);
  for (std::size_t i = 0; i < rows() && !stop.stop_requested(); ++i) {
    const Line next = across_wall(i, 1.0, false);
    along_.push_back(0.5 * (next.from - here.from + next.to - here.to));
    here = next;
  }
}

Surface::Seen Surface::seen(const Place& at, const Line& line) const {
  const auto near = axes_.nearest(at.row, at.u, point(at, line));
  const double distance = std::sqrt(near.square);
  const bool in_part = beyond(near) > kRounding * cut_.outer;
  return {in_part ? -distance : distance, near.row, near.u};
}

double Surface::phase(const Place& at) const {
  const auto here = finished(at);
  return mixed(here.phi_inner, here.phi_outer, at.land ? 0.0 : share(at));
}

double Surface::across(std::size_t row, bool land) const {
  const auto line = across_wall(row, 0.0, land);
  return (point({row, 0.0, 1.0, land}, line) - point({row, 0.0, 0.0, land}, line)).norm();
}

double Surface::step(std::size_t row) const {
  const auto a = finished({row, 0.0}), b = finished({row, 1.0});
  const double rise = b.z_inner - a.z_inner;
  const double land = cut_.land.empty() ? rise : cut_.land[(row + 1) % rows()] - cut_.land[row];
  const double steep = std::max(std::abs(rise), std::abs(land));
  return std::max(
      elementary::hypot(cut_.inner * (b.phi_inner - a.phi_inner), steep),
      elementary::hypot(cut_.outer * (b.phi_outer - a.phi_outer), b.z_outer - a.z_outer));
}

Place Surface::moved(Place from, double along, double across) const {
  const double wide = this->across(from.row, from.land);
  if (wide > 0.0) from.v = std::clamp(from.v + across / wide, 0.0, 1.0);
  const double sense = along < 0.0 ? -1.0 : 1.0;
  double left = std::abs(along);
  for (std::size_t row = 0; row < rows() && left > 0.0; ++row) {
    const double end = along < 0.0 ? 0.0 : 1.0, length = step(from.row);
    const double to_end = std::abs(end - from.u) * length;
    if (left <= to_end) {
      from.u += sense * left / length;
      break;
    }
    left -= to_end;
    from.row = (from.row + (along < 0.0 ? rows() - 1 : 1)) % rows();
    from.u = 1.0 - end;
  }
  return from;
}

AcrossWall Surface::finished(const Place& at) const {
  return between(cut_.finished, cut_.turn, at.row, at.u);
}

Line Surface::across_wall(std::size_t row, double u, bool land) const {
  const auto here = finished({row, u});
  const auto wall = placed(cut_, here);
  if (!land) return wall;
  const double z = mixed(cut_.land[row], cut_.land[(row + 1) % rows()], u);
  return {math::cylinder_point(cut_.inner, here.phi_inner, z),
          mixed_points(wall.from, wall.to, cut_.from)};
}

Vector3d Surface::point(const Place& at, const Line& line) const {
  return mixed_points(line.from, line.to, at.land ? at.v : share(at));
}

/// How far the axis runs beyond the finished line of its own row where it is nearest.
double Surface::beyond(const Nearest& near) const {
  const auto own = finished({near.row, near.u});
  const auto line = placed(cut_, own);
  const Vector3d across = line.to - line.from;
  const Vector3d from = near.point - line.from;
  const Vector3d off = from - from.dot(across) / across.squaredNorm() * across;
  const Vector3d normal = along_[near.row].cross(across);
  const double size = normal.norm();
  return size > 0.0 ? (cut_.part_to_the_left ? -1.0 : 1.0) * normal.dot(off) / size : 0.0;
}

}  // namespace tubecut::bevel::beam
