#include "core/motion/path/path.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/base/try.hpp"
#include "core/motion/path/between_knots.hpp"

namespace tubecut::motion {
namespace {

constexpr double kSpacing = 0.1;      // mm between knots, before any halving
constexpr double kWidestBevel = 6.0;  // mm, of one mean over B
constexpr double kLeastTip = 1e-3;    // mm
constexpr double kLeastBevel = 0.01 * kRadPerDeg;
constexpr double kKnotCornerCos = 0.93969262078590838;  // cos 20 deg
constexpr int kInner = 15;                              // test points inside a segment
constexpr int kMostHalvings = 8;
constexpr double kMostKnots = 1'000'000.0;  // about 320 bytes each while planning

/// Cubic Hermite weights at 0 < h < 1: start value, end value, start tangent, end tangent (times
/// the length).
struct Weights {
  double x0, x1, m0, m1;
};
Weights hermite(double h) {
  const double g = 1.0 - h;
  return {g * g * (1.0 + 2.0 * h), h * h * (3.0 - 2.0 * h), h * g * g, -h * h * g};
}

/// One coordinate of the curve: node values and the tangents at both ends of every segment, limited
/// per node.
class HermiteCurve {
 public:
  HermiteCurve(const std::vector<double>& x, const std::vector<double>& lengths)
      : values_(x),
        lengths_(lengths),
        start_(lengths.size()),
        end_(lengths.size()),
        factor_(x.size(), 1.0),
        halvings_(x.size(), 0) {}

  void set_tangents(const std::vector<bool>& corner) {
    for (std::size_t i = 0; i < lengths_.size(); ++i) {
      const bool free_start = corner[i], free_end = corner[i + 1];
      const double chord = slope(i);
      const double start = free_start ? 0.0 : node_tangent(i);
      const double end = free_end ? 0.0 : node_tangent(i + 1);
      start_[i] = !free_start ? start : free_end ? chord : 0.5 * (3.0 * chord - end);
      end_[i] = !free_end ? end : free_start ? chord : 0.5 * (3.0 * chord - start);
    }
  }

  /// Halves the factors at both ends of every segment that leaves the range of its ends by more
  /// than `over`, until none does. It ends, because each node is halved at most nine times.
  void limit(double over) {
    std::vector<bool> dirty(lengths_.size(), true);
    for (bool changed = true; changed;) changed = halve(over, dirty);
  }

  [[nodiscard]] double at(std::size_t i, double h) const {
    const Weights w = hermite(h);
    const double l = lengths_[i];
    return w.x0 * values_[i] + w.x1 * values_[i + 1] +
           l * (w.m0 * factor_[i] * start_[i] + w.m1 * factor_[i + 1] * end_[i]);
  }

  /// Returns the distance to the chord at the same parameter.
  [[nodiscard]] double sag(std::size_t i, double h) const {
    return at(i, h) - (values_[i] + h * (values_[i + 1] - values_[i]));
  }

 private:
  [[nodiscard]] double slope(std::size_t i) const {
    return (values_[i + 1] - values_[i]) / lengths_[i];
  }
  [[nodiscard]] double node_tangent(std::size_t i) const {
    const double before = lengths_[i - 1], after = lengths_[i];
    return (after * slope(i - 1) + before * slope(i)) / (before + after);
  }
  [[nodiscard]] bool leaves(std::size_t i, double over) const {
    const double low = std::min(values_[i], values_[i + 1]) - over;
    const double high = std::max(values_[i], values_[i + 1]) + over;
    for (int j = 1; j <= kInner; ++j) {
      const double value = at(i, static_cast<double>(j) / (kInner + 1));
      if (value < low || value > high) return true;
    }
    return false;
  }
  void halve(std::size_t node) {
    factor_[node] = halvings_[node]++ < kMostHalvings ? 0.5 * factor_[node] : 0.0;
  }
  bool halve(double over, std::vector<bool>& dirty) {
    std::vector<bool> hit(values_.size(), false);
    for (std::size_t i = 0; i < dirty.size(); ++i) {
      if (dirty[i] && leaves(i, over)) hit[i] = hit[i + 1] = true;
    }
    std::fill(dirty.begin(), dirty.end(), false);
    bool changed = false;
    for (std::size_t node = 0; node < hit.size(); ++node) {
      if (!hit[node] || factor_[node] == 0.0) continue;
      halve(node);
      changed = true;
      if (node > 0) dirty[node - 1] = true;
      if (node < dirty.size()) dirty[node] = true;
    }
    return changed;
  }

