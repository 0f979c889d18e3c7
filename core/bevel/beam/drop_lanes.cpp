#include "core/bevel/beam/drop_lanes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/angle.hpp"
#include "core/base/lanes.hpp"
#include "core/base/pack.hpp"
#include "core/base/stop.hpp"

namespace tubecut::bevel::drop {
namespace {

constexpr std::size_t kLanes = 8;
constexpr double kSpread = 4.0;        // reaches: maximum spread of the axes in one group,
constexpr double kWidest = 0.5 * kPi;  // and its absolute maximum
constexpr int kHalves = 40;            // if the iteration would not converge
constexpr double kBetween =
    1e-4;  // of half the kerf, above the values on three circles: then there is more between them
constexpr double kSwing = 2e-2;  // likewise, if lines lean differently

using Eight = std::array<double, kLanes>;

/// One group of axes for the loops; the last axis fills the missing entries.
struct alignas(64) Group {
  Eight phi, sine, cosine, foot, slope, secant, drop;
};

/// The position of a row relative to each axis.
struct alignas(64) Seen {
  Eight phase, sine, cosine;
};

/// The search on one interval of one circle.
struct alignas(64) Search {
  Eight first, last, x, ahead, angle, cosine;
};

/// A circle's numbers.
struct Round {
  double rho, half, inner, limit, reach;
  int rounds, halvings;
};

/// Of an interval: the height at its start, and its derivative by the phase.
struct Rise {
  double low, rate;
};

/// Computes asin, up to a sine of kSeries: 1e-12.
inline double arc_sine(double s) {
  const double q = s * s;
  constexpr double c3 = 1.0 / 6, c5 = 3.0 / 40, c7 = 5.0 / 112, c9 = 35.0 / 1152;
  constexpr double c11 = 63.0 / 2816, c13 = 231.0 / 13312, c15 = 143.0 / 10240;
  return s + s * q * (c3 + q * (c5 + q * (c7 + q * (c9 + q * (c11 + q * (c13 + q * c15))))));
}

/// Computes the beam's range on the interval, and the point that a plane of its slope would require
/// most at.
TUBECUT_INLINE void begin(const Round& c, const Rise& s, const Group& axis, const Seen& from,
                          const Seen& to, Search& out, std::size_t n) {
  const double pull = s.rate / c.rho, square = pull * pull;
  for (std::size_t l = 0; l < n; ++l) {
    const double first = from.phase[l] > -c.reach ? c.rho * from.sine[l] : -c.limit;
    const double last = to.phase[l] < c.reach ? c.rho * to.sine[l] : c.limit;
    const double x = -c.half * pull / std::sqrt(axis.secant[l] * axis.secant[l] + square);
    const double below = x < last ? x : last;
    out.first[l] = first;
    out.last[l] = last;
    out.x[l] = below > first ? below : first;
  }
}

/// The requirement of the surface along a circle is a concave function of the angle around the
/// beam: it is largest where the surface's own slope equals the beam's.
TUBECUT_INLINE void refine(const Round& c, const Rise& s, const Group& axis, Search& out,
                           std::size_t n) {
  for (std::size_t l = 0; l < n; ++l) {
    const double at = out.x[l];
    const double pull = (s.rate + at * axis.slope[l]) / std::sqrt((c.rho - at) * (c.rho + at));
    const double x = -c.half * pull / std::sqrt(axis.secant[l] * axis.secant[l] + pull * pull);
    const double below = x < out.last[l] ? x : out.last[l];
    out.x[l] = below > out.first[l] ? below : out.first[l];
  }
}

/// The same by bisection.
TUBECUT_INLINE void halve(const Round& c, const Rise& s, const Group& axis, Search& out,
                          std::size_t n) {
  for (int k = 0; k < kHalves; ++k)
    for (std::size_t l = 0; l < n; ++l) {
      const double x = 0.5 * (out.first[l] + out.last[l]);
      const double ahead = std::sqrt(std::abs((c.rho - x) * (c.rho + x)));
      const double round = std::sqrt(std::abs((c.half - x) * (c.half + x)));
      const bool grows = -(s.rate + x * axis.slope[l]) * round - axis.secant[l] * x * ahead > 0.0;
      out.first[l] = grows ? x : out.first[l];
      out.last[l] = grows ? out.last[l] : x;
      out.x[l] = x;
    }
}

/// Computes angles around the tube from their sines.
TUBECUT_INLINE void angles(const Round& c, Search& out, std::size_t n) {
  for (std::size_t l = 0; l < n; ++l) {
    out.ahead[l] = std::sqrt(std::abs((c.rho - out.x[l]) * (c.rho + out.x[l])));
    out.angle[l] = out.x[l] / c.rho;
    out.cosine[l] = out.ahead[l] / c.rho;
  }
  double times = 1.0;
  for (int k = 0; k < c.halvings; ++k, times *= 2.0)
    for (std::size_t l = 0; l < n; ++l) {
      const double twice = std::sqrt(2.0 * (1.0 + out.cosine[l]));
      out.angle[l] = out.angle[l] / twice;
      out.cosine[l] = 0.5 * twice;
    }
  for (std::size_t l = 0; l < n; ++l) out.angle[l] = times * arc_sine(out.angle[l]);
}

/// Computes the drop that is required between two rows.
TUBECUT_INLINE void search(const Round& c, const Rise& s, const Seen& from, const Seen& to,
                           Group& axis, std::size_t n) {
  Search at{};
  begin(c, s, axis, from, to, at, n);
  for (int k = 0; k < c.rounds; ++k) refine(c, s, axis, at, n);
  if (c.rounds == 0) halve(c, s, axis, at, n);
  angles(c, at, n);
  for (std::size_t l = 0; l < n; ++l) {
    const double round = std::sqrt(std::abs((c.half - at.x[l]) * (c.half + at.x[l])));
    const double z = s.low + s.rate * (at.angle[l] - from.phase[l]);
    const double asked =
        axis.foot[l] + (at.ahead[l] - c.inner) * axis.slope[l] - z + axis.secant[l] * round;
    const bool counts =
        (from.phase[l] <= c.reach) & (to.phase[l] >= -c.reach) & (asked > axis.drop[l]);
    axis.drop[l] = counts ? asked : axis.drop[l];
  }
}

/// Computes the drop that is required at a row, and its derivatives just before and after the row;
/// > 0 means that it grows there. If the row is out of reach, the sign points to the axis.
TUBECUT_INLINE void see_node(const Round& c, double z, double rate_before, double rate_after,
                             const Seen& row, Group& axis, Eight& before, Eight& after,
                             std::size_t n) {
  for (std::size_t l = 0; l < n; ++l) {
    const double x = c.rho * row.sine[l], ahead = c.rho * row.cosine[l];
    const double square = (c.half - x) * (c.half + x), phase = row.phase[l];
    const double round = std::sqrt(square > 0.0 ? square : 0.0);
    const double asked =
        axis.foot[l] + (ahead - c.inner) * axis.slope[l] - z + axis.secant[l] * round;
    const double turn = x * axis.slope[l], pull = axis.secant[l] * x * ahead;
    const double out = phase <= -c.reach ? 1.0 : phase >= c.reach ? -1.0 : 0.0;
    const bool counts = (out == 0.0) & (asked > axis.drop[l]);
    axis.drop[l] = counts ? asked : axis.drop[l];
    before[l] = out == 0.0 ? -(rate_before + turn) * round - pull : out;
    after[l] = out == 0.0 ? -(rate_after + turn) * round - pull : out;
  }
}

/// Computes the drop that a circle requires on its intervals between rows. The maximum is at a row,
/// or in an interval at whose start it grows and at whose end it falls.
TUBECUT_WIDE void pass_circle(const Round& circle, const double* z, const double* rate,
                              const std::size_t* row, const Seen* seen, std::size_t rows,
                              Group& axis, std::size_t packs) {
  const std::size_t n = kLanes * packs;
  const auto c = circle;
  alignas(64) Eight before{}, after{}, next{};
  see_node(c, z[row[0]], 0.0, rate[row[0]], seen[0], axis, before, after, n);
  for (std::size_t k = 1; k < rows; ++k) {
    const double rises = rate[row[k - 1]];
    see_node(c, z[row[k]], rises, rate[row[k]], seen[k], axis, before, next, n);
    double most = 0.0;
    for (std::size_t l = 0; l < kLanes; ++l)
      most = (after[l] > 0.0) & (before[l] < 0.0) ? 1.0 : most;
    if (most > 0.0) search(c, {z[row[k - 1]], rises}, seen[k - 1], seen[k], axis, n);
    after = next;
  }
}

TUBECUT_WIDE void see_row(double phi, double sine, double cosine, const Group& axis, Seen& out,
                          std::size_t packs) {
  const std::size_t n = kLanes * packs;
  for (std::size_t l = 0; l < n; ++l) {
    out.phase[l] = phi - axis.phi[l];
    out.sine[l] = sine * axis.cosine[l] - cosine * axis.sine[l];
    out.cosine[l] = cosine * axis.cosine[l] + sine * axis.sine[l];
  }
}

/// Finished lines across the wall, contiguous in memory.
struct LineRun {
  const double *sine, *cosine, *foot, *slope;
  std::size_t size;
  double low, high, half, inner;
};

/// Computes the drop that finished lines across the wall require within it. If the axis leans more
/// than the line, the maximum is where the line nearly leaves the beam: the sum of a rising line
/// and the beam's circle, which has a closed form.
TUBECUT_WIDE void pass_lines(const LineRun& lines, Group& axis, std::size_t packs) {
  const std::size_t n = kLanes * packs;
  const auto m = lines;
  alignas(64) Eight sin{}, cos{}, lean{};
  for (std::size_t k = 0; k < m.size; ++k) {
    const double sine = m.sine[k], cosine = m.cosine[k], foot = m.foot[k], slope = m.slope[k];
    for (std::size_t l = 0; l < n; ++l) {
      sin[l] = sine * axis.cosine[l] - cosine * axis.sine[l];
      cos[l] = cosine * axis.cosine[l] + sine * axis.sine[l];
      lean[l] = axis.slope[l] * cos[l] - slope;
    }
    double most = lean[0];
    for (std::size_t l = 1; l < kLanes; ++l) most = lean[l] > most ? lean[l] : most;
    if (!(most > 0.0)) continue;
    for (std::size_t l = 0; l < n; ++l) {
      const double side = std::abs(sin[l]), leans = lean[l], falls = axis.secant[l] * side;
      const double share = m.half / std::sqrt(leans * leans + falls * falls);
      const double rho = share * leans / side;
      const double asked = axis.foot[l] + (rho * cos[l] - m.inner) * axis.slope[l] - foot -
                           (rho - m.inner) * slope + axis.secant[l] * share * falls;
      const bool counts = (leans > 0.0) & (side > 0.0) & (cos[l] > 0.0) & (rho > m.low) &
                          (rho < m.high) & (asked > axis.drop[l]);
      axis.drop[l] = counts ? asked : axis.drop[l];
    }
  }
}

/// The rows by a number that continues over laps.
class Laps {
 public:
  explicit Laps(const Finished& f) : f_(f), n_(static_cast<std::ptrdiff_t>(f.phi.size())) {}
  struct At {
    std::size_t row;
    double turn;
  };
  [[nodiscard]] At at(std::ptrdiff_t k) const {
    double turn = 0.0;
    for (; k < 0; k += n_) turn -= kTwoPi;
    for (; k >= n_; k -= n_) turn += kTwoPi;
    return {static_cast<std::size_t>(k), turn};
  }
  [[nodiscard]] double phase(std::ptrdiff_t k) const {
    const auto [row, turn] = at(k);
    return f_.phi[row] + turn;
  }

