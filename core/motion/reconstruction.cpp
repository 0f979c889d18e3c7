#include "core/motion/reconstruction.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"

namespace tubecut::motion {
namespace {

constexpr std::size_t kPhi = 0, kZ = 1, kB = 2;

std::size_t index_of(const std::vector<Axis>& axes, std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(axes, name, &Axis::name) - axes.begin());
}

}  // namespace

Reconstruction::Reconstruction(const ScheduleSpec& spec)
    : x_axes(spec.machine.axes), x_sigma(spec.machine.sigma()) {
  const auto* const contour = std::get_if<Contour>(&spec.cut);
  if (contour == nullptr) {
    for (std::size_t a = 0; a < x_axes.size(); ++a) x_known[a] = true;
    return;
  }
  set_tube(*contour);
  if (const auto* const five = std::get_if<FiveAxisCutter>(&spec.machine.kinematics)) {
    x_kind = Kind::five_axis;
    x_pivot = five->pivot_length + five->standoff;
    x_roles = {index_of(x_axes, "C"),  index_of(x_axes, "Y"),  index_of(x_axes, "B"),
               index_of(x_axes, "Z1"), index_of(x_axes, "Z2"), false};
    x_roles.has_fine = x_roles.fine < x_axes.size();
  } else if (const auto* const crawler = std::get_if<Crawler>(&spec.machine.kinematics)) {
    x_kind = Kind::crawler;
    x_pivot = crawler->swing_center == SwingCenter::pivot ? crawler->pivot_length : 0.0;
    x_wheel = x_outer + crawler->wheel_offset;
    x_roles = {index_of(x_axes, "S"), index_of(x_axes, "E"), index_of(x_axes, "B"), 0, 0, false};
  } else if (const auto* const generic = std::get_if<Generic>(&spec.machine.kinematics)) {
    set_generic(*generic);
    return;
  }
  x_known[kPhi] = x_known[kZ] = x_known[kB] = true;
}

void Reconstruction::set_tube(const Contour& contour) {
  x_outer = contour.outer_radius;
  x_past = contour.outer_radius - contour.radius();
}

/// Least squares over the coordinates that any axis follows; of lower rank nothing is known.
void Reconstruction::set_generic(const Generic& generic) {
  x_kind = Kind::generic;
  const auto rows = static_cast<Eigen::Index>(generic.maps.size());
  Eigen::MatrixXd map(rows, 3);
  for (Eigen::Index a = 0; a < rows; ++a) {
    const LinearMap& m = generic.maps[static_cast<std::size_t>(a)];
    map.row(a) << m.k_phi, m.k_z, m.k_b;
  }
  std::vector<Eigen::Index> used;
  for (const Eigen::Index c : {0, 1, 2}) {
    if (map.col(c).cwiseAbs().maxCoeff() > 0.0) used.push_back(c);
  }
  const Eigen::MatrixXd part = map(Eigen::all, used);
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solved(part);
  if (solved.rank() < static_cast<Eigen::Index>(used.size())) return;
  const Eigen::MatrixXd inverse = solved.pseudoInverse();
  x_inverse.assign(generic.maps.size(), Coordinates{});
  for (std::size_t k = 0; k < used.size(); ++k) {
    const auto c = static_cast<std::size_t>(used[k]);
    x_known[c] = true;
    const double unit = c == kZ ? 1.0 : kRadPerDeg;
    for (std::size_t a = 0; a < generic.maps.size(); ++a) {
      x_inverse[a][c] = unit * inverse(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(a));
      x_origin[c] -= x_inverse[a][c] * generic.maps[a].k_0;
    }
  }
}

Coordinates Reconstruction::at(const std::vector<double>& q) const {
  Coordinates x = x_origin;
  switch (x_kind) {
    case Kind::columns:
      for (std::size_t a = 0; a < q.size(); ++a) x[a] = q[a];
      return x;
    case Kind::generic:
      for (std::size_t a = 0; a < x_inverse.size(); ++a) {
        for (std::size_t c = 0; c < 3; ++c) x[c] += x_inverse[a][c] * q[a];
      }
      return x;
    case Kind::five_axis: {
      const double b = q[x_roles.b] * kRadPerDeg;
      const double reach = x_pivot * elementary::sin(b) + x_past * elementary::tan(b);
      x[kPhi] = q[x_roles.phi] * kRadPerDeg;
      x[kZ] = q[x_roles.z] + x_sigma * reach;
      x[kB] = b;
      return x;
    }
    case Kind::crawler: {
      const double b = q[x_roles.b] * kRadPerDeg;
      x[kPhi] = q[x_roles.phi] / x_wheel;
      x[kZ] = q[x_roles.z] + x_sigma * (x_past + x_pivot) * elementary::tan(b);
      x[kB] = b;
      return x;
    }
  }
  return x;
}

std::optional<double> Reconstruction::standoff_error(const std::vector<double>& q) const {
  if (x_kind != Kind::five_axis) return std::nullopt;
  const double fine = x_roles.has_fine ? q[x_roles.fine] : 0.0;
  const double drop = x_pivot * elementary::cos(q[x_roles.b] * kRadPerDeg);
  return q[x_roles.height] + fine - x_outer - drop;
}

double Reconstruction::half_pulse(std::size_t axis) const {
  return 0.5 / x_axes[axis].pulses_per_axis_unit();
}

Coordinates Reconstruction::quantum(double largest_b) const {
  Coordinates out{};
  switch (x_kind) {
    case Kind::columns:
      for (std::size_t a = 0; a < x_axes.size(); ++a) out[a] = half_pulse(a);
      return out;
    case Kind::generic:
      for (std::size_t a = 0; a < x_inverse.size(); ++a) {
        for (std::size_t c = 0; c < 3; ++c) out[c] += std::abs(x_inverse[a][c]) * half_pulse(a);
      }
      return out;
    default:
      break;
  }
  const double cos = elementary::cos(largest_b);
  const double slope = std::max(4.0, 1.0 / (cos * cos));  // of tan B
  const double tilt =
      x_kind == Kind::five_axis ? x_pivot + slope * x_past : slope * (x_past + x_pivot);
  out[kB] = half_pulse(x_roles.b) * kRadPerDeg;
  out[kZ] = half_pulse(x_roles.z) + tilt * out[kB];
  out[kPhi] = x_kind == Kind::five_axis ? half_pulse(x_roles.phi) * kRadPerDeg
                                        : half_pulse(x_roles.phi) / x_wheel;
  return out;
}

double Reconstruction::standoff_quantum() const {
  if (x_kind != Kind::five_axis) return 0.0;
  const double fine = x_roles.has_fine ? half_pulse(x_roles.fine) : 0.0;
  return half_pulse(x_roles.height) + fine + x_pivot * half_pulse(x_roles.b) * kRadPerDeg;
}

}  // namespace tubecut::motion
