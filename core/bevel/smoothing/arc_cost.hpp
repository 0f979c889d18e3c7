#pragma once

#include "core/base/pack.hpp"

namespace tubecut::bevel {

/// weight/2 (x + share y)^2 + rest/2 y^2, a quadratic in two unknowns that only grows, so additions
/// never cancel.
template <class Numbers>
struct alignas(sizeof(Numbers)) Squares {
  Numbers weight, share, rest;

  /// Adds q/2 (of_x x + of_y y)^2, q >= 0.
  TUBECUT_INLINE void add(const Numbers& q, const Numbers& of_x, const Numbers& of_y) {
    const Numbers by = q * of_x, sum = weight + by * of_x;
    const auto some = sum > 0.0;
    const Numbers off = of_y - of_x * share, inverse = 1.0 / sum;
    rest += some ? q * weight * inverse * off * off : q * of_y * of_y;
    share = some ? (weight * share + by * of_y) * inverse : share;
    weight = sum;
  }
};

/// The minimum cost of an arc of the ring, as a function of its first height f and slope v, and of
/// its last ones, `end`:
///
///     1/2 weight (f + lever v + ahead . end)^2 + 1/2 rest (v + back . end)^2 + of_end
// Like the others, an aggregate initialised with {}, because clang 16 omits a constructor that
// functions for several lanes call.
template <class Numbers>
struct alignas(sizeof(Numbers)) ArcCost {
  static constexpr double kPinned = 1e100;  // weight of quantities that cannot differ

  Numbers weight, lever, rest;
  Numbers ahead[2], back[2];
  Squares<Numbers> of_end;

  /// Returns an arc without a node: its end equals its start.
  TUBECUT_INLINE static ArcCost nothing() {
    ArcCost out{};
    out.weight += kPinned;
    out.rest += kPinned;
    out.ahead[0] -= 1.0;
    out.back[1] -= 1.0;
    return out;
  }

  /// Adds 1/2 w v^2.
  TUBECUT_INLINE void add_slope(const Numbers& w) {
    const Numbers sum = rest + w, share = rest / sum;
    of_end.add(share * w, back[0], back[1]);
    for (Numbers& b : back) b *= share;
    rest = sum;
  }

  /// Adds 1/2 w f^2.
  TUBECUT_INLINE void add_height(const Numbers& w) {
    const Numbers sum = weight + w, share = weight / sum;
    const Numbers left = share * w;  // weight of (lever v + ahead . end)^2
    const Numbers by_lever = left * lever, more = rest + by_lever * lever;
    const auto some = more > 0.0;
    const Numbers inverse = 1.0 / more;
    of_end.add(some ? left * rest * inverse : left, some ? lever * back[0] - ahead[0] : ahead[0],
               some ? lever * back[1] - ahead[1] : ahead[1]);
    for (int k = 0; k < 2; ++k)
      back[k] = some ? (rest * back[k] + by_lever * ahead[k]) * inverse : back[k];
    rest = more;
    lever *= share;
    for (Numbers& a : ahead) a *= share;
    weight = sum;
  }
};

/// The linear terms of an arc's cost.
template <class Numbers>
struct alignas(sizeof(Numbers)) ArcPull {
  Numbers f, v, end_f, end_v;
};

/// Joins an arc to the next one: the state between them minimises the cost.
template <class Numbers>
class ArcJoin {
 public:
  /// Extends `arc` by `next`.
  TUBECUT_INLINE void join(ArcCost<Numbers>& arc, const ArcCost<Numbers>& next) {
    const Numbers none{}, once = none + 1.0;
    f_between_ = {next.weight, {once, next.lever, none, none, next.ahead[0], next.ahead[1]}};
    v_between_ = {next.rest, {none, once, none, none, next.back[0], next.back[1]}};
    Squares<Numbers> of_end = next.of_end;
    const auto& own = arc.of_end;
    for (Row row : {Row{own.weight, {once, own.share, none, none, none, none}},
                    Row{own.rest, {none, once, none, none, none, none}}}) {
      take(row);
      of_end.add(row.weight, row.of[end_f], row.of[end_v]);
    }
    Row first{arc.weight, {arc.ahead[0], arc.ahead[1], once, arc.lever, none, none}};
    Row rest{arc.rest, {arc.back[0], arc.back[1], none, once, none, none}};
    take(first);
    take(rest);
    rotate<f>(first, rest);
    const Numbers slope = rest.of[v], weight = rest.weight * slope * slope;
    const auto some = weight > 0.0;
    of_end.add(some ? none : rest.weight, rest.of[end_f], rest.of[end_v]);
    arc.weight = first.weight;
    arc.lever = first.of[v];
    arc.rest = weight;
    for (int k = 0; k < 2; ++k) {
      arc.ahead[k] = first.of[end_f + k];
      arc.back[k] = some ? rest.of[end_f + k] / slope : none;
    }
    arc.of_end = of_end;
  }

  /// Updates the linear terms of the arc that `join` extended.
  TUBECUT_INLINE void join(ArcPull<Numbers>& arc, const ArcPull<Numbers>& next) const {
    const Numbers by_f = arc.end_f + next.f;
    const Numbers by_v = arc.end_v + next.v - f_between_.of[between_v] * by_f;
    arc.f -= f_between_.of[f] * by_f + v_between_.of[f] * by_v;
    arc.v -= f_between_.of[v] * by_f + v_between_.of[v] * by_v;
    arc.end_f = next.end_f - (f_between_.of[end_f] * by_f + v_between_.of[end_f] * by_v);
    arc.end_v = next.end_v - (f_between_.of[end_v] * by_f + v_between_.of[end_v] * by_v);
  }

 private:
  /// 1/2 weight (of the state between, at the beginning and at the end)^2.
  enum : int { between_f, between_v, f, v, end_f, end_v };
  struct alignas(sizeof(Numbers)) Row {
    Numbers weight;
    Numbers of[6];
  };

  /// Rotates two rows so that the pivot's column vanishes in `other`; their sum of squares is
  /// unchanged.
  template <int column>
  TUBECUT_INLINE static void rotate(Row& pivot, Row& other) {
    const Numbers by = other.of[column], more = other.weight * by;
    const Numbers sum = pivot.weight + more * by, inverse = 1.0 / sum;
    const auto some = sum > 0.0;
    const Numbers keep = some ? pivot.weight * inverse : Numbers{} + 1.0;
    const Numbers take = some ? more * inverse : Numbers{};
    for (int k = column + 1; k < 6; ++k) {
      const Numbers was = pivot.of[k];
      pivot.of[k] = keep * was + take * other.of[k];
      other.of[k] -= by * was;
    }
    other.weight *= keep;
    pivot.weight = sum;
  }

  /// Eliminates the state between from a row.
  TUBECUT_INLINE void take(Row& row) {
    rotate<between_f>(f_between_, row);
    rotate<between_v>(v_between_, row);
  }

  Row f_between_{}, v_between_{};
};

}  // namespace tubecut::bevel
