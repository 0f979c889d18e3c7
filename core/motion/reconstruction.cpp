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
    : axes_(spec.machine.axes), sigma_(spec.machine.sigma()) {
  const auto* const contour = std::get_if<Contour>(&spec.cut);
  if (contour == nullptr) {
    for (std::size_t a = 0; a < axes_.size(); ++a) known_[a] = true;
    return;
  }
  set_tube(*contour);
  if (const auto* const five = std::get_if<FiveAxisCutter>(&spec.machine.kinematics)) {
    kind_ = Kind::five_axis;
    pivot_ = five->pivot_length + five->standoff;
    roles_ = {index_of(axes_, "C"),  index_of(axes_, "Y"),  index_of(axes_, "B"),
              index_of(axes_, "Z1"), index_of(axes_, "Z2"), false};
    roles_.has_fine = roles_.fine < axes_.size();
  } else if (const auto* const crawler = std::get_if<Crawler>(&spec.machine.kinematics)) {
    kind_ = Kind::crawler;
    pivot_ = crawler->swing_center == SwingCenter::pivot ? crawler->pivot_length : 0.0;
    wheel_ = outer_ + crawler->wheel_offset;
    roles_ = {index_of(axes_, "S"), index_of(axes_, "E"), index_of(axes_, "B"), 0, 0, false};
  } else if (const auto* const generic = std::get_if<Generic>(&spec.machine.kinematics)) {
    set_generic(*generic);
    return;
  }
  known_[kPhi] = known_[kZ] = known_[kB] = true;
}

void Reconstruction::set_tube(const Contour& contour) {
  outer_ = contour.outer_radius;
  past_ = contour.outer_radius - contour.radius();
}

/// Least squares over the coordinates that any axis follows; of lower rank nothing is known.
void Reconstruction::set_generic(const Generic& generic) {
  kind_ = Kind::generic;
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
  inverse_.assign(generic.maps.size(), Coordinates{});
  for (std::size_t k = 0; k < used.size(); ++k) {
    const auto c = static_cast<std::size_t>(used[k]);
    known_[c] = true;
    const double unit = c == kZ ? 1.0 : kRadPerDeg;
    for (std::size_t a = 0; a < generic.maps.size(); ++a) {
      inverse_[a][c] = unit * inverse(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(a));
      origin_[c] -= inverse_[a][c] * generic.maps[a].k_0;
    }
  }
}

Coordinates Reconstruction::at(const std::vector<double>& q) const {
  Coordinates x = origin_;
  switch (kind_) {
    case Kind::columns:
      for (std::size_t a = 0; a < q.size(); ++a) x[a] = q[a];
      return x;
    case Kind::generic:
      for (std::size_t a = 0; a < inverse_.size(); ++a) {
        for (std::size_t c = 0; c < 3; ++c) x[c] += inverse_[a][c] * q[a];
      }
      return x;
    case Kind::five_axis: {
      const double b = q[roles_.b] * kRadPerDeg;
      const double reach = pivot_ * elementary::sin(b) + past_ * elementary::tan(b);
      x[kPhi] = q[roles_.phi] * kRadPerDeg;
      x[kZ] = q[roles_.z] + sigma_ * reach;
      x[kB] = b;
      return x;
    }
    case Kind::crawler: {
      const double b = q[roles_.b] * kRadPerDeg;
      x[kPhi] = q[roles_.phi] / wheel_;
      x[kZ] = q[roles_.z] + sigma_ * (past_ + pivot_) * elementary::tan(b);
      x[kB] = b;
      return x;
    }
  }
  return x;
}

std::optional<double> Reconstruction::standoff_error(const std::vector<double>& q) const {
  if (kind_ != Kind::five_axis) return std::nullopt;
  const double fine = roles_.has_fine ? q[roles_.fine] : 0.0;
  const double drop = pivot_ * elementary::cos(q[roles_.b] * kRadPerDeg);
  return q[roles_.height] + fine - outer_ - drop;
}

double Reconstruction::half_pulse(std::size_t axis) const {
  return 0.5 / axes_[axis].pulses_per_axis_unit();
}

Coordinates Reconstruction::quantum(double largest_b) const {
  Coordinates out{};
  switch (kind_) {
    case Kind::columns:
      for (std::size_t a = 0; a < axes_.size(); ++a) out[a] = half_pulse(a);
      return out;
    case Kind::generic:
      for (std::size_t a = 0; a < inverse_.size(); ++a) {
        for (std::size_t c = 0; c < 3; ++c) out[c] += std::abs(inverse_[a][c]) * half_pulse(a);
      }
      return out;
    default:
      break;
  }
  const double cos = elementary::cos(largest_b);
  const double slope = std::max(4.0, 1.0 / (cos * cos));  // of tan B
  const double tilt = kind_ == Kind::five_axis ? pivot_ + slope * past_ : slope * (past_ + pivot_);
  out[kB] = half_pulse(roles_.b) * kRadPerDeg;
  out[kZ] = half_pulse(roles_.z) + tilt * out[kB];
  out[kPhi] = kind_ == Kind::five_axis ? half_pulse(roles_.phi) * kRadPerDeg
                                       : half_pulse(roles_.phi) / wheel_;
  return out;
}

double Reconstruction::standoff_quantum() const {
  if (kind_ != Kind::five_axis) return 0.0;
  const double fine = roles_.has_fine ? half_pulse(roles_.fine) : 0.0;
  return half_pulse(roles_.height) + fine + pivot_ * half_pulse(roles_.b) * kRadPerDeg;
}

}  // namespace tubecut::motion