 private:
  const Finished& f_;
  std::ptrdiff_t n_;
};

/// A group of axes and the phases between which they and all rows in their reach are.
class DropSearch {
 public:
  DropSearch(const Finished& f, std::size_t lanes) : f_(f), laps_(f), n_(lanes) {}

  /// Takes axes from `i` on; returns the first that remains.
  [[nodiscard]] std::size_t take(const Axes& axes, std::size_t i) {
    const double reach = f_.circles.front().reach;
    const double spread = std::min(kWidest, kSpread * reach);
    std::size_t end = i + 1;
    while (end < axes.phi.size() && end - i < kLanes && axes.phi[end] >= axes.phi[i] &&
           axes.phi[end] - axes.phi[i] <= spread)
      ++end;
    for (std::size_t l = 0; l < kLanes; ++l) {
      const auto at = std::min(i + l, end - 1);
      group_.phi[l] = axes.phi[at];
      group_.sine[l] = axes.sine[at];
      group_.cosine[l] = axes.cosine[at];
      group_.foot[l] = axes.foot[at];
      group_.slope[l] = axes.slope[at];
      group_.secant[l] = axes.secant[at];
      group_.drop[l] = f_.half * axes.secant[at];  // to its own line
    }
    row_ = static_cast<std::ptrdiff_t>(axes.row[i]);
    from_ = axes.phi[i] - reach;
    to_ = axes.phi[end - 1] + reach;
    return end;
  }

