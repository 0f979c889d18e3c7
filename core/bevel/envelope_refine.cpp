#include <algorithm>

#include "core/base/angle.hpp"
#include "core/bevel/envelope_update.hpp"

namespace tubecut::bevel::detail {
namespace {

constexpr double kBare = 1e-12 * kRadPerDeg;  // rad: e within it of B counts as B's own
constexpr double kWorthwhile =
    1e-9;  // share of the area; smaller differences are the order of a sum
constexpr double kGolden = 0.6180339887498949;
constexpr int kRounds = 3;
constexpr int kNarrowings = 12;
constexpr double kBend = 0.005;     // share of K
constexpr double kHidden = 0.04;    // share of K^2/A, the height of a curve that turns from K to -K
constexpr std::size_t kWork = 500;  // node visits for each node; a bound on hostile profiles
constexpr std::size_t kWholeVisits = 8;  // of each node in one whole evaluation
constexpr int kScan =
    8;  // steps of the scan that precedes the section when curves may cover other corners

struct Choice {
  double m = 0.0;
  double area = 0.0;
};

class CornerSearch {
 public:
  CornerSearch(Turn& turn, Envelope& envelope)
      : turn_(turn), now_(envelope), local_(turn, envelope) {}

  /// The best start slope of corner j by golden section. True when the area fell.
  bool improve(std::size_t j) {
    const double bound = turn_.start_bound(j);
    return bound > 0.0 && settle(j, section(j, -bound, bound, false), false);
  }

  /// Corners worth it: bent by more than numerical dust, and hidden by no more than a start slope
  /// can bring to light.
  bool may_cover(std::size_t j) const {
    if (!turn_.corner[j]) return false;
    const auto& [slope, curvature] = turn_.limits;
    const auto before = turn_.previous(j);
    const double bend = (turn_.b[j] - turn_.b[before]) / turn_.ahead[before] -
                        (turn_.b[turn_.next(j)] - turn_.b[j]) / turn_.ahead[j];
    return bend > kBend * slope && now_.e[j] - turn_.b[j] <= kHidden * slope * slope / curvature;
  }

  /// The work allowed is used up: the search stays where it is.
  bool spent() const { return local_.visits() + whole_ > kWork * turn_.size(); }

  /// The same when j's curves may take the place of all nodes below them. The area then has more
  /// than one valley.
  bool improve_covering(std::size_t j) {
    const double least = -node_bound(turn_, j, Sense::backward);
    const double most = node_bound(turn_, j, Sense::forward);
    const double pitch = (most - least) / kScan;
    Choice best{.m = least, .area = trial(j, least, true)};
    for (int i = 1; i <= kScan; ++i) {
      const double m = i == kScan ? most : least + pitch * i;
      const double area = trial(j, m, true);
      if (area < best.area - margin()) best = {m, area};
    }
    const auto near =
        section(j, std::max(best.m - pitch, least), std::min(best.m + pitch, most), true);
    if (near.area < best.area - margin()) best = near;
    return settle(j, best, true);
  }

 private:
  double margin() const { return kWorthwhile * now_.area; }

  /// On a tie the left part stays: the area has flat stretches, where the last bits of a sum would
  /// choose.
  Choice section(std::size_t j, double from, double to, bool cover) {
    const auto at = [&](double m) { return Choice{m, trial(j, m, cover)}; };
    Choice left = at(to - kGolden * (to - from));
    Choice right = at(from + kGolden * (to - from));
    for (int i = 0; i < kNarrowings; ++i) {
      if (right.area < left.area - margin()) {
        from = left.m;
        left = right;
        right = at(from + kGolden * (to - from));
      } else {
        to = right.m;
        right = left;
        left = at(to - kGolden * (to - from));
      }
    }
    return right.area < left.area - margin() ? right : left;
  }

  double trial(std::size_t j, double m, bool cover) {
    if (const auto area = local_.apply(j, m, cover)) {
      local_.take_back();
      return *area;
    }
    const double whole = make_envelope(turn_).area;
    whole_ += kWholeVisits * turn_.size();
    local_.take_back();
    return whole;
  }

  bool settle(std::size_t j, Choice best, bool cover) {
    if (!(best.area < now_.area - margin())) return false;
    if (!local_.apply(j, best.m, cover)) now_ = make_envelope(turn_);
    local_.keep();
    return true;
  }

  Turn& turn_;
  Envelope& now_;
  LocalUpdate local_;
  std::size_t whole_ = 0;  // nodes visited by whole evaluations
};

/// One search; false when stopped.
bool search_from(Turn& turn, const Envelope& envelope, CornerSearch& search, Start from,
                 const std::stop_token& stop) {
  for (int round = 0; round < kRounds && from == Start::refined; ++round) {
    for (std::size_t j = 0; j < turn.size() && !search.spent(); ++j) {
      if (!turn.corner[j] || envelope.e[j] - turn.b[j] > kBare) continue;
      if (stop.stop_requested()) return false;
      search.improve(j);
    }
  }
  bool better = true;
  for (int round = 0; round < kRounds && better; ++round) {
    better = false;
    for (std::size_t j = 0; j < turn.size() && !search.spent(); ++j) {
      if (!search.may_cover(j)) continue;
      if (stop.stop_requested()) return false;
      better |= search.improve_covering(j);
    }
  }
  return true;
}

}  // namespace

bool refine(Turn& turn, Envelope envelope, Start from, const std::stop_token& stop) {
  CornerSearch search(turn, envelope);
  return search_from(turn, envelope, search, from, stop);
}

}  // namespace tubecut::bevel::detail
