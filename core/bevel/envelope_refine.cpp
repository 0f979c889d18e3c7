#include <algorithm>
#include <optional>
#include <variant>
#include <vector>

#include "core/base/angle.hpp"
#include "core/bevel/envelope_parts.hpp"

namespace tubecut::bevel::detail {
namespace {

constexpr double kBare = 1e-12 * kRadPerDeg;  // rad: e within it of B counts as B's own
constexpr double kWorthwhile =
    1e-9;  // share of the area; smaller differences are the order of a sum
constexpr double kGolden = 0.6180339887498949;
constexpr int kRounds = 3;
constexpr int kNarrowings = 12;

/// Changes one start slope at a time and follows what that moves: the two curves of the node until
/// the old and the new sweep both start anew, and the rolled parabolas over them. Every write is
/// logged, so a trial can be taken back.
class LocalUpdate {
 public:
  LocalUpdate(Turn& turn, Envelope& envelope) : turn_(turn), now_(envelope) {}

  /// The area with start slope m at node j; the envelope then is that of m. Empty when the change
  /// goes round the whole turn (the envelope is then half changed: take it back).
  std::optional<double> apply(std::size_t j, double m) {
    set(turn_.leave[j], m);
    const auto left = follow(j, Sense::backward);
    const auto right = follow(j, Sense::forward);
    if (!left || !right || *left + *right + 1 >= turn_.size()) return std::nullopt;
    if (*left + *right == 0) return now_.area;
    auto first = j;
    for (std::size_t i = 0; i < *left; ++i) first = turn_.previous(first);
    auto last = first;
    for (std::size_t i = 0; i <= *left + *right; ++i, last = turn_.next(last))
      set(now_.e[last],
          std::max({turn_.b[last], now_.forward.value[last], now_.backward.value[last]}));
    if (!roll(first, turn_.previous(last), *left + *right + 1)) return std::nullopt;
    return now_.area;
  }

  void take_back() {
    for (; !log_.empty(); log_.pop_back())
      std::visit([](auto& entry) { *entry.place = entry.old; }, log_.back());
  }
  void keep() { log_.clear(); }

 private:
  template <class T>
  struct Entry {
    T* place;
    T old;
  };

  template <class T>
  void set(T& place, T value) {
    if (place == value) return;
    log_.push_back(Entry<T>{&place, place});
    place = value;
  }

  /// Nodes behind j whose sweep value changed; empty when it comes round to j.
  std::optional<std::size_t> follow(std::size_t j, Sense sense) {
    auto& old = sense == Sense::forward ? now_.forward : now_.backward;
    if (!old.restarted[j])
      return 0;  // another curve runs over j in this sense; its own start does not matter
    Braking at = start(turn_, j, sense);
    for (std::size_t count = 0; count + 1 < turn_.size(); ++count) {
      j = step(turn_, j, sense);
      at = brake(at, arriving(turn_, j, sense), turn_.limits);
      const char restarts = turn_.b[j] >= at.value;
      if (restarts && old.restarted[j]) return count;
      if (restarts) at = start(turn_, j, sense);
      set(old.restarted[j], restarts);
      set(old.value[j], at.value);
    }
    return std::nullopt;
  }

  /// Appends k to the hull. Behind its bottom the old contacts go on. False when that would go
  /// round the turn.
  bool append(std::size_t k) {
    while (true) {
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

  std::size_t gap(std::size_t i, std::size_t k) const {
    return k > i ? k - i : k + turn_.size() - i;
  }

  /// Contacts and f anew around the changed e of first..last (count nodes).
  bool roll(std::size_t first, std::size_t last, std::size_t count) {
    do first = turn_.previous(first), ++count;
    while (!now_.contact[first] && count < turn_.size());
    do last = turn_.next(last), ++count;
    while (!now_.contact[last] && count < turn_.size());
    if (count >= turn_.size()) return false;
    span_ = count;
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

  void lay() {
    double change = 0.0;
    const auto put = [&](std::size_t j, double f, char contact) {
      change += (f - now_.f[j]) * turn_.width[j];
      set(now_.f[j], f);
      set(now_.contact[j], contact);
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

  Turn& turn_;
  Envelope& now_;
  std::vector<std::variant<Entry<double>, Entry<char>, Entry<std::size_t>>> log_;
  std::vector<std::size_t> hull_;
  std::size_t span_ = 0;  // nodes between the ends of what may change
};

class CornerSearch {
 public:
  CornerSearch(Turn& turn, Envelope& envelope)
      : turn_(turn), now_(envelope), local_(turn, envelope) {}

  /// Golden section over the start slope of corner j. On a tie the left part stays: the area has
  /// flat stretches, where the last bits of a sum would choose.
  void improve(std::size_t j) {
    const double margin = kWorthwhile * now_.area;
    double from = -turn_.start_bound(j);
    double to = -from;
    if (!(to > 0.0)) return;
    double left = to - kGolden * (to - from);
    double right = from + kGolden * (to - from);
    double area_left = trial(j, left);
    double area_right = trial(j, right);
    for (int i = 0; i < kNarrowings; ++i) {
      if (area_right < area_left - margin) {
        from = left;
        left = right;
        area_left = area_right;
        right = from + kGolden * (to - from);
        area_right = trial(j, right);
      } else {
        to = right;
        right = left;
        area_right = area_left;
        left = to - kGolden * (to - from);
        area_left = trial(j, left);
      }
    }
    const bool take_right = area_right < area_left - margin;
    if ((take_right ? area_right : area_left) < now_.area - margin)
      change(j, take_right ? right : left);
  }

 private:
  double trial(std::size_t j, double m) {
    const auto area = local_.apply(j, m);
    local_.take_back();
    if (area) return *area;
    const double kept = turn_.leave[j];
    turn_.leave[j] = m;
    const double whole = make_envelope(turn_).area;
    turn_.leave[j] = kept;
    return whole;
  }

  void change(std::size_t j, double m) {
    if (local_.apply(j, m)) return local_.keep();
    local_.take_back();
    turn_.leave[j] = m;
    now_ = make_envelope(turn_);
  }

  Turn& turn_;
  Envelope& now_;
  LocalUpdate local_;
};

}  // namespace

bool refine(Turn& turn, Envelope& envelope, const std::stop_token& stop) {
  CornerSearch search(turn, envelope);
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t j = 0; j < turn.size(); ++j) {
      if (!turn.corner[j] || envelope.e[j] - turn.b[j] > kBare) continue;
      if (stop.stop_requested()) return false;
      search.improve(j);
    }
  }
  return true;
}

}  // namespace tubecut::bevel::detail
