#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/bevel/envelope_parts.hpp"

namespace tubecut::bevel::detail {

/// Changes one node's start slope and follows only what that moves: the sweeps until the old and
/// the new one start anew at the same node, and the rolled parabolas over them. Gives what
/// `make_envelope` of the whole turn would give. Every write is logged, so a trial can be taken
/// back.
class LocalUpdate {
 public:
  LocalUpdate(Turn& turn, Envelope& envelope) : turn_(turn), now_(envelope) {}

  /// The area with start slope m at node j; with `cover` the nodes below j's curves are put under
  /// it. Infinite when a covered node would come to light below its B, or a curve covers half the
  /// turn; empty when the change goes round the turn: turn is then changed, the envelope must be
  /// made anew.
  std::optional<double> apply(std::size_t j, double m, bool cover);
  void take_back();
  void keep();
  /// Nodes visited since the start, the measure of work.
  [[nodiscard]] std::size_t visits() const { return visits_; }

 private:
  /// The values that writes replaced, latest last.
  template <class T>
  struct Log {
    std::vector<std::pair<T*, T>> entries;
    void set(T& place, T value) {
      if (place == value) return;
      entries.emplace_back(&place, place);
      place = value;
    }
    void take_back() {
      for (; !entries.empty(); entries.pop_back()) *entries.back().first = entries.back().second;
    }
  };
  /// Nodes counted from the node that is changed.
  struct Range {
    long first = 0;
    long last = 0;
  };

  void set(double& place, double value) { numbers_.set(place, value); }
  void set(char& place, char value) { flags_.set(place, value); }
  void set(std::size_t& place, std::size_t value) { links_.set(place, value); }
  [[nodiscard]] std::size_t node(long away) const;
  [[nodiscard]] std::size_t gap(std::size_t i, std::size_t k) const;
  bool below(long away, Sense sense);
  bool release(long away, Range& range);
  std::optional<Range> put_under(double m, bool cover);
  std::optional<long> follow(Range through, Sense sense);
  bool lift(Range changed);
  bool append(std::size_t k);
  bool roll(Range changed);
  void lay();

  Turn& turn_;
  Envelope& now_;
  std::size_t j_ = 0;
  Log<double> numbers_;
  Log<char> flags_;
  Log<std::size_t> links_;
  std::vector<long> below_;
  std::vector<std::size_t> hull_;
  std::size_t span_ = 0;  // nodes between the ends of what may change
  std::size_t visits_ = 0;
};

}  // namespace tubecut::bevel::detail