  [[nodiscard]] const Eight& drops() const { return group_.drop; }

  void past_circles() {
    auto k = row_;
    while (laps_.phase(k) > from_) --k;
    while (laps_.phase(k + 1) < from_) ++k;
    rows_.clear();
    for (bool more = true; more; ++k) {
      const auto [row, turn] = laps_.at(k);
      const double phi = f_.phi[row] + turn;
      if (seen_.size() == rows_.size()) seen_.emplace_back();
      see_row(phi, f_.sine[row], f_.cosine[row], group_, seen_[rows_.size()], n_);
      rows_.push_back(row);
      more = phi <= to_;
    }
    std::array<Eight, 3> last{};
    const Eight own = group_.drop;
    Eight most = own;
    for (std::size_t i = 0; i < f_.circles.size(); ++i) {
      group_.drop = own;
      pass(f_.circles[i]);
      for (std::size_t l = 0; l < kLanes; ++l) most[l] = std::max(most[l], group_.drop[l]);
      last[(i + 3 - f_.circles.size() % 3) % 3] = group_.drop;
    }
    group_.drop = most;
    if (f_.between.empty()) return;
    double swing = 0.0;
    for (const auto row : rows_) swing += f_.swing[row];
    if (!(swing > kSwing * f_.half) && !is_most_between(last[0], last[2], last[1])) return;
    for (const auto& circle : f_.between) pass(circle);
  }

