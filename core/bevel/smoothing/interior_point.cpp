#include "core/bevel/smoothing/interior_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/lanes.hpp"
#include "core/base/stop.hpp"
#include "core/bevel/smoothing/least_area.hpp"
#include "core/bevel/smoothing/ring_newton.hpp"

namespace tubecut::bevel {
namespace {

using Array = Eigen::ArrayXd;
using Eigen::Index;

constexpr int kMostSteps = 80;  // 36 are the most seen, on 20 000 hostile profiles
constexpr double kGap = 1e-12;  // of the area: its maximum distance to the bound by the multipliers
constexpr double kNear = 1e-5;  // the same; below it the multipliers may be the best
constexpr double kSmall = 1e-3;   // smaller areas count as this: 1e-3 spacings times the range of B
constexpr double kStart = 0.1;    // of the range of B: height of the start above it
constexpr double kNarrow = 0.05;  // minimum initial room below the limit
constexpr double kPinned = 1e60;  // weight of such a height, and of a bend without a node
constexpr double kKeptShare = 0.99;  // fraction of the path to the next limit, at least
constexpr double kLost =
    100.0;  // of that path: only arcs computed without valid digits lead that far

/// The inequalities; each group has one slack per node.
enum Group : std::size_t {
  above_b,
  rising,
  falling,
  bending_up,
  bending_down,
  below_limit,
  groups
};

/// A slack s and its multiplier y.
template <class Numbers>
struct alignas(sizeof(Numbers)) Slack {
  Numbers s, y, inverse;  // 1/s
  Numbers dy;             // the step of y; before that, its right-hand side
};

/// In each lane a node of its arc. The last arc is padded with nodes of zero length, at which
/// nothing bends and no slack is small.
template <class Numbers>
struct alignas(sizeof(Numbers)) NodePack {
  Numbers w{}, x{}, v{};      // weight in the area, height above B, slope
  Numbers df{}, dv{}, du{};   // the step: of height, slope and bend
  Numbers lack{};             // of f <= highest: the excess of the slack
  Numbers pinned{}, stiff{};  // minimum weights of the height and of the bend
  std::array<Slack<Numbers>, groups> of;
};

template <class Numbers>
class InteriorPoint {
 public:
  /// `limited`: includes the groups of f <= highest.
  InteriorPoint(const Programme& p, bool limited);

  /// Returns false when cancelled or not converged.
  [[nodiscard]] bool solve();

  /// Returns heights in rad, each the one before plus its slope, at least B.
  [[nodiscard]] Array heights() const;
  /// Returns the multipliers of the best bound so far, because rounding spoils later ones when
  /// slacks become small.
  [[nodiscard]] const Multipliers& multipliers() const { return best_; }

  /// Makes Mehrotra's step: the step to the optimum itself determines the target product and the
  /// correction. The first one touches all memory and may take 20 ms for 20 000 nodes if pages are
  /// slow, so cancellation is checked within a step too. If cancelled, nobody reads the result.
  TUBECUT_INLINE void step();

 private:
  static constexpr int kArcs = PackOf<Numbers>::kSize;

  void begin();
  void pin();
  TUBECUT_INLINE void measured(const Numbers& area, const Numbers& gap, const Numbers& lack);
  void keep_best();
  [[nodiscard]] Array contacts() const;

  TUBECUT_INLINE void factor();
  TUBECUT_INLINE double aim();
  TUBECUT_INLINE void aim_at(double product);
  TUBECUT_INLINE void go(double kept);

  TUBECUT_INLINE static Numbers ratio(const Slack<Numbers>& slack) {
    return slack.y * slack.inverse;
  }
  /// Calls `each` with each slack of a pack and its step.
  template <class Each>
  TUBECUT_INLINE void each_slack(NodePack<Numbers>& at, const Numbers& df, const Numbers& dv,
                                 const Numbers& du, const Each& each) const {
    each(at.of[above_b], df);
    each(at.of[rising], Numbers(-dv));
    each(at.of[falling], dv);
    each(at.of[bending_up], Numbers(-du));
    each(at.of[bending_down], du);
    if (limited_) each(at.of[below_limit], Numbers(-df - at.lack));
  }

