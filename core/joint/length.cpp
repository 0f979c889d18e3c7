#include "core/joint/length.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/joint/borders.hpp"
#include "core/joint/stations.hpp"

namespace tubecut::joint {
namespace {

struct GaussPoint {
  double at, weight;
};
constexpr std::array<GaussPoint, 3> kGauss3 = {{{0.0, 0.8888888888888888},
                                                {-0.7745966692414834, 0.5555555555555556},
                                                {0.7745966692414834, 0.5555555555555556}}};
constexpr std::array<GaussPoint, 5> kGauss5 = {{{0.0, 0.5688888888888889},
                                                {-0.5384693101056831, 0.47862867049936647},
                                                {0.5384693101056831, 0.47862867049936647},
                                                {-0.906179845938664, 0.23692688505618908},
                                                {0.906179845938664, 0.23692688505618908}}};
constexpr double kAgreement = 1e-10;  // of two orders; the higher one is then much more accurate
// Of the radius. A smaller value would resolve the rounding of the silhouette's own phase, at which
// the sheet is 1e-8 radius high instead of 0.
constexpr double kNegligible = 1e-10;
constexpr int kHalvings = 14;

template <class Points, class F>
double gauss(const Points& points, const F& f, double a, double b) {
  const double mid = 0.5 * (a + b);
  const double half = 0.5 * (b - a);
  double sum = 0.0;
  for (const auto& p : points) sum += p.weight * f(mid + half * p.at);
  return sum * half;
}

template <class F>
double integrate(const F& f, double a, double b, double negligible, int halvings) {
  const double low = gauss(kGauss3, f, a, b);
  const double high = gauss(kGauss5, f, a, b);
  const double agreed = std::max(kAgreement * std::abs(high), negligible);
  if (halvings == 0 || std::abs(high - low) <= agreed) return high;
  const double mid = 0.5 * (a + b);
  return integrate(f, a, mid, negligible, halvings - 1) +
         integrate(f, mid, b, negligible, halvings - 1);
}

/// Computes dz/dphi of the sheet. If the offset of a tangent tube is rounding, a generator next to
/// its corner may just miss it: then the silhouette's own slope counts, not an infinite one.
double slope_at(const PreparedCutter& cutter, const Generator& line) {
  const double slope = continued_hit(cutter, line).z_dphi;
  if (std::isfinite(slope)) return slope;
  return silhouette_slope(cutter, line);
}

}  // namespace

// At a segment's own ends z' may be infinite as the inverse root of the distance; there the
// substitution phi = from + (to - from) sin^2(t) makes the integrand smooth.
double arc_length(const Contour& contour, const Segment& segment, double from, double to) {
  const auto& cutter = contour.cutters[segment.cutter];
  const auto speed = [&](double phi) {
    return elementary::hypot(contour.radius, slope_at(cutter, generator_at(contour.radius, phi)));
  };
  const double negligible = kNegligible * contour.radius;
  if (from > segment.from && to < segment.to)
    return integrate(speed, from, to, negligible, kHalvings);
  const auto stretched = [&](double t) {
    const auto s = elementary::sincos(t);
    return speed(from + (to - from) * s.sin * s.sin) * (to - from) * 2.0 * s.sin * s.cos;
  };
  return integrate(stretched, 0.0, 0.5 * kPi, negligible, kHalvings);
}

namespace {

/// A part of a segment between requested phases, events, or borders of its cutter's surfaces.
struct LengthSpan {
  std::size_t segment;
  double from, to;  // rad, in the segment's range
  double length = 0.0;
};

/// Walks once around from phi = 0 and collects the pieces and their number before each phase. It
/// starts in the last segment, whose phases are then phi + 2 pi.
class Walk {
 public:
  explicit Walk(const Contour& contour) : contour_(contour), borders_(contour.cutters.size()) {
    for (const auto& segment : contour.segments)
      if (auto& own = borders_[segment.cutter]; own.empty())
        own = borders(contour.cutters[segment.cutter], contour.radius);
    if (contour.events.empty()) return;
    segment_ = contour.segments.size() - 1;
    turn_ = kTwoPi;
  }

  /// If called twice at an event, the second result is that after the event.
  void advance(double phi) {
    const bool again = asked_ == phi;
    while (end() < phi || (again && end() == phi)) enter_next();
    add(phi);
    asked_ = phi;
    stops.push_back({pieces.size(), leaps_});
  }

  struct Stop {
    std::size_t pieces;  // before it
    double leaps;        // of jumps before it, mm
  };
  std::vector<LengthSpan> pieces;
  std::vector<Stop> stops;

 private:
  double end() const {
    return turn_ > 0.0 ? contour_.segments.front().from : contour_.segments[segment_].to;
  }

  void add(double phi) {
    const auto& own = borders_[contour_.segments[segment_].cutter];
    for (auto border = std::ranges::upper_bound(own, at_); border != own.end() && *border < phi;
         ++border)
      add_piece(*border);
    add_piece(phi);
  }

