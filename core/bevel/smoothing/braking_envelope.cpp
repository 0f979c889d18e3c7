#include "core/bevel/smoothing/braking_envelope.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tubecut::bevel {
namespace {

constexpr std::size_t kLaps = 16;  // 4 are the most seen, on 10 000 hostile profiles

/// The closed path and the limits at each node.
struct BrakingPath {
  const std::vector<double>& s;
  const std::vector<double>& b;
  double period = 0.0;
  BevelRateLimits limits;
  double highest = 0.0;
  std::vector<double> ahead;  // mm from each node to the next
  std::vector<double> leave;  // m, start slope of each node's braking curves, rad/mm
  // The profile keeps the limits here. Such a node needs no curve of its own: where e is its B, e
  // at the neighbours is at least theirs, so e keeps the limits too.
  std::vector<char> keeps;

  [[nodiscard]] std::size_t size() const { return b.size(); }
  [[nodiscard]] std::size_t next(std::size_t j) const { return j + 1 == size() ? 0 : j + 1; }
  [[nodiscard]] std::size_t previous(std::size_t j) const { return j == 0 ? size() - 1 : j - 1; }
  /// Returns the distance from i forward to k; a whole lap if they are equal.
  [[nodiscard]] double distance(std::size_t i, std::size_t k) const {
    return k > i ? s[k] - s[i] : s[k] - s[i] + period;
  }
};

double clamped(double x, double bound) { return std::clamp(x, -bound, bound); }

void choose_start(BrakingPath& path, std::size_t j) {
  const auto& b = path.b;
  const auto before = path.previous(j);
  const auto& [slope, rate] = path.limits;
  const double slope_in = (b[j] - b[before]) / path.ahead[before];
  const double slope_out = (b[path.next(j)] - b[j]) / path.ahead[j];
  const double low = slope_in - 0.5 * rate * path.ahead[before];
  const double high = slope_out + 0.5 * rate * path.ahead[j];
  const bool corner = low > high;  // concave beyond A: no start slope suits both sides
  double m = 0.5 * (low + high);
  if (corner) m = std::abs(slope_in) <= std::abs(slope_out) ? low : high;
  // A curve started no steeper than A L / 4 has fallen below its start after one lap; nor may it
  // rise beyond `highest`.
  const double steepest =
      std::min({slope, 0.25 * rate * path.period, std::sqrt(2.0 * rate * (path.highest - b[j]))});
  path.leave[j] = clamped(m, steepest);
  path.keeps[j] = !corner && std::max(std::abs(slope_in), std::abs(slope_out)) <= slope;
}

BrakingPath make_path(const AngleProfile& profile, const EnvelopeSpec& spec) {
  const std::size_t n = profile.b.size();
  BrakingPath path{.s = profile.s,
                   .b = profile.b,
                   .period = profile.period,
                   .limits = spec.limits,
                   .highest = spec.highest,
                   .ahead = std::vector<double>(n),
                   .leave = std::vector<double>(n),
                   .keeps = std::vector<char>(n)};
  for (std::size_t j = 0; j < n; ++j) path.ahead[j] = path.distance(j, path.next(j));
  for (std::size_t j = 0; j < n; ++j) choose_start(path, j);
  return path;
}

/// A point on a braking curve, with its slope in the direction of travel.
struct Braking {
  double value = 0.0;
  double slope = 0.0;
  friend bool operator==(const Braking&, const Braking&) = default;
};
/// A node without a curve passes nothing on.
constexpr Braking kNoCurve{-std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()};

/// Travels h: the slope falls at the rate A down to -K. Exact integration.
Braking brake(Braking from, double h, const BevelRateLimits& limits) {
  if (from.slope < -limits.slope) return kNoCurve;
  const double slope = from.slope - limits.curvature * h;
  if (slope >= -limits.slope)
    return {from.value + h * (from.slope - 0.5 * limits.curvature * h), slope};
  const double fading = (from.slope + limits.slope) / limits.curvature;
  return {from.value + 0.5 * fading * (from.slope - limits.slope) - limits.slope * (h - fading),
          -limits.slope};
}

enum class Sense { forward, backward };

/// Returns the start of node j's own curve.
Braking start(const BrakingPath& path, std::size_t j, Sense sense) {
  if (path.keeps[j]) return {path.b[j], kNoCurve.slope};
  return {path.b[j], sense == Sense::forward ? path.leave[j] : -path.leave[j]};
}

/// Travels once around from j to j and returns the state there. Writes the curve to `out`, or
/// raises `out` to it. A curve that arrives at a node below B ends there, and the node's own
/// begins.
Braking lap(const BrakingPath& path, std::size_t j, Sense sense, Braking at, bool raise,
            std::vector<double>& out) {
  for (std::size_t visit = 0; visit < path.size(); ++visit) {
    const auto before = j;
    j = sense == Sense::forward ? path.next(j) : path.previous(j);
    at = brake(at, path.ahead[sense == Sense::forward ? before : j], path.limits);
    if (path.b[j] >= at.value) at = start(path, j, sense);
    out[j] = raise ? std::max(out[j], at.value) : at.value;
  }
  return at;
}

/// Computes the braking curves of all nodes in one direction: the highest at each.
std::vector<double> sweep(const BrakingPath& path, Sense sense) {
  std::vector<double> out(path.size());
  const auto top = static_cast<std::size_t>(std::ranges::max_element(path.b) - path.b.begin());
  std::vector<Braking> seen{start(path, top, sense)};
  while (seen.size() <= kLaps) {
    const auto at = lap(path, top, sense, seen.back(), false, out);
    const auto again = std::ranges::find(seen, at);
    if (again == seen.end()) {
      seen.push_back(at);
      continue;
    }
    // If curves are as long as the path, they can alternate: the laps then repeat in twos or more.
    // Each lap of the endless path is valid, so their maximum is too, and that closes.
    auto state = at;
    for (auto more = seen.end() - again; more > 1; --more)
      state = lap(path, top, sense, state, true, out);
    return out;
  }
  // Never seen. The constant is valid too.
  out.assign(path.size(), path.b[top]);
  return out;
}

// Both are the upper hull of e - A s^2/2, written in differences: no s^2 to cancel, and no origin.
/// Returns true if the parabola of second derivative A through (i, e_i) and (k, e_k) passes below
/// or through e_j, i < j < k.
bool touches(const BrakingPath& path, const std::vector<double>& e, std::size_t i, std::size_t j,
             std::size_t k) {
  const double left = path.distance(i, j);
  const double right = path.distance(j, k);
  return (e[j] - e[i]) / left + 0.5 * path.limits.curvature * (left + right) >=
         (e[k] - e[j]) / right;
}

/// Returns that parabola at j, never below e_j.
double rolled(const BrakingPath& path, const std::vector<double>& e, std::size_t i, std::size_t j,
              std::size_t k) {
  const double chord = (e[k] - e[i]) / path.distance(i, k);
  return std::max(e[j], e[i] + path.distance(i, j) *
                                   (chord - 0.5 * path.limits.curvature * path.distance(j, k)));
}

/// Returns the contacts from the highest e (always one, because the constant through it lies above
/// e) once around to it again.
std::vector<std::size_t> contacts(const BrakingPath& path, const std::vector<double>& e) {
  const std::size_t n = path.size();
  const auto top = static_cast<std::size_t>(std::ranges::max_element(e) - e.begin());
  std::vector<std::size_t> hull{top};
  std::size_t k = top;
  for (std::size_t visit = 0; visit < n; ++visit) {
    k = path.next(k);
    while (hull.size() > 1 && !touches(path, e, hull[hull.size() - 2], hull.back(), k))
      hull.pop_back();
    hull.push_back(k);
  }
  return hull;
}

}  // namespace

std::vector<double> braking_envelope(const AngleProfile& profile, const EnvelopeSpec& spec) {
  const auto path = make_path(profile, spec);
  auto e = sweep(path, Sense::forward);
  const auto backward = sweep(path, Sense::backward);
  for (std::size_t j = 0; j < e.size(); ++j) e[j] = std::max(e[j], backward[j]);
  auto f = e;
  const auto hull = contacts(path, e);
  for (std::size_t c = 0; c + 1 < hull.size(); ++c)
    for (auto j = path.next(hull[c]); j != hull[c + 1]; j = path.next(j))
      f[j] = rolled(path, e, hull[c], j, hull[c + 1]);
  // A parabola may overshoot the limit to which it is tangent by the last bits.
  for (double& value : f) value = std::min(value, spec.highest);
  return f;
}

}  // namespace tubecut::bevel
