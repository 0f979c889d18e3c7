#include "core/bevel/interior_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/bevel/least_area.hpp"
#include "core/bevel/ring_newton.hpp"

namespace tubecut::bevel {
namespace {

using Array = Eigen::ArrayXd;
using Eigen::Index;

constexpr int kMostSteps = 80;     // 36 are the most seen, on 20 000 hostile profiles
constexpr double kGap = 1e-12;     // of the area, between it and what the multipliers prove
constexpr double kNear = 1e-5;     // the same, from where on the multipliers may be the best
constexpr double kSmall = 1e-3;    // an area that counts as one: 1e-3 spacings times the range of B
constexpr double kStart = 0.1;     // of the range of B: how far above it the search begins
constexpr double kNarrow = 0.05;   // least room below the limit to begin with
constexpr double kNoRoom = 1e-12;  // between B and the limit: the height is that of B
constexpr double kPinned = 1e60;   // weight of such a height
constexpr double kLong = 1e-3;     // of the mean spacing: long enough to divide by
constexpr double kKept = 0.99;     // share of the way to the next limit, at least

/// The inequalities, a slack of every node in each group.
enum Group : Index { above_b, rising, falling, bending_up, bending_down, below_limit, groups };

std::vector<double> vector_of(const Array& a) { return {a.begin(), a.end()}; }

/// In an order of its own, so that no width of lanes changes a bit.
double inner(const Array& a, const Array& b) {
  double part[4] = {};
  const Index whole = a.size() - a.size() % 4;
  for (Index j = 0; j < whole; j += 4)
    for (Index k = 0; k < 4; ++k) part[k] += a[j + k] * b[j + k];
  for (Index j = whole; j < a.size(); ++j) part[j - whole] += a[j] * b[j];
  return (part[0] + part[1]) + (part[2] + part[3]);
}

template <class Real>
class InteriorPoint {
  [[nodiscard]] auto of(Array& a, Group g) const { return a.segment(g * p_.size(), p_.size()); }
  [[nodiscard]] auto of(const Array& a, Group g) const {
    return a.segment(g * p_.size(), p_.size());
  }

 public:
  /// `limited`: with the groups of f <= highest.
  InteriorPoint(const Programme& p, bool limited);

  /// False when stopped or not converged.
  [[nodiscard]] bool solve(const std::stop_token& stop);

  /// Heights in rad, each the one before plus its slope, none below B.
  [[nodiscard]] Array heights() const;
  /// The multipliers that proved most on the way: rounding spoils them where slacks grow small.
  [[nodiscard]] const Multipliers& multipliers() const { return best_; }

 private:
  void begin();
  void pin();
  void factor();
  void find_step(const Array& shift);
  void step(const std::stop_token& stop);
  void keep_best();
  [[nodiscard]] Array contacts() const;
  void contacts_of_pinned(Array& out) const;
  [[nodiscard]] Array slopes() const { return of(y_, rising) - of(y_, falling); }