  const std::vector<double>& values_;
  const std::vector<double>& lengths_;
  std::vector<double> start_, end_;  // tangents of each segment
  std::vector<double> factor_;
  std::vector<int> halvings_;
};

/// Returns flagged points, both ends, and points where the generalised direction turns by more than
/// 20 deg.
std::vector<bool> corners(const Program& p, const std::vector<double>& lengths) {
  std::vector<bool> corner = p.corner;
  corner.front() = corner.back() = true;
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    double dot = 0.0;
    for (std::size_t c = 0; c < p.x.size(); ++c) {
      const double w = p.coordinates[c].weight;
      dot += w * (p.x[c][i] - p.x[c][i - 1]) * w * (p.x[c][i + 1] - p.x[c][i]);
    }
    if (dot < kKnotCornerCos * lengths[i - 1] * lengths[i]) corner[i] = true;
  }
  return corner;
}

/// Samples of the Hermite curve through a polyline at equal steps.
struct Resampled {
  double d = 0.0;
  std::vector<std::vector<double>> x = {};
  double sag_tip = 0.0;
  double sag_b = 0.0;
};

void measure_sag(const Program& p, const std::vector<HermiteCurve>& curves, Resampled& out) {
  for (std::size_t i = 0; i + 1 < p.size() && !stopped(); ++i) {
    for (int j = 1; j <= kInner; ++j) {
      const double h = static_cast<double>(j) / (kInner + 1);
      double tip = 0.0, along = 0.0, chord = 0.0;
      for (std::size_t c = 0; c < curves.size(); ++c) {
        const double weight = p.coordinates[c].weight, off = weight * curves[c].sag(i, h);
        if (p.coordinates[c].group == Coordinate::Group::tip) {
          const double way = weight * (p.x[c][i + 1] - p.x[c][i]);
          tip += off * off;
          along += off * way;
          chord += way * way;
        } else {
          out.sag_b = std::max(out.sag_b, std::abs(off) / kBevelWeight);
        }
      }
      // Along the chord, the curve only runs ahead of it or behind, next to a short piece by much.
      if (chord > 0.0) tip -= along * along / chord;
      out.sag_tip = std::max(out.sag_tip, std::sqrt(std::max(0.0, tip)));
    }
  }
}

void sample(const Program& p, const std::vector<double>& s, const std::vector<HermiteCurve>& curves,
            std::size_t n, Resampled& out) {
  out.x.assign(p.x.size(), std::vector<double>(n + 1));
  std::size_t i = 0;
  for (std::size_t k = 1; k < n && !stops(k); ++k) {
    const double at = s.back() * static_cast<double>(k) / static_cast<double>(n);
    while (i + 2 < s.size() && s[i + 1] <= at) ++i;
    const double h = std::clamp((at - s[i]) / (s[i + 1] - s[i]), 0.0, 1.0);
    for (std::size_t c = 0; c < curves.size(); ++c) out.x[c][k] = curves[c].at(i, h);
  }
  for (std::size_t c = 0; c < p.x.size(); ++c) {
    out.x[c].front() = p.x[c].front();
    out.x[c].back() = p.x[c].back();
  }
}

/// Returns how far the curve of a coordinate may leave the range of two neighbouring points, in its
/// unit. The angle of a section's normal has no weight, because it is no part of the length.
double overshoot(const Program& p, const Coordinate& of, double eps_tip, double eps_b) {
  switch (of.group) {
    case Coordinate::Group::tip:
      return std::min(0.5 * eps_tip, p.overshoot) / of.weight;
    case Coordinate::Group::bevel:
      return 0.5 * (eps_b * kBevelWeight) / of.weight;
    case Coordinate::Group::turn:
      break;
  }
  return 0.5 * eps_b;
}

/// Samples the limited Hermite curve through the points about every `d` mm; corners stay.
///
/// Errors  too_many_nodes, cancelled.
Result<Resampled> resample(const Program& p, double d, double eps_tip, double eps_b) {
  const std::vector<double> s = p.lengths();
  const double wanted = std::max(4.0, std::ceil(s.back() / d));
  if (!(wanted <= kMostKnots)) {
    return fail({ErrorCode::too_many_nodes, "contour", wanted, kMostKnots, {}, {}});
  }
  std::vector<double> lengths(p.size() - 1);
  for (std::size_t i = 0; i < lengths.size(); ++i) lengths[i] = p.step(i, i + 1);
  const std::vector<bool> corner = corners(p, lengths);
  std::vector<HermiteCurve> curves;
  for (std::size_t c = 0; c < p.x.size(); ++c) {
    HermiteCurve& curve = curves.emplace_back(p.x[c], lengths);
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    curve.set_tangents(corner);
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    curve.limit(overshoot(p, p.coordinates[c], eps_tip, eps_b));
    if (stopped()) return fail({.code = ErrorCode::cancelled});
  }
  Resampled out;
  const auto n = static_cast<std::size_t>(wanted);
  out.d = s.back() / static_cast<double>(n);
  measure_sag(p, curves, out);
  sample(p, s, curves, n, out);
  if (stopped()) return fail({.code = ErrorCode::cancelled});
  return out;
}

/// Extends x by odd reflection: x at -j is 2 x[0] - x[j], and likewise after the end.
std::vector<double> reflected(const std::vector<double>& x, std::size_t m) {
  const std::size_t n = x.size();
  std::vector<double> out;
  out.reserve(n + 2 * m);
  for (std::size_t j = m; j > 0; --j) out.push_back(2.0 * x.front() - x[std::min(j, n - 1)]);
  out.insert(out.end(), x.begin(), x.end());
  for (std::size_t j = 1; j <= m; ++j) {
    out.push_back(2.0 * x.back() - x[n - 1 - std::min(j, n - 1)]);
  }
  return out;
}

/// Sums differences to the centre in pairs: the rounding is small and does not depend on the
/// direction.
std::vector<double> mean(const std::vector<double>& x, std::size_t m) {
  const std::vector<double> wide = reflected(x, m);
  std::vector<double> out(x.size());
  for (std::size_t i = 0; i < x.size() && !stopped(); ++i) {
    double sum = 0.0;
    for (std::size_t j = 1; j <= m; ++j) {
      sum += (wide[i + m + j] - x[i]) + (wide[i + m - j] - x[i]);
    }
    out[i] = x[i] + sum / static_cast<double>(2 * m + 1);
  }
  return out;
}

using Group = Coordinate::Group;

struct Smoothed {
  std::vector<std::vector<double>> control;  // of the group's coordinates, in their order
  double deviation = 0.0;                    // mm of generalised length, at the knots
  bool within = false;                       // the tolerance, at the knots and between them
};

/// Returns true if the curve of the tip is within the tolerance of the polyline between its knots,
/// too. `square`: of its distance at the knots. Only where the curve is off at a knot can it be off
/// by up to 3.3 times as much at a corner after it.
bool within_between(const TipPolyline& line, const Resampled& r, const Smoothed& curve,
                    const std::vector<double>& square, double tolerance) {
  const double most = tolerance + r.sag_tip, reach = 4.0 * tolerance + 2.0 * r.d + r.sag_tip;
  const double least = tolerance * tolerance / 16.0;
  for (std::size_t i = 0; i + 1 < square.size() && !stops(i); ++i) {
    if (std::max(square[i], square[i + 1]) > least &&
        line.farthest_between(curve.control, i, r.d, reach) > most)
      return false;
  }
  return true;
}

/// `line`: of the tip.
Smoothed smoothed(const Program& p, const Resampled& r, const TipPolyline& line, Group group,
                  std::size_t m, double tolerance) {
  Smoothed out;
  std::vector<double> square(r.x.front().size(), 0.0);
  for (std::size_t c = 0; c < r.x.size(); ++c) {
    if (p.coordinates[c].group != group) continue;
    out.control.push_back(box2(r.x[c], m));
    for (std::size_t j = 0; j < square.size() && !stops(j); ++j) {
      const double off = p.coordinates[c].weight * (at_knot(out.control.back(), j) - r.x[c][j]);
      square[j] = group == Group::tip ? square[j] + off * off : std::max(square[j], off * off);
    }
  }
  out.deviation = std::sqrt(*std::ranges::max_element(square));
  out.within = out.deviation <= tolerance &&
               (group != Group::tip || within_between(line, r, out, square, tolerance));
  return out;
}

/// Finds the widest smoothing that keeps the tolerance. The curve is outside it only if it is so
/// without smoothing.
Smoothed widest(const Program& p, const Resampled& r, const TipPolyline& line, Group group,
                double most, double tolerance) {
  auto fits = static_cast<std::size_t>(most / (2.0 * r.d));
  Smoothed best = smoothed(p, r, line, group, fits, tolerance);
  if (best.within) return best;
  std::size_t fails = fits;
  fits = 0;
  best = smoothed(p, r, line, group, 0, tolerance);
  while (best.within && fails - fits > 1 && !stopped()) {
    const std::size_t m = fits + (fails - fits) / 2;
    Smoothed next = smoothed(p, r, line, group, m, tolerance);
    if (next.within) {
      best = std::move(next);
      fits = m;
    } else {
      fails = m;
    }
  }
  return best;
}

Path assembled(const Program& p, const Resampled& r, Smoothed tip, Smoothed bevel, Smoothed turn) {
  Path path;
  path.d = r.d;
  path.coordinates = p.coordinates;
  std::size_t t = 0, b = 0, n = 0;
  for (const Coordinate& c : p.coordinates) {
    path.control.push_back(std::move(c.group == Group::tip     ? tip.control[t++]
                                     : c.group == Group::bevel ? bevel.control[b++]
                                                               : turn.control[n++]));
  }
  path.deviation_tip = tip.deviation;
  path.deviation_b = bevel.deviation / kBevelWeight;
  path.sag_tip = r.sag_tip;
  path.sag_b = r.sag_b;
  path.at_point = p.lengths();
  return path;
}

}  // namespace

