#include "core/motion/replay/reconstruction.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/motion/path/upright.hpp"

namespace tubecut::motion {
namespace {

constexpr std::size_t kPhiAxis = 0, kZ = 1, kB = 2, kX = 3, kY = 4;

std::size_t index_of(const std::vector<Axis>& axes, std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(axes, name, &Axis::name) - axes.begin());
}

double distance(const TipPoint& a, const TipPoint& b) {
  double square = 0.0;
  for (std::size_t c = 0; c < a.size(); ++c) square += (a[c] - b[c]) * (a[c] - b[c]);
  return std::sqrt(square);
}

/// Returns the fraction 0..1 from `a` to `b` that is nearest to `p`.
double foot(const TipPoint& p, const TipPoint& a, const TipPoint& b) {
  double along = 0.0, square = 0.0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    along += (p[c] - a[c]) * (b[c] - a[c]);
    square += (b[c] - a[c]) * (b[c] - a[c]);
  }
  return square > 0.0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
}

TipPoint between(const TipPoint& a, const TipPoint& b, double share) {
  TipPoint out{};
  for (std::size_t c = 0; c < a.size(); ++c) out[c] = a[c] + share * (b[c] - a[c]);
  return out;
}

}  // namespace

AxisValues::AxisValues(const Counted& counted, const Machine& machine)
    : counted_(counted), q_(counted.start) {
  for (const Axis& axis : machine.axes) {
    const std::size_t a = pulses_.size();
    pulses_.push_back(axis.pulses_per_axis_unit());
    sum_.push_back(counted.pulses_before(a));
    if (sum_[a] != 0) q_[a] += static_cast<double>(sum_[a]) / pulses_[a];
  }
}

void AxisValues::step(std::size_t period) {
  for (std::size_t a = 0; a < q_.size(); ++a) {
    if (counted_.counts[a].empty()) continue;
    sum_[a] += counted_.counts[a][period];
    q_[a] = counted_.start[a] + static_cast<double>(sum_[a]) / pulses_[a];
  }
}

Reconstruction::Reconstruction(const ScheduleSpec& spec)
    : axes_(spec.machine.axes), sigma_(spec.machine.sigma()) {
  const auto* const cut_path = std::get_if<CutPath>(&spec.cut);
  if (cut_path == nullptr) {
    for (std::size_t a = 0; a < axes_.size(); ++a) known_[a] = true;
    return;
  }
  set_tube(*cut_path);
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
  } else if (const auto* const table = std::get_if<TubeTable>(&spec.machine.kinematics)) {
    set_table(*table);
  } else if (const auto* const generic = std::get_if<Generic>(&spec.machine.kinematics)) {
    set_generic(*generic);
    return;
  }
  known_[kPhiAxis] = known_[kZ] = known_[kB] = true;
}

void Reconstruction::set_tube(const CutPath& cut_path) {
  outer_ = cut_path.outer_radius;
  past_ = cut_path.outer_radius - cut_path.radius();
  section_ = cut_path.section;
}

void Reconstruction::set_table(const TubeTable& table) {
  kind_ = Kind::table;
  pivot_ = table.pivot_length + table.standoff;
  roles_ = {.phi = index_of(axes_, "A"),
            .z = index_of(axes_, "Y"),
            .b = index_of(axes_, "B"),
            .height = index_of(axes_, "Z"),
            .across = index_of(axes_, "X")};
  roles_.has_b = roles_.b < axes_.size();
  known_[kX] = known_[kY] = section_.has_value();
}

/// Solves least squares over the coordinates that any axis follows. If the rank is too low, no
/// coordinate is determined.
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
      x[kPhiAxis] = q[roles_.phi] * kRadPerDeg;
      x[kZ] = q[roles_.z] + sigma_ * reach;
      x[kB] = b;
      return x;
    }
    case Kind::crawler: {
      const double b = q[roles_.b] * kRadPerDeg;
      x[kPhiAxis] = q[roles_.phi] / wheel_;
      x[kZ] = q[roles_.z] + sigma_ * (past_ + pivot_) * elementary::tan(b);
      x[kB] = b;
      return x;
    }
    case Kind::table:
      return at_table(q);
  }
  return x;
}

/// Undoes the swing, then the turn: the tip is where the torch stands over the turned tube.
Coordinates Reconstruction::at_table(const std::vector<double>& q) const {
  const double b = roles_.has_b ? q[roles_.b] * kRadPerDeg : 0.0;
  const double above = q[roles_.height] - pivot_ * elementary::cos(b);
  const double across = q[roles_.across];
  const double up = -q[roles_.phi] * kRadPerDeg;
  Coordinates x = origin_;
  x[kPhiAxis] = section_ ? up : up + elementary::atan2(across, above);
  x[kZ] = q[roles_.z] + sigma_ * (pivot_ * elementary::sin(b) + past_ * elementary::tan(b));
  x[kB] = b;
  if (!section_) return x;
  const auto [sin, cos] = elementary::sincos(up);
  x[kX] = above * cos - across * sin;
  x[kY] = above * sin + across * cos;
  return x;
}

std::optional<double> Reconstruction::standoff_error(const std::vector<double>& q) const {
  if (kind_ == Kind::table) {
    const Coordinates x = at_table(q);
    if (section_) return beyond_outside(*section_, {x[kX], x[kY]});
    const double b = x[kB];
    return elementary::hypot(q[roles_.height] - pivot_ * elementary::cos(b), q[roles_.across]) -
           outer_;
  }
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
    case Kind::table:
    case Kind::five_axis:
    case Kind::crawler:
      break;
  }
  const double cos = elementary::cos(largest_b);
  const double slope = std::max(4.0, 1.0 / (cos * cos));  // of tan B
  if (kind_ == Kind::table) return table_quantum(slope);
  const double tilt = kind_ == Kind::five_axis ? pivot_ + slope * past_ : slope * (past_ + pivot_);
  out[kB] = half_pulse(roles_.b) * kRadPerDeg;
  out[kZ] = half_pulse(roles_.z) + tilt * out[kB];
  out[kPhiAxis] = kind_ == Kind::five_axis ? half_pulse(roles_.phi) * kRadPerDeg
                                           : half_pulse(roles_.phi) / wheel_;
  return out;
}