  void past_lines(const Lines& band) {
    for (const double turn : {0.0, -kTwoPi, kTwoPi}) {
      const double from = from_ - turn, to = to_ - turn;
      if (to < band.phi.front() || from > band.phi.back()) continue;
      const auto first = std::ranges::lower_bound(band.phi, from);
      const auto end = std::ranges::upper_bound(first, band.phi.end(), to);
      const auto k = first - band.phi.begin();
      pass_lines({.sine = band.sine.data() + k,
                  .cosine = band.cosine.data() + k,
                  .foot = band.foot.data() + k,
                  .slope = band.slope.data() + k,
                  .size = static_cast<std::size_t>(end - first),
                  .low = band.low,
                  .high = band.high,
                  .half = f_.half,
                  .inner = f_.inner},
                 group_, n_);
    }
  }

 private:
  void pass(const Circle& c) {
    pass_circle({c.rho, f_.half, f_.inner, c.limit, c.reach, c.rounds, c.halvings}, c.z.data(),
                c.rate.data(), rows_.data(), seen_.data(), rows_.size(), group_, n_);
  }

  /// Returns true if the parabola through the requirements on three circles is higher between them.
  [[nodiscard]] bool is_most_between(const Eight& inner, const Eight& middle,
                                     const Eight& outer) const {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const double bend = 2.0 * middle[l] - inner[l] - outer[l], rise = outer[l] - inner[l];
      if (!(std::abs(rise) < 2.0 * bend)) continue;
      const double highest = middle[l] + 0.125 * rise * rise / bend;
      if (highest > std::max({inner[l], middle[l], outer[l]}) + kBetween * f_.half) return true;
    }
    return false;
  }

  const Finished& f_;
  Laps laps_;
  std::size_t n_;
  Group group_{};
  std::vector<std::size_t> rows_;  // in reach
  std::vector<Seen> seen_;         // at least as many
  std::ptrdiff_t row_ = 0;
  double from_ = 0.0, to_ = 0.0;
};

}  // namespace

void Axes::resize(std::size_t n) {
  row.resize(n);
  for (auto* column : {&phi, &sine, &cosine, &foot, &slope, &secant}) column->resize(n);
}

void least(const Finished& finished, const Axes& axes, std::span<double> out) {
  DropSearch drop_search(finished, 1);
  for (std::size_t i = 0; i < axes.phi.size() && !stopped();) {
    const auto end = drop_search.take(axes, i);
    drop_search.past_circles();
    for (const auto& band : finished.bands) drop_search.past_lines(band);
    for (std::size_t l = 0; i < end; ++l, ++i) out[i] = drop_search.drops()[l];
  }
}

}  // namespace tubecut::bevel::drop