  void add_piece(double phi) {
    if (phi > at_) pieces.push_back({segment_, at_ + turn_, phi + turn_});
    at_ = std::max(at_, phi);
  }

  void enter_next() {
    add(end());
    segment_ = turn_ > 0.0 ? 0 : segment_ + 1;
    turn_ = 0.0;
    const auto& event = contour_.events[segment_];
    if (event.kind == EventKind::jump) leaps_ += std::abs(event.z_to - event.z_from);
  }

  const Contour& contour_;
  std::vector<std::vector<double>> borders_;  // of each cutter that holds a segment
  std::size_t segment_ = 0;
  double turn_ = 0.0, at_ = 0.0, leaps_ = 0.0;
  std::optional<double> asked_;
};

/// Integrates a run of pieces of one segment by a fixed rule: five Gauss points, and three to
/// compare with; the points are computed by rotation from the middle. If the two disagree, as at a
/// silhouette, integrates piece by piece.
class Rule {
 public:
  Rule(const Contour& contour, std::span<LengthSpan> pieces)
      : contour_(contour), pieces_(pieces), half_(pieces.size()) {
    std::vector<double> middle(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      middle[i] = 0.5 * (pieces[i].from + pieces[i].to);
      half_[i] = 0.5 * (pieces[i].to - pieces[i].from);
    }
    middle_ = stations_at(contour.radius, middle);
    low_.assign(pieces.size(), 0.0);
    high_ = low_;
  }

  void apply() {
    add(middle_, kGauss3[0].weight, low_);
    add(middle_, kGauss5[0].weight, high_);
    pair(kGauss3[2], low_);
    pair(kGauss5[2], high_);
    pair(kGauss5[4], high_);
    const double negligible = kNegligible * contour_.radius;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      auto& piece = pieces_[i];
      const double agreed = std::max(kAgreement * high_[i], negligible / half_[i]);
      const bool good = std::abs(high_[i] - low_[i]) <= agreed;
      piece.length =
          good ? half_[i] * high_[i]
               : arc_length(contour_, contour_.segments[piece.segment], piece.from, piece.to);
    }
  }

 private:
  void pair(const GaussPoint& point, std::vector<double>& sum) {
    std::vector<double> off(half_.size());
    for (std::size_t i = 0; i < off.size(); ++i) off[i] = point.at * half_[i];
    const auto by = stations_at(contour_.radius, off);
    for (const double side : {1.0, -1.0}) {
      auto at = middle_;
      for (std::size_t i = 0; i < off.size(); ++i) {
        at.cos_phi[i] =
            middle_.cos_phi[i] * by.cos_phi[i] - middle_.sin_phi[i] * side * by.sin_phi[i];
        at.sin_phi[i] =
            middle_.sin_phi[i] * by.cos_phi[i] + middle_.cos_phi[i] * side * by.sin_phi[i];
      }
      add(at, point.weight, sum);
    }
  }

  void add(const Stations& at, double weight, std::vector<double>& sum) {
    slope_.resize(at.size());
    slopes_of(contour_.cutters[contour_.segments[pieces_.front().segment].cutter], at, slope_);
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] += weight * std::sqrt(contour_.radius * contour_.radius + slope_[i] * slope_[i]);
  }

  const Contour& contour_;
  std::span<LengthSpan> pieces_;
  std::vector<double> half_, low_, high_, slope_;
  Stations middle_;
};

void measure(const Contour& contour, std::span<LengthSpan> pieces) {
  constexpr std::size_t kAtOnce = 1024;  // some 100 us, and fits in the nearest cache
  while (!pieces.empty() && !stopped()) {
    const auto segment = pieces.front().segment;
    const auto block = pieces.first(std::min(kAtOnce, pieces.size()));
    const auto other = std::ranges::find_if(
        block, [&](const LengthSpan& piece) { return piece.segment != segment; });
    const auto run = static_cast<std::size_t>(other - block.begin());
    Rule(contour, pieces.first(run)).apply();
    pieces = pieces.subspan(run);
  }
}

}  // namespace

std::vector<double> lengths_along(const Contour& contour, std::span<const double> phases) {
  Walk walk(contour);
  walk.stops.reserve(phases.size() + 1);
  walk.pieces.reserve(phases.size() + contour.segments.size() + 1);
  for (const double phi : phases) walk.advance(phi);
  walk.advance(kTwoPi);
  measure(contour, walk.pieces);
  std::vector<double> out;
  out.reserve(walk.stops.size());
  double total = 0.0;
  std::size_t piece = 0;
  for (const auto& at : walk.stops) {
    for (; piece < at.pieces; ++piece) total += walk.pieces[piece].length;
    out.push_back(total + at.leaps);
  }
  return out;
}

double true_length(const Contour& contour) { return lengths_along(contour, {}).back(); }

}  // namespace tubecut::joint