Coordinates Reconstruction::table_quantum(double slope) const {
  Coordinates out{};
  const double turn = half_pulse(roles_.phi) * kRadPerDeg, across = half_pulse(roles_.across);
  out[kB] = roles_.has_b ? half_pulse(roles_.b) * kRadPerDeg : 0.0;
  out[kZ] = half_pulse(roles_.z) + (pivot_ + slope * past_) * out[kB];
  out[kPhiAxis] = section_ ? turn : turn + across / outer_;
  if (section_) out[kX] = out[kY] = standoff_quantum();
  return out;
}

double Reconstruction::standoff_quantum() const {
  if (kind_ == Kind::table) {
    const double swing = roles_.has_b ? pivot_ * half_pulse(roles_.b) * kRadPerDeg : 0.0;
    const double reach = section_ ? section_->reach() : 0.0;
    return half_pulse(roles_.height) + half_pulse(roles_.across) + swing +
           reach * half_pulse(roles_.phi) * kRadPerDeg;
  }
  if (kind_ != Kind::five_axis) return 0.0;
  const double fine = roles_.has_fine ? half_pulse(roles_.fine) : 0.0;
  return half_pulse(roles_.height) + fine + pivot_ * half_pulse(roles_.b) * kRadPerDeg;
}

Follower::Follower(const Program& program, const std::vector<bool>& part, double allowed,
                   double moved)
    : program_(program),
      missed_(program.size(), 1e300),
      allowed_(allowed),
      window_(allowed + moved) {
  for (std::size_t c = 0; c < program.coordinates.size(); ++c) {
    if (part[c]) tip_coordinates_.push_back(c);
  }
  points_.reserve(program.size());
  at_.reserve(program.size());
  for (std::size_t i = 0; i < program.size() && !stops(i); ++i) {
    Coordinates x{};
    for (std::size_t c = 0; c < program.x.size(); ++c) x[c] = program.x[c][i];
    points_.push_back(tip_of(x));
    at_.push_back(i == 0 ? 0.0 : at_.back() + distance(points_[i - 1], points_[i]));
  }
}

TipPoint Follower::tip_of(const Coordinates& x) const {
  TipPoint out{};
  for (const std::size_t c : tip_coordinates_) out[c] = program_.coordinates[c].weight * x[c];
  return out;
}

Follower::Found Follower::nearest_on(std::size_t i, const TipPoint& tip) const {
  const double share = foot(tip, points_[i], points_[i + 1]);
  const double off = distance(tip, between(points_[i], points_[i + 1], share));
  return {off, at_[i] + share * (at_[i + 1] - at_[i]), i};
}

Follower::Found Follower::follow(const TipPoint& tip) {
  Found best{1e300, last_at_, low_};
  // Not farther than the tip can have moved, because a small loop comes back within the window.
  const double moved = started_ ? 2.0 * distance(last_, tip) : window_;
  const double reach = std::min(allowed_ + moved, window_);
  for (std::size_t i = low_; i + 1 < points_.size(); ++i) {
    if (at_[i] > last_at_ + reach) break;
    if (at_[i + 1] < last_at_ - reach) continue;
    const Found next = nearest_on(i, tip);
    if (next.distance < best.distance) best = next;
  }
  last_at_ = best.at;
  while (low_ > 0 && at_[low_] > best.at - window_) --low_;
  while (low_ + 2 < points_.size() && at_[low_ + 1] < best.at - window_) ++low_;
  reach_points(started_ ? last_ : tip, tip, best.at);
  last_ = tip;
  started_ = true;
  return best;
}

void Follower::reach_points(const TipPoint& from, const TipPoint& to, double at) {
  while (near_ > 0 && at_[near_ - 1] >= at - window_) --near_;
  while (near_ < points_.size() && at_[near_] < at - window_) ++near_;
  for (std::size_t i = near_; i < points_.size() && at_[i] <= at + window_; ++i) {
    const TipPoint nearest = between(from, to, foot(points_[i], from, to));
    missed_[i] = std::min(missed_[i], distance(points_[i], nearest));
  }
}

std::pair<double, double> Follower::range(std::size_t c, double at, double reach) const {
  const std::vector<double>& x = program_.x[c];
  const double from = at - reach, to = at + reach;
  std::pair<double, double> out{1e300, -1e300};
  const auto see = [&out](double value) {
    out = {std::min(out.first, value), std::max(out.second, value)};
  };
  const auto first = std::ranges::lower_bound(at_, from) - at_.begin();
  for (auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(first, 1)); i < x.size(); ++i) {
    if (at_[i - 1] > to) break;
    const double length = at_[i] - at_[i - 1];
    const auto at_share = [&](double s) {
      const double share = length > 0.0 ? std::clamp((s - at_[i - 1]) / length, 0.0, 1.0) : 0.0;
      return x[i - 1] + share * (x[i] - x[i - 1]);
    };
    see(at_share(from));
    see(length > 0.0 ? at_share(to) : x[i]);
  }
  return out;
}

double Follower::farthest_missed() const { return *std::ranges::max_element(missed_); }

}  // namespace tubecut::motion