  /// Calls `each` with every node, its pack and its lane there.
  template <class Each>
  void each_node(const Each& each) const {
    Index j = 0;
    for (int k = 0; k < kArcs; ++k)
      for (std::size_t i = 0; i < packs_.size() && j < p_.size(); ++i) each(j++, i, k);
  }
  /// Returns the value of `of` for each pack, by nodes.
  template <class Of>
  [[nodiscard]] Array by_nodes(const Of& of) const {
    Array out(p_.size());
    each_node([&](Index j, std::size_t i, int k) {
      out[j] = static_cast<double>(lane(of(packs_[i]), k));
    });
    return out;
  }
  [[nodiscard]] Array multipliers_of(Group g) const {
    return by_nodes([&](const auto& at) -> const auto& { return at.of[g].y; });
  }
  [[nodiscard]] Array net(Group up, Group down) const {
    return multipliers_of(up) - multipliers_of(down);
  }

  const Programme& p_;
  bool limited_, pins_ = false;
  std::size_t groups_ = limited_ ? groups : below_limit;
  RingNewton<Numbers> newton_;
  std::vector<NodePack<Numbers>> packs_;
  double area_ = 0.0, gap_ = 0.0, lack_ = 0.0;
  double far_ = 0.0,
         far_dual_ = 0.0;  // length of the step as a fraction of the path to the next limit
  Multipliers best_;
  double bound_ = -std::numeric_limits<double>::infinity();
};

template <class Numbers>
InteriorPoint<Numbers>::InteriorPoint(const Programme& p, bool limited)
    : p_(p),
      limited_(limited),
      newton_(static_cast<std::size_t>((p.size() + kArcs - 1) / kArcs)),
      packs_(newton_.size()) {}

/// Starts at a constant above B, with multipliers that balance exactly.
template <class Numbers>
void InteriorPoint<Numbers>::begin() {
  constexpr double kWide = 1e60;
  for (auto& at : packs_) {
    at.stiff += kPinned;
    for (auto& slack : at.of) slack.s = Numbers{} + kWide;
  }
  const double top = p_.b.maxCoeff();
  const double level = limited_ ? 0.5 * (top + std::min(p_.highest, top + 1.0)) : top + kStart;
  const double product = kStart * (p_.w * (level - p_.b)).mean();
  each_node([&](Index j, std::size_t i, int k) {
    auto& at = packs_[i];
    const double x = level - p_.b[j], room = p_.highest - p_.b[j];
    const double curvature = p_.curvature * p_.w[j], below = std::max(room - x, kNarrow);
    set_lane(newton_.length(i), k, p_.h[j]);
    set_lane(at.w, k, p_.w[j]);
    set_lane(at.x, k, x);
    set_lane(at.stiff, k, 0.0);
    if (limited_) set_lane(at.lack, k, x + below - room);
    const double slacks[groups] = {x, p_.slope, p_.slope, curvature, curvature, below};
    for (std::size_t g = 0; g < groups; ++g) set_lane(at.of[g].s, k, slacks[g]);
  });
  for (auto& at : packs_)
    for (auto& slack : at.of) slack.y = product / slack.s;
  each_node([&](Index j, std::size_t i, int k) { set_lane(packs_[i].of[above_b].y, k, p_.w[j]); });
  if (limited_) pin();
  Numbers area{}, gap{}, lack{};
  for (const auto& at : packs_) {
    area += at.w * at.x;
    for (std::size_t g = 0; g < groups_; ++g) gap += at.of[g].s * at.of[g].y;
    lack = larger(lack, at.lack);
  }
  measured(area, gap, lack);
}

/// If B is at the limit, the height has no room, so its two slacks leave the programme.
template <class Numbers>
void InteriorPoint<Numbers>::pin() {
  each_node([&](Index j, std::size_t i, int k) {
    auto& at = packs_[i];
    set_lane(at.of[above_b].y, k, lane(at.of[above_b].y, k) + lane(at.of[below_limit].y, k));
    if (!p_.no_room(j)) return;
    pins_ = true;
    set_lane(at.pinned, k, kPinned);
    for (Numbers* none : {&at.x, &at.lack}) set_lane(*none, k, 0.0);
    for (const auto group : {above_b, below_limit}) {
      set_lane(at.of[group].s, k, 1.0);
      set_lane(at.of[group].y, k, 1e-300);
    }
  });
}

template <class Numbers>
void InteriorPoint<Numbers>::measured(const Numbers& area, const Numbers& gap,
                                      const Numbers& lack) {
  area_ = static_cast<double>(sum_of(area));
  gap_ = static_cast<double>(sum_of(gap));
  lack_ = static_cast<double>(largest_of(lack));
}

template <class Numbers>
void InteriorPoint<Numbers>::factor() {
  newton_.factor([&](std::size_t j) {
    auto& at = packs_[j];
    for (std::size_t g = 0; g < groups_; ++g) at.of[g].inverse = 1.0 / at.of[g].s;
    typename RingNewton<Numbers>::Weights out{
        ratio(at.of[above_b]), ratio(at.of[rising]) + ratio(at.of[falling]),
        ratio(at.of[bending_up]) + ratio(at.of[bending_down])};
    if (limited_) out.height = larger(Numbers(out.height + ratio(at.of[below_limit])), at.pinned);
    out.bend = larger(out.bend, at.stiff);
    return out;
  });
}

/// Returns the target for the product of slack and multiplier, from the step to the optimum: the
/// smaller the products after that step, the smaller the target. Leaves the step's contribution to
/// the products in `dy`.
template <class Numbers>
double InteriorPoint<Numbers>::aim() {
  Numbers near{}, near_dual{}, by_slacks{}, by_both{};
  const auto optimum = [&](std::size_t j) {
    const auto& at = packs_[j];
    typename RingNewton<Numbers>::Terms out{at.w, Numbers{}, Numbers{}};
    if (limited_) out.of_f += ratio(at.of[below_limit]) * at.lack;
    return out;
  };
  newton_.solve(optimum,
                [&](std::size_t j, const Numbers& df, const Numbers& dv, const Numbers& du) {
                  each_slack(packs_[j], df, dv, du, [&](Slack<Numbers>& slack, const Numbers& ds) {
                    const Numbers share = ds * slack.inverse;
                    slack.dy = ds * (-slack.y - slack.y * share);
                    near = larger(near, Numbers(-share));
                    near_dual = larger(near_dual, share);  // -dy / y = 1 + ds / s
                    by_slacks += slack.y * ds;
                    by_both += slack.dy;
                  });
                });
  const double over = static_cast<double>(largest_of(near));
  const double way = over > 1.0 ? 1.0 / over : 1.0;
  const double way_dual = 1.0 / (1.0 + static_cast<double>(largest_of(near_dual)));
  const double moved = static_cast<double>(sum_of(by_slacks));  // and by multipliers -gap - it
  const double after = gap_ + way * moved - way_dual * (gap_ + moved) +
                       way * way_dual * static_cast<double>(sum_of(by_both));
  const double share = std::max(after, 0.0) / gap_;
  const auto slacks = packs_.size() * groups_ * kArcs;
  return share * share * share * gap_ / static_cast<double>(slacks);
}

/// Finds the step to equal products, less the contribution that `aim` found.
template <class Numbers>
void InteriorPoint<Numbers>::aim_at(double product) {
  Numbers near{}, near_dual{};
  const auto terms = [&](std::size_t j) {
    auto& at = packs_[j];
    for (std::size_t g = 0; g < groups_; ++g)
      at.of[g].dy = (at.of[g].dy - product) * at.of[g].inverse;
    typename RingNewton<Numbers>::Terms out{at.w + at.of[above_b].dy,
                                            at.of[falling].dy - at.of[rising].dy,
                                            at.of[bending_down].dy - at.of[bending_up].dy};
    if (limited_) out.of_f += ratio(at.of[below_limit]) * at.lack - at.of[below_limit].dy;
    return out;
  };
  newton_.solve(terms, [&](std::size_t j, const Numbers& df, const Numbers& dv, const Numbers& du) {
    auto& at = packs_[j];
    at.df = df;
    at.dv = dv;
    at.du = du;
    each_slack(at, df, dv, du, [&](Slack<Numbers>& slack, const Numbers& ds) {
      const Numbers share = ds * slack.inverse;
      slack.dy = -slack.y - slack.dy - slack.y * share;
      near = larger(near, Numbers(-share));
      near_dual = larger(near_dual, Numbers(-slack.dy / slack.y));
    });
  });
  far_ = static_cast<double>(largest_of(near));
  far_dual_ = static_cast<double>(largest_of(near_dual));
}

/// Makes the step, at most the fraction `kept` of the path to the next limit.
template <class Numbers>
void InteriorPoint<Numbers>::go(double kept) {
  const double length = far_ > kept ? kept / far_ : 1.0;
  const double length_dual = far_dual_ > kept ? kept / far_dual_ : 1.0;
  Numbers area{}, gap{}, lack{};
  for (auto& at : packs_) {
    at.x += length * at.df;
    at.v += length * at.dv;
    area += at.w * at.x;
    each_slack(at, at.df, at.dv, at.du, [&](Slack<Numbers>& slack, const Numbers& ds) {
      slack.s += length * ds;
      slack.y += length_dual * slack.dy;
      gap += slack.s * slack.y;
    });
    at.lack *= 1.0 - length;
    lack = larger(lack, at.lack);
  }
  measured(area, gap, lack);
}

template <class Numbers>
void InteriorPoint<Numbers>::step() {
  factor();
  if (stopped()) return;
  aim_at(aim());
  if (stopped()) return;
  go(std::max(kKeptShare, 1.0 - gap_ / area_));
}

TUBECUT_WIDE TUBECUT_WHOLE void step(InteriorPoint<Pack>& point) { point.step(); }
template <class Real>
void step(InteriorPoint<Real>& point) {
  point.step();
}

template <class Numbers>
bool InteriorPoint<Numbers>::solve() {
  if (stopped()) return false;
  begin();
  for (int i = 0; i < kMostSteps && !stopped(); ++i) {
    if (!std::isfinite(gap_)) return false;
    if (gap_ <= kNear * (area_ + kSmall)) keep_best();
    if (gap_ <= kGap * (area_ + kSmall) && lack_ <= kGap) return true;
    bevel::step(*this);
    if (kArcs > 1 && std::max(far_, far_dual_) > kLost) return false;
  }
  return false;
}

template <class Numbers>
void InteriorPoint<Numbers>::keep_best() {
  auto now = p_.multipliers(contacts(), net(rising, falling));
  const double bound = least_area(p_.profile, p_.spec, now, area_ * p_.unit * p_.pitch);
  if (!(bound > bound_)) return;
  bound_ = bound;
  best_ = std::move(now);
}

template <class Numbers>
Array InteriorPoint<Numbers>::heights() const {
  const Index n = p_.size();
  // The rounding error of closing is spread over all steps. In the profile's own unit, each height
  // is rounded once.
  double open = 0.0;
  const Array v = by_nodes([](const auto& at) -> const auto& { return at.v; });
  for (Index j = 0; j < n; ++j) open += p_.h[j] * v[j];
  const double tilt = open / static_cast<double>(n);
  Array f(n);
  double height = (static_cast<double>(lane(packs_[0].x, 0)) + p_.b[0]) * p_.unit;
  for (Index j = 0; j < n; ++j) {
    f[j] = height;
    height += p_.h[j] * (v[j] - tilt) * p_.unit;
  }
  f += std::max(0.0, (p_.b * p_.unit - f).maxCoeff());
  return f;
}

template <class Numbers>
Array InteriorPoint<Numbers>::contacts() const {
  if (!limited_) return multipliers_of(above_b);
  Array out = net(above_b, below_limit);
  if (pins_) p_.set_pinned(out, net(rising, falling), net(bending_up, bending_down));
  return out;
}

}  // namespace

template <class Numbers>
std::optional<Least> interior_point(const Programme& programme, bool limited) {
  InteriorPoint<Numbers> point(programme, limited);
  if (!point.solve()) return std::nullopt;
  return Least{point.heights(), point.multipliers()};
}
template std::optional<Least> interior_point<Pack>(const Programme&, bool);
template std::optional<Least> interior_point<double>(const Programme&, bool);
template std::optional<Least> interior_point<long double>(const Programme&, bool);

}  // namespace tubecut::bevel
