#include "core/bevel/envelope_update.hpp"

#include <algorithm>
#include <limits>

namespace tubecut::bevel::detail {

std::optional<double> LocalUpdate::apply(std::size_t j, double m, bool cover) {
  j_ = j;
  const auto through = put_under(m, cover);
  if (!through) return std::numeric_limits<double>::infinity();
  if (!now_.forward.closed || !now_.backward.closed) return std::nullopt;
  const auto last = follow(*through, Sense::forward);
  const auto first = follow(*through, Sense::backward);
  if (!first || !last) return std::nullopt;
  const Range changed{-*first, *last};
  if (static_cast<std::size_t>(changed.last - changed.first) + 1 >= turn_.size())
    return std::nullopt;
  if (!lift(changed)) return std::numeric_limits<double>::infinity();
  if (!roll(changed)) return std::nullopt;
  return now_.area;
}

void LocalUpdate::take_back() {
  numbers_.take_back();
  flags_.take_back();
  links_.take_back();
}

void LocalUpdate::keep() {
  numbers_.entries.clear();
  flags_.entries.clear();
  links_.entries.clear();
}

std::size_t LocalUpdate::node(long away) const {
  const auto n = static_cast<long>(turn_.size());
  return static_cast<std::size_t>(((static_cast<long>(j_) + away) % n + n) % n);
}

std::size_t LocalUpdate::gap(std::size_t i, std::size_t k) const {
  return k > i ? k - i : k + turn_.size() - i;
}

/// The nodes below the curve of the owner, `away` from j, in one sense. False when it is half the
/// turn.
bool LocalUpdate::below(long away, Sense sense) {
  const long forward = sense == Sense::forward ? 1 : -1;
  auto i = node(away);
  Braking at = start(turn_, i, sense);
  for (std::size_t count = 0; 2 * count < turn_.size(); ++count, ++visits_) {
    i = step(turn_, i, sense);
    away += forward;
    at = brake(at, arriving(turn_, i, sense), turn_.limits);
    if (at.value <= turn_.b[i]) return true;
    below_.push_back(away);
  }
  return false;
}

/// Nodes that lay under the owner `away` from j start their own curves again.
bool LocalUpdate::release(long away, Range& range) {
  const auto owner = node(away);
  below_.clear();
  if (!below(away, Sense::forward) || !below(away, Sense::backward)) return false;
  for (const long under : below_) {
    if (turn_.under[node(under)] != owner) continue;
    set(turn_.under[node(under)], Turn::kNone);
    range = {std::min(range.first, under), std::max(range.last, under)};
  }
  set(turn_.covers[owner], char{0});
  return true;
}

/// Sets the slope; with `cover` everything below j's new curves then lies under j.
std::optional<LocalUpdate::Range> LocalUpdate::put_under(double m, bool cover) {
  Range range;
  if (cover && turn_.covers[j_] && !release(0, range)) return std::nullopt;
  set(turn_.leave[j_], m);
  if (!cover) return range;
  set(turn_.under[j_], Turn::kNone);
  below_.clear();
  if (!below(0, Sense::forward) || !below(0, Sense::backward)) return std::nullopt;
  const auto covered = below_;
  for (const long away : covered)
    if (turn_.covers[node(away)] && !release(away, range)) return std::nullopt;
  for (const long away : covered) {
    set(turn_.under[node(away)], j_);
    range = {std::min(range.first, away), std::max(range.last, away)};
  }
  set(turn_.covers[j_], char{!covered.empty()});
  return range;
}

/// The sweep anew from one end of the range to the other and on until it joins the old one; how far
/// from j that is.
std::optional<long> LocalUpdate::follow(Range through, Sense sense) {
  auto& old = sense == Sense::forward ? now_.forward : now_.backward;
  const long from = sense == Sense::forward ? through.first : -through.last;
  const long to = sense == Sense::forward ? through.last : -through.first;
  auto i = node(sense == Sense::forward ? from - 1 : 1 - from);
  Braking at{old.value[i], old.slope[i]};
  for (long away = from; away - from + 2 < static_cast<long>(turn_.size()); ++away, ++visits_) {
    i = step(turn_, i, sense);
    at = brake(at, arriving(turn_, i, sense), turn_.limits);
    const char restarts = turn_.restarts(i, at.value);
    if (restarts) at = start(turn_, i, sense);
    const bool joined =
        at.value == old.value[i] && at.slope == old.slope[i] && restarts == old.restarted[i];
    if (away > to && joined) return away - 1;
    set(old.restarted[i], restarts);
    set(old.value[i], at.value);
    set(old.slope[i], at.slope);
  }
  return std::nullopt;
}

/// e over the changed nodes; false when one of them comes to lie below its B.
bool LocalUpdate::lift(Range changed) {
  for (long away = changed.first; away <= changed.last; ++away) {
    const auto i = node(away);
    const double e = std::max(now_.forward.value[i], now_.backward.value[i]);
    if (e < turn_.b[i]) return false;
    set(now_.e[i], e);
  }
  return true;
}

/// Appends k to the hull; behind its bottom the old contacts go on. False when that would go round
/// the turn.
bool LocalUpdate::append(std::size_t k) {
  for (;; ++visits_) {
    const bool bottom = hull_.size() == 1;
    const auto i = bottom ? now_.contact_before[hull_[0]] : hull_[hull_.size() - 2];
    if (bottom && gap(i, hull_[0]) + span_ >= turn_.size()) return false;
    if (touches(turn_, now_.e, i, hull_.back(), k)) break;
    if (bottom) {
      span_ += gap(i, hull_[0]);
      hull_[0] = i;
    } else {
      hull_.pop_back();
    }
  }
  hull_.push_back(k);
  return true;
}

/// Contacts and f anew around the changed e.
bool LocalUpdate::roll(Range changed) {
  span_ = static_cast<std::size_t>(changed.last - changed.first) + 1;
  auto first = node(changed.first);
  auto last = node(changed.last);
  do first = turn_.previous(first), ++span_;
  while (!now_.contact[first] && span_ < turn_.size());
  do last = turn_.next(last), ++span_;
  while (!now_.contact[last] && span_ < turn_.size());
  if (span_ >= turn_.size()) return false;
  hull_.assign(1, first);
  for (auto k = turn_.next(first); k != last; k = turn_.next(k))
    if (!append(k)) return false;
  if (!append(last)) return false;
  for (auto k = now_.contact_after[last];
       !touches(turn_, now_.e, hull_[hull_.size() - 2], hull_.back(), k);
       k = now_.contact_after[k]) {
    span_ += gap(hull_.back(), k);
    if (span_ >= turn_.size() || !append(k)) return false;
  }
  lay();
  return true;
}

void LocalUpdate::lay() {
  double change = 0.0;
  const auto put = [&](std::size_t j, double f, char contact) {
    change += (f - now_.f[j]) * turn_.width[j];
    set(now_.f[j], f);
    set(now_.contact[j], contact);
    ++visits_;
  };
  for (std::size_t c = 0; c + 1 < hull_.size(); ++c) {
    const auto i = hull_[c];
    const auto k = hull_[c + 1];
    put(i, now_.e[i], 1);
    set(now_.contact_after[i], k);
    set(now_.contact_before[k], i);
    for (auto j = turn_.next(i); j != k; j = turn_.next(j))
      put(j, rolled(turn_, now_.e, i, j, k), 0);
  }
  set(now_.area, now_.area + change);
}

}  // namespace tubecut::bevel::detail
