#include "core/joint/length.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/elementary.hpp"

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
constexpr double kAgreement = 1e-10;  // of two orders; the higher one is then good to far less
// Of the radius. Finer would resolve the rounding of the silhouette's own phase, in which the
// sheet is 1e-8 radius high instead of 0.
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

/// Walks once around from phi = 0, adding arcs, and at jumps the difference in height. It starts in
/// the last segment, whose phases are then phi + 2 pi.
class Walk {
 public:
  explicit Walk(const Contour& contour) : contour_(contour) {
    if (contour.events.empty()) return;
    segment_ = contour.segments.size() - 1;
    turn_ = kTwoPi;
  }

  /// The length up to phi; asked twice at an event, the second answer is that behind the event.
  double advance(double phi) {
    const bool again = asked_ == phi;
    while (end() < phi || (again && end() == phi)) enter_next();
    add_arc(phi);
    asked_ = phi;
    return total_;
  }

 private:
  double end() const {
    return turn_ > 0.0 ? contour_.segments.front().from : contour_.segments[segment_].to;
  }

  void add_arc(double phi) {
    if (phi > at_)
      total_ += arc_length(contour_, contour_.segments[segment_], at_ + turn_, phi + turn_);
    at_ = std::max(at_, phi);
  }

  void enter_next() {
    add_arc(end());
    segment_ = turn_ > 0.0 ? 0 : segment_ + 1;
    turn_ = 0.0;
    const auto& event = contour_.events[segment_];
    if (event.kind == EventKind::jump) total_ += std::abs(event.z_to - event.z_from);
  }

  const Contour& contour_;
  std::size_t segment_ = 0;
  double turn_ = 0.0;
  double at_ = 0.0;
  double total_ = 0.0;
  std::optional<double> asked_;
};

/// dz/dphi of the sheet. A tangent tube whose offset is rounding is missed by a hair beside its
/// corner: there the silhouette's own slope counts, not an infinite one.
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

std::vector<double> lengths_along(const Contour& contour, std::span<const double> phases,
                                  const std::stop_token& stop) {
  Walk walk(contour);
  std::vector<double> out;
  out.reserve(phases.size() + 1);
  for (const double phi : phases) out.push_back(stop.stop_requested() ? 0.0 : walk.advance(phi));
  out.push_back(stop.stop_requested() ? 0.0 : walk.advance(kTwoPi));
  return out;
}

double true_length(const Contour& contour) { return lengths_along(contour, {}).back(); }

}  // namespace tubecut::joint