  const Programme& p_;
  bool limited_;
  RingNewton<Real> newton_;
  Array x_, v_;              // heights above B, slopes
  Array s_, y_;              // slacks and their multipliers
  Array lack_, pinned_;      // of f <= highest: what the slack is too large by; weight of a height
  Array inverse_, ratio_;    // 1/s, y/s
  Array df_, dv_, ds_, dy_;  // the step
  Array of_f_, of_v_, of_u_, height_, slope_, bend_, shift_;
  double area_ = 0.0, gap_ = 0.0;
  Multipliers best_;
  double bound_ = -std::numeric_limits<double>::infinity();
};

template <class Real>
InteriorPoint<Real>::InteriorPoint(const Programme& p, bool limited)
    : p_(p), limited_(limited), newton_(p.h) {
  const Index n = p.size(), all = (limited ? groups : below_limit) * n;
  for (Array* a : {&v_, &lack_, &pinned_}) a->setZero(n);
  for (Array* a : {&x_, &df_, &dv_, &of_f_, &of_v_, &of_u_, &height_, &slope_, &bend_})
    a->resize(n);
  for (Array* a : {&s_, &y_, &inverse_, &ratio_, &ds_, &dy_, &shift_}) a->resize(all);
  begin();
}

/// A constant above B, with multipliers that balance exactly.
template <class Real>
void InteriorPoint<Real>::begin() {
  const double top = p_.b.maxCoeff();
  x_ = (limited_ ? 0.5 * (top + std::min(p_.highest, top + 1.0)) : top + kStart) - p_.b;
  of(s_, above_b) = x_;
  of(s_, rising).setConstant(p_.slope);
  of(s_, falling).setConstant(p_.slope);
  of(s_, bending_up) = p_.curvature * p_.w;
  of(s_, bending_down) = p_.curvature * p_.w;
  if (limited_) {
    const Array room = p_.highest - p_.b;
    of(s_, below_limit) = (room - x_).max(kNarrow);
    lack_ = x_ + of(s_, below_limit) - room;
  }
  y_ = kStart * inner(p_.w, x_) / static_cast<double>(p_.size()) / s_;
  of(y_, above_b) = p_.w;
  if (limited_) pin();
}

/// Where B is at the limit the height has no room, so its two slacks leave the programme.
template <class Real>
void InteriorPoint<Real>::pin() {
  of(y_, above_b) += of(y_, below_limit);
  for (Index j = 0; j < p_.size(); ++j) {
    if (p_.highest - p_.b[j] > kNoRoom) continue;
    pinned_[j] = kPinned;
    x_[j] = lack_[j] = 0.0;
    for (const auto group : {above_b, below_limit}) {
      of(s_, group)[j] = 1.0;
      of(y_, group)[j] = 1e-300;
    }
  }
}

template <class Real>
void InteriorPoint<Real>::factor() {
  inverse_ = 1.0 / s_;
  ratio_ = y_ * inverse_;
  height_ = of(ratio_, above_b);
  if (limited_) height_ = (height_ + of(ratio_, below_limit)).max(pinned_);
  slope_ = of(ratio_, rising) + of(ratio_, falling);
  bend_ = of(ratio_, bending_up) + of(ratio_, bending_down);
  newton_.factor(height_, slope_, bend_);
}

/// The step of heights, slopes and slacks for slacks times multipliers that shift by s * `shift`.
template <class Real>
void InteriorPoint<Real>::find_step(const Array& shift) {
  const Index n = p_.size();
  of_f_ = p_.w + of(shift, above_b);
  if (limited_) of_f_ += of(ratio_, below_limit) * lack_ - of(shift, below_limit);
  of_v_ = of(shift, falling) - of(shift, rising);
  of_u_ = of(shift, bending_down) - of(shift, bending_up);
  newton_.solve(of_f_, of_v_, of_u_, df_, dv_);
  of(ds_, above_b) = df_;
  of(ds_, rising) = -dv_;
  of(ds_, falling) = dv_;
  auto bend = of(ds_, bending_down);
  bend[0] = dv_[0] - dv_[n - 1];
  bend.tail(n - 1) = dv_.tail(n - 1) - dv_.head(n - 1);
  of(ds_, bending_up) = -bend;
  if (limited_) of(ds_, below_limit) = -df_ - lack_;
  dy_ = -y_ - shift - ratio_ * ds_;
}

/// Mehrotra: the step to the optimum itself tells how far to aim, and what its product adds. The
/// first one touches all memory: where pages are slow to come by, 20 ms for 20 000 nodes, so that
/// it is asked within a step too. What a stopped one leaves is not looked at.
template <class Real>
void InteriorPoint<Real>::step(const std::stop_token& stop) {
  factor();
  if (stop.stop_requested()) return;
  shift_.setZero();
  find_step(shift_);
  if (stop.stop_requested()) return;
  const double over = -(ds_ * inverse_).minCoeff();
  const double over_dual = -(dy_ / y_).minCoeff();
  const double way = over > 1.0 ? 1.0 / over : 1.0;
  const double way_dual = over_dual > 1.0 ? 1.0 / over_dual : 1.0;
  const double after = inner(s_ + way * ds_, y_ + way_dual * dy_);
  const double share = after / gap_;
  const double aim = share * share * share * gap_ / static_cast<double>(s_.size());
  shift_ = (ds_ * dy_ - aim) * inverse_;
  find_step(shift_);
  const double kept = std::max(kKept, 1.0 - gap_ / area_);
  const double far = -(ds_ * inverse_).minCoeff(), far_dual = -(dy_ / y_).minCoeff();
  const double length = far > kept ? kept / far : 1.0;
  const double length_dual = far_dual > kept ? kept / far_dual : 1.0;
  x_ += length * df_;
  v_ += length * dv_;
  s_ += length * ds_;
  y_ += length_dual * dy_;
  lack_ *= 1.0 - length;
}

template <class Real>
bool InteriorPoint<Real>::solve(const std::stop_token& stop) {
  for (int i = 0; i < kMostSteps && !stop.stop_requested(); ++i) {
    area_ = inner(p_.w, x_);
    gap_ = inner(s_, y_);
    if (!std::isfinite(gap_)) return false;
    if (gap_ <= kNear * (area_ + kSmall)) keep_best();
    if (gap_ <= kGap * (area_ + kSmall) && lack_.maxCoeff() <= kGap) return true;
    step(stop);
  }
  return false;
}

/// Between nodes that keep B nothing is borne, so no rounding of theirs may add up: their contacts
/// are their weights, and each stretch of others balances by itself, by the contacts at its ends.
void balance_stretches(const Programme& p, Multipliers& m) {
  const Index n = p.size();
  const auto kept = [&](Index j) { return p.keeps[static_cast<std::size_t>(j)] != 0; };
  const auto contact = [&](Index j) -> double& { return m.contact[static_cast<std::size_t>(j)]; };
  const auto slope = [&](Index j) -> double& { return m.slope[static_cast<std::size_t>(j)]; };
  for (Index j = 0; j < n; ++j) {
    if (kept(j)) contact(j) = p.w[j];
    if (kept(j) && kept(p.next(j))) slope(j) = 0.0;
  }
  for (Index before = 0; before < n; ++before) {
    if (!kept(before) || kept(p.next(before))) continue;
    double force = 0.0, moment = -slope(before), length = p.h[before];
    Index j = p.next(before);
    for (; !kept(j); j = p.next(j)) {
      force += p.w[j] - contact(j);
      moment += p.h[j] * force - slope(j);
      length += p.h[j];
    }
    contact(before) += moment / length;
    contact(j) += force - moment / length;
  }
}

template <class Real>
void InteriorPoint<Real>::keep_best() {
  Multipliers now{vector_of(contacts()), vector_of(slopes())};
  balance_stretches(p_, now);
  now = p_.of_profile(std::move(now));
  const double bound = least_area(p_.profile, p_.spec, now, area_ * p_.unit * p_.pitch);
  if (!(bound > bound_)) return;
  bound_ = bound;
  best_ = std::move(now);
}

template <class Real>
Array InteriorPoint<Real>::heights() const {
  const Index n = p_.size();
  // What rounding leaves open at the end is laid over all steps. In the profile's own unit: each
  // height is rounded once.
  double open = 0.0;
  for (Index j = 0; j < n; ++j) open += p_.h[j] * v_[j];
  const double tilt = open / static_cast<double>(n);
  Array f(n);
  double height = (x_[0] + p_.b[0]) * p_.unit;
  for (Index j = 0; j < n; ++j) {
    f[j] = height;
    height += p_.h[j] * (v_[j] - tilt) * p_.unit;
  }
  f += std::max(0.0, (p_.b * p_.unit - f).maxCoeff());
  return f;
}

template <class Real>
Array InteriorPoint<Real>::contacts() const {
  Array out = of(y_, above_b);
  if (limited_) {
    out -= of(y_, below_limit);
    if (pinned_.maxCoeff() > 0.0) contacts_of_pinned(out);
  }
  return out;
}

/// What a pinned height bears follows from the forces either side. Over a step too short to divide
/// by they are known but for a part that both its ends share: the last pinned height of such a
/// stretch takes what the forces at its long ends leave for it.
template <class Real>
void InteriorPoint<Real>::contacts_of_pinned(Array& out) const {
  const Index n = p_.size();
  const auto net = [&](Group up, Group down, Index j) { return of(y_, up)[j] - of(y_, down)[j]; };
  const auto shear = [&](Index j) {
    return (net(rising, falling, j) + net(bending_up, bending_down, j) -
            net(bending_up, bending_down, p_.next(j))) /
           p_.h[j];
  };
  Index from = 0;
  while (p_.h[p_.previous(from)] < kLong) ++from;  // half of the longest two steps is long
  for (Index seen = 0; seen < n;) {
    double before = shear(p_.previous(from)), left = before;
    Index last = -1, j = from;
    for (;; j = p_.next(j)) {
      const double after = shear(j);
      left += p_.w[j];
      if (pinned_[j] > 0.0) {
        out[j] = p_.w[j] + before - after;
        last = j;
      }
      left -= out[j];
      before = after;
      ++seen;
      if (p_.h[j] >= kLong) break;
    }
    if (last >= 0) out[last] += left - shear(j);
    from = p_.next(j);
  }
}

}  // namespace

template <class Real>
std::optional<Least> interior_point(const Programme& programme, bool limited,
                                    const std::stop_token& stop) {
  InteriorPoint<Real> point(programme, limited);
  if (!point.solve(stop)) return std::nullopt;
  return Least{point.heights(), point.multipliers()};
}
template std::optional<Least> interior_point<double>(const Programme&, bool,
                                                     const std::stop_token&);
template std::optional<Least> interior_point<long double>(const Programme&, bool,
                                                          const std::stop_token&);

}  // namespace tubecut::bevel
