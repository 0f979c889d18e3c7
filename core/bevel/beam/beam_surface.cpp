#include "core/bevel/beam/beam_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/math/cylinder.hpp"

namespace tubecut::bevel::beam {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 2e-6;  // of the radius, of a parabola for a helix
constexpr double kOff = 0.25;       // of the kerf: at both rows, so it is clear between them too

Vector3d mixed_points(const Vector3d& a, const Vector3d& b, double u) {
  return (1.0 - u) * a + u * b;
}

}  // namespace

Surface::Surface(const BeamCut& cut) : cut_(cut), axes_(cut) {
  if (rows() > 0) see_rows();
}

void Surface::see_rows() {
  const auto n = rows();
  auto finished = placed(cut_, cut_.finished), torch = placed(cut_, cut_.torch);
  for (auto* lines : {&finished, &torch}) {
    const auto& all = lines == &torch ? cut_.torch : cut_.finished;
    lines->push_back(placed(cut_, between(all, cut_.turn, n - 1, 1.0)));
  }
  for (auto* column : {&steps_, &on_wall_, &on_land_}) column->reserve(n);
  for (std::size_t i = 0; i < n && !stopped(); ++i) {
    const Line &here = finished[i], &there = finished[i + 1];
    along_.push_back(0.5 * (there.from - here.from + there.to - here.to));
    steps_.push_back(length(i));
    on_wall_.push_back((here.to - here.from).norm() * (1.0 - cut_.from));
    const auto clear = [&](const Line& own, const Line& axis) {
      return std::max(beyond(own, i, axis.from), beyond(own, i, axis.to)) <= -kOff * cut_.kerf;
    };
    off_.push_back(clear(here, torch[i]) && clear(there, torch[i + 1]));
    if (cut_.land.empty()) continue;
    const double phi = cut_.finished[i].phi_inner;
    const Vector3d edge = mixed_points(here.from, here.to, cut_.from);
    on_land_.push_back((edge - math::cylinder_point(cut_.inner, phi, cut_.land[i])).norm());
  }
}

void Surface::seen(std::span<const SurfacePoint> at, std::span<Seen> out) const {
  std::array<Line, kLanes> lines;
  across_wall(at, lines);
  seen(at, lines, out);
}

void Surface::seen(std::span<const SurfacePoint> at, std::span<const Line> lines,
                   std::span<Seen> out) const {
  EightPoints points;
  std::array<OnWay, kLanes> own;
  std::array<Nearest, kLanes> near;
  for (std::size_t l = 0; l < kLanes; ++l) {
    const auto k = std::min(l, at.size() - 1);
    const Vector3d q = point(at[k], lines[k]);
    points.x[l] = q.x();
    points.y[l] = q.y();
    points.z[l] = q.z();
    own[l] = {at[k].row, at[k].u};
  }
  axes_.nearest(std::span(own).first(at.size()), points, std::span(near).first(at.size()));
  for (std::size_t l = 0; l < at.size(); ++l) {
    const double distance = std::sqrt(near[l].square);
    const auto& [row, u] = near[l].at;
    bool in_part = false;
    if (!off_[row]) {
      const Vector3d q{points.x[l], points.y[l], points.z[l]};
      const auto line = placed(cut_, finished(near[l].at));
      in_part = beyond(line, row, axes_.point(near[l], q)) > kRounding * cut_.outer;
    }
    out[l] = {in_part ? -distance : distance, row, u};
  }
}

double Surface::phase(const SurfacePoint& at) const {
  const auto here = finished({at.row, at.u});
  return mixed(here.phi_inner, here.phi_outer, at.land ? 0.0 : share(at));
}

double Surface::length(std::size_t row) const {
  const auto a = finished({row, 0.0}), b = finished({row, 1.0});
  const double rise = b.z_inner - a.z_inner;
  const double land = cut_.land.empty() ? rise : cut_.land[next(row)] - cut_.land[row];
  const double steep = std::max(std::abs(rise), std::abs(land));
  return std::max(
      elementary::hypot(cut_.inner * (b.phi_inner - a.phi_inner), steep),
      elementary::hypot(cut_.outer * (b.phi_outer - a.phi_outer), b.z_outer - a.z_outer));
}

SurfacePoint Surface::moved(SurfacePoint from, double along, double across) const {
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

AcrossWall Surface::finished(const OnWay& at) const {
  return between(cut_.finished, cut_.turn, at.row, at.u);
}

void Surface::across_wall(std::span<const SurfacePoint> at, std::span<Line> out) const {
  std::array<AcrossWall, kLanes> here;
  for (std::size_t k = 0; k < at.size(); ++k) here[k] = finished({at[k].row, at[k].u});
  placed(cut_, std::span(here).first(at.size()), out);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const auto& [row, u, v, land] = at[k];
    if (!land) continue;
    const double z = mixed(cut_.land[row], cut_.land[next(row)], u);
    const Vector3d edge = mixed_points(out[k].from, out[k].to, cut_.from);
    out[k] = {math::cylinder_point(cut_.inner, here[k].phi_inner, z), edge};
  }
}

Vector3d Surface::point(const SurfacePoint& at, const Line& line) const {
  return mixed_points(line.from, line.to, at.land ? at.v : share(at));
}

/// Returns the distance of a point of the axis beyond the finished line of its own row.
double Surface::beyond(const Line& finished, std::size_t row, const Vector3d& point) const {
  const Vector3d across = finished.to - finished.from;
  const Vector3d from = point - finished.from;
  const Vector3d off = from - from.dot(across) / across.squaredNorm() * across;
  const Vector3d normal = along_[row].cross(across);
  const double size = normal.norm();
  return size > 0.0 ? (cut_.part_to_the_left ? -1.0 : 1.0) * normal.dot(off) / size : 0.0;
}

}  // namespace tubecut::bevel::beam
