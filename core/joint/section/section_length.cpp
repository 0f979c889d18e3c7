#include "core/joint/section/section_length.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::joint {
namespace {

constexpr double kAgreement = 1e-10;   // of two orders; the higher one is then good to far less
constexpr double kNegligible = 1e-11;  // of the girth
constexpr int kHalvings = 14;
constexpr double kWidestTurn = 5.0 * kRadPerDeg;  // of the normal, within one rule
constexpr double kWidestShare = 1.0 / 144.0;      // of the girth, within one rule on a flat
constexpr double kStep = 0.25;                    // of the distance to an event, from part to part
constexpr int kSteps = 14;
constexpr double kSameEvent = 1e-9;  // mm: two places so near are one
constexpr double kSide = 1e-9;       // of a length: on which side of a border

/// Lobatto's rule and Kronrod's extension of it. Where a box's face goes on as its corner the slope
/// has a bend, however near to an end of the part: both rules look at the ends.
template <class F>
double integrate(const F& f, double a, double b, double negligible, int halvings) {
  constexpr double kWide = 0.816496580927726, kNear = 0.4472135954999579;  // of half the width
  const double mid = 0.5 * (a + b), half = 0.5 * (b - a);
  const double ends = f(a) + f(b), wide = f(mid - kWide * half) + f(mid + kWide * half);
  const double near = f(mid - kNear * half) + f(mid + kNear * half);
  const double low = half / 6.0 * (ends + 5.0 * near);
  const double high = half / 1470.0 * (77.0 * ends + 432.0 * wide + 625.0 * near + 672.0 * f(mid));
  if (halvings == 0 || std::abs(high - low) <= std::max(kAgreement * std::abs(high), negligible))
    return high;
  return integrate(f, a, mid, negligible, halvings - 1) +
         integrate(f, mid, b, negligible, halvings - 1);
}

/// Along one contour, from place to place.
class Walk {
 public:
  explicit Walk(const SectionContour& contour) : contour_(contour), girth_(contour.curve.girth()) {}

  /// Of a part of one segment; places as the segment counts them.
  [[nodiscard]] double length(const SectionSegment& segment, double from, double to) const {
    double sum = 0.0;
    const double curvature = contour_.curve.at(0.5 * (from + to)).curvature;
    const double widest = curvature > 0.0 ? kWidestTurn / curvature : kWidestShare * girth_;
    const auto parts = static_cast<std::size_t>(std::ceil((to - from) / widest));
    for (std::size_t k = 0; k < parts; ++k) {
      const auto at = [&](std::size_t part) {
        return part == parts
                   ? to
                   : from + (to - from) * static_cast<double>(part) / static_cast<double>(parts);
      };
      sum += part_length(segment, at(k), at(k + 1));
    }
    return sum;
  }

 private:
  /// ds, dz: a silhouette's own slope counts where it is missed by a hair.
  [[nodiscard]] double speed(std::size_t cutter, double s) const {
    const auto at = contour_.curve.at(s);
    const double slope = contour_.hit(cutter, at).z_dphi;
    if (std::isfinite(slope)) return elementary::hypot(1.0, slope);
    const double offset = kSide * girth_;
    const auto height = [&](double place) {
      return contour_.height(cutter, contour_.curve.at(place));
    };
    return elementary::hypot(1.0, (height(s + offset) - height(s - offset)) / (2.0 * offset));
  }

  [[nodiscard]] double smooth_length(std::size_t cutter, double from, double to) const {
    const auto along = [&](double s) { return speed(cutter, s); };
    return integrate(along, from, to, kNegligible * girth_, kHalvings);
  }

  /// From a place to an event, whose own height on this side holds: a generator that runs within a
  /// flat side of the partner has none of its own.
  [[nodiscard]] double chord(std::size_t cutter, double from, double event, double z) const {
    return elementary::hypot(event - from, z - contour_.height(cutter, contour_.curve.at(from)));
  }

  /// Towards an event the slope may grow as the inverse root of the distance to a silhouette that
  /// lies there or a hair beyond: parts that shrink with the distance, and a chord at last.
  [[nodiscard]] double length_towards(std::size_t cutter, double from, double event,
                                      double z) const {
    double sum = 0.0, at = from;
    for (int k = 0; k < kSteps; ++k) {
      const double next = event + kStep * (at - event);
      sum += std::abs(smooth_length(cutter, std::min(at, next), std::max(at, next)));
      at = next;
    }
    return sum + chord(cutter, at, event, z);
  }

  [[nodiscard]] double part_length(const SectionSegment& segment, double from, double to) const {
    const auto* begin = from <= segment.from ? steep_at(segment.from) : nullptr;
    const auto* end = to >= segment.to ? steep_at(segment.to) : nullptr;
    const bool first = begin != nullptr, last = end != nullptr;
    const double middle = first && last ? 0.5 * (from + to) : first ? to : from;
    if (!first && !last) return smooth_length(segment.cutter, from, to);
    double sum = 0.0;
    if (first) sum += length_towards(segment.cutter, middle, from, begin->z_to);
    if (last) sum += length_towards(segment.cutter, middle, to, end->z_from);
    return sum;
  }

  /// The event here that is not only a seam.
  [[nodiscard]] const SectionEvent* steep_at(double s) const {
    const auto found = std::ranges::find_if(contour_.events, [&](const SectionEvent& event) {
      return event.kind != SectionEventKind::seam && (event.s == s || event.s + girth_ == s);
    });
    return found == contour_.events.end() ? nullptr : &*found;
  }

  const SectionContour& contour_;
  double girth_;
};

}  // namespace

std::vector<double> lengths_along(const SectionContour& contour, std::span<const double> places) {
  const Walk walk(contour);
  const double girth = contour.curve.girth();
  const auto& segments = contour.segments;
  // From the datum the walk starts in the segment that holds it, whose places are then s + girth.
  const bool whole = contour.events.empty();
  std::size_t segment = whole ? 0 : segments.size() - 1;
  double turn = whole ? 0.0 : girth, at = 0.0, total = 0.0, asked = -1.0;
  std::vector<double> out;
  const auto end = [&] { return turn > 0.0 ? segments.front().from : segments[segment].to; };
  const auto go = [&](double to) {
    if (to > at) total += walk.length(segments[segment], at + turn, to + turn);
    at = std::max(at, to);
  };
  const auto enter_next = [&] {
    go(end());
    segment = turn > 0.0 ? 0 : segment + 1;
    turn = 0.0;
    const auto& event = contour.events[segment];
    if (event.kind == SectionEventKind::jump) total += std::abs(event.z_to - event.z_from);
  };
  const auto advance = [&](double to) {
    const bool again = asked == to;
    while (!whole && (end() < to || (again && end() == to))) enter_next();
    go(to);
    asked = to;
    out.push_back(total);
  };
  // A place that was an event's on another outline may come back as one a rounding before it.
  const auto at_event = [&](double s) {
    const auto near = std::ranges::find_if(
        contour.events, [&](const auto& event) { return std::abs(event.s - s) <= kSameEvent; });
    return near == contour.events.end() ? s : near->s;
  };
  for (const double s : places) advance(at_event(s));
  advance(girth);
  return out;
}

}  // namespace tubecut::joint