std::vector<double> box2(const std::vector<double>& x, std::size_t m) {
  std::vector<double> out = mean(mean(x, m), m);
  out.front() = x.front();
  out.back() = x.back();
  return out;
}

Result<Path> smooth_path(const Program& p, double eps_tip, Angle eps_b) {
  if (!(eps_tip >= kLeastTip)) {
    return fail({ErrorCode::out_of_range, "motion/eps_tip", eps_tip, kLeastTip, "mm", {}});
  }
  if (!(eps_b.rad() >= kLeastBevel)) {
    return fail({ErrorCode::out_of_range, "motion/eps_b", eps_b.deg(), 0.01, "deg", {}});
  }
  const double bevel = eps_b.rad() * kBevelWeight;
  const TipPolyline line(p);
  // Without smoothing the curve is off by at most d / 3, so the halving ends.
  for (double d = kSpacing;; d *= 0.5) {
    TRY(const auto samples, resample(p, d, eps_tip, eps_b.rad()));
    Smoothed tip = widest(p, samples, line, Group::tip, p.widest, eps_tip);
    Smoothed turn = widest(p, samples, line, Group::turn, 0.0, eps_tip);
    Smoothed swing = widest(p, samples, line, Group::bevel, kWidestBevel, bevel);
    if (stopped()) return fail({.code = ErrorCode::cancelled});
    if (tip.within && swing.within) {
      return assembled(p, samples, std::move(tip), std::move(swing), std::move(turn));
    }
  }
}

}  // namespace tubecut::motion
