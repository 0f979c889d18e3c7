#pragma once

#include <vector>

#include "core/bevel/smoothing/arc_cost.hpp"

namespace tubecut::bevel {

/// Minimises a quadratic over a closed path: heights f_j, the slopes v_j after them and the bends
/// u_j = v_j - v_{j-1} before those, f_{j+1} = f_j + h_j v_j. It sums, over j,
///
///     1/2 height_j f_j^2 + 1/2 slope_j v_j^2 + 1/2 bend_j u_j^2
///
/// and a linear term of each. Backwards along an arc, the cost to go stays a sum of squares, so
/// weights from 1e-300 to 1e60 and steps of any length can be mixed, because no subtraction can
/// cancel. A weight of 1e60 pins a height or a bend.
///
/// A ring is divided into one arc per lane of `Numbers`, with equally many nodes. Each lane runs
/// along its own arc; then each joins the arcs ahead, by one, two and four, until it has the whole
/// ring from its own start and knows the state there.
///
/// Cost  seven divisions a node to factor, none to solve; plus joining the arcs.
template <class Numbers>
class RingNewton {
 public:
  struct alignas(sizeof(Numbers)) Weights {
    Numbers height, slope, bend;  // bend > 0
  };
  struct alignas(sizeof(Numbers)) Terms {
    Numbers of_f, of_v, of_u;
  };

  explicit RingNewton(std::size_t nodes_of_an_arc) : nodes_(nodes_of_an_arc) {}

  /// Returns the lengths from node j of each arc to the next, >= 0; initially 0.
  [[nodiscard]] Numbers& length(std::size_t j) { return nodes_[j].h; }

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }

  /// `weights_of(j)` returns those of node j of each arc.
  template <class WeightsOf>
  TUBECUT_INLINE void factor(const WeightsOf& weights_of);

  /// Call it after `factor`, with the linear terms `terms_of(j)`. Calls `take(j, f, v, u)` with the
  /// minimiser, the first of each arc last.
  template <class TermsOf, class Take>
  TUBECUT_INLINE void solve(const TermsOf& terms_of, const Take& take);

 private:
  struct alignas(sizeof(Numbers)) Node {
    Numbers h;
    Numbers gain, from_f, from_v, from_end_f, from_end_v, kick;  // of the slope after it
  };
  static constexpr int kLanes = PackOf<Numbers>::kSize;

  /// Calls `step` with each join and the number of lanes that it reaches ahead.
  template <int reach = 1, class Step>
  TUBECUT_INLINE void each_join(const Step& step) {
    if constexpr (reach < kLanes) {
      step.template operator()<reach>(joins_[reach / 2]);
      each_join<2 * reach>(step);
    }
  }

  std::vector<Node> nodes_;
  ArcJoin<Numbers> joins_[3];
  Squares<Numbers> ends_{};  // of height and slope at the start of each arc, over the whole ring
};

template <class Numbers>
template <class WeightsOf>
void RingNewton<Numbers>::factor(const WeightsOf& weights_of) {
  auto arc = ArcCost<Numbers>::nothing();
  for (auto j = nodes_.size(); j-- > 0;) {
    Node& at = nodes_[j];
    const Weights weights = weights_of(j);
    arc.lever += at.h;
    arc.add_slope(weights.slope);
    // The slope after the node is chosen: 1/2 bend (v - v before)^2 plus the cost to go.
    const Numbers both = arc.rest + weights.bend, pull = arc.weight * arc.lever;
    const Numbers gain = 1.0 / (both + pull * arc.lever), of_both = 1.0 / both;
    at.gain = gain;
    at.from_f = pull * gain;
    at.from_v = weights.bend * gain;
    at.from_end_f = gain * (arc.rest * arc.back[0] + pull * arc.ahead[0]);
    at.from_end_v = gain * (arc.rest * arc.back[1] + pull * arc.ahead[1]);
    const Numbers share = weights.bend * of_both, lost = arc.lever * arc.rest * of_both;
    arc.weight *= both * gain;
    for (int k = 0; k < 2; ++k) arc.ahead[k] -= lost * arc.back[k];
    arc.lever *= share;
    arc.rest *= share;
    arc.add_height(weights.height);
  }
  each_join([&]<int reach>(ArcJoin<Numbers>& join) {
    ArcCost<Numbers> next{};
    next.weight = from_lane<reach>(arc.weight);
    next.lever = from_lane<reach>(arc.lever);
    next.rest = from_lane<reach>(arc.rest);
    for (int k = 0; k < 2; ++k) {
      next.ahead[k] = from_lane<reach>(arc.ahead[k]);
      next.back[k] = from_lane<reach>(arc.back[k]);
    }
    next.of_end = {from_lane<reach>(arc.of_end.weight), from_lane<reach>(arc.of_end.share),
                   from_lane<reach>(arc.of_end.rest)};
    join.join(arc, next);
  });
  arc.of_end.add(arc.weight, 1.0 + arc.ahead[0], arc.lever + arc.ahead[1]);
  arc.of_end.add(arc.rest, arc.back[0], 1.0 + arc.back[1]);
  ends_ = arc.of_end;
}

template <class Numbers>
template <class TermsOf, class Take>
void RingNewton<Numbers>::solve(const TermsOf& terms_of, const Take& take) {
  ArcPull<Numbers> arc{};
  for (auto j = nodes_.size(); j-- > 0;) {
    Node& at = nodes_[j];
    const Terms terms = terms_of(j);
    const Numbers q = arc.v + at.h * arc.f + terms.of_v + terms.of_u;
    at.kick = at.gain * q;
    arc.end_f -= q * at.from_end_f;
    arc.end_v -= q * at.from_end_v;
    arc.f += terms.of_f - at.from_f * q;
    arc.v = at.from_v * q - terms.of_u;
  }
  each_join([&]<int reach>(const ArcJoin<Numbers>& join) {
    const ArcPull<Numbers> next{from_lane<reach>(arc.f), from_lane<reach>(arc.v),
                                from_lane<reach>(arc.end_f), from_lane<reach>(arc.end_v)};
    join.join(arc, next);
  });
  const Numbers of_f = arc.end_f + arc.f, of_v = arc.end_v + arc.v;
  Numbers slope = -(of_v - ends_.share * of_f) / ends_.rest;
  Numbers height = -of_f / ends_.weight - ends_.share * slope;
  const Numbers end_f = from_lane<1>(height), end_v = from_lane<1>(slope), first_f = height;
  Numbers first_v{};
  for (std::size_t j = 0; j < nodes_.size(); ++j) {
    const Node& at = nodes_[j];
    const Numbers before = slope;
    slope = at.from_v * slope - at.from_f * height - at.from_end_f * end_f - at.from_end_v * end_v -
            at.kick;
    if (j == 0)
      first_v = slope;
    else
      take(j, height, slope, Numbers(slope - before));
    height += at.h * slope;
  }
  take(std::size_t{0}, first_f, first_v, Numbers(first_v - from_lane<kLanes - 1>(slope)));
}

}  // namespace tubecut::bevel
