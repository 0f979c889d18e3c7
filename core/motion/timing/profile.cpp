#include "core/motion/timing/profile.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/base/stop.hpp"

namespace tubecut::motion {
namespace {

constexpr double kUnlimited = 1e300;
constexpr double kInside = 1.0 - 1e-12;  // rounding must not violate a row

/// The rows of one interval as conditions of one of its knots: near * a + far * b <= 1.
class Stage {
 public:
  Stage(const HalfPlanes& all, std::size_t i, bool backward)
      : rows_(std::span(all.rows).subspan(all.first[i], all.first[i + 1] - all.first[i])),
        backward_(backward) {}

  /// Returns the largest `a` up to `cap` for which some `b` in 0..most satisfies the rows. The room
  /// for b, its ceiling less its floor, is a concave piecewise linear function of a and at least 0
  /// at 0: from above, its tangents reach its root in at most one step per row.
  [[nodiscard]] double largest_near(double cap, double most) const {
    if (holds(cap, most)) return cap;
    double a = alone(cap);
    for (std::size_t step = 0; step <= rows_.size(); ++step) {
      const Gap gap = gap_at(a, most);
      if (gap.width >= 0.0 || gap.slope >= 0.0) break;
      const double next = a - gap.width / gap.slope;
      if (!(next < a)) break;
      a = std::max(0.0, next);
    }
    return a < cap ? kInside * a : cap;
  }

  /// Returns the largest `b` up to `most` at this `a`.
  [[nodiscard]] double largest_far(double a, double most) const {
    double b = most;
    for (const HalfPlane& row : rows_) {
      const double rest = 1.0 - near(row) * a;
      if (far(row) > 0.0 && far(row) * b > rest) b = rest / far(row);
    }
    return std::max(0.0, b);
  }

 private:
  struct Gap {
    double width;
    double slope;
  };
  [[nodiscard]] double near(const HalfPlane& row) const { return backward_ ? row.start : row.end; }
  [[nodiscard]] double far(const HalfPlane& row) const { return backward_ ? row.end : row.start; }

  [[nodiscard]] bool holds(double a, double b) const {
    return std::ranges::all_of(
        rows_, [&](const HalfPlane& row) { return near(row) * a + far(row) * b <= 1.0; });
  }

  /// Returns the largest `a` that the rows without b permit.
  [[nodiscard]] double alone(double a) const {
    for (const HalfPlane& row : rows_) {
      if (far(row) == 0.0 && near(row) * a > 1.0) a = 1.0 / near(row);
    }
    return a;
  }

  [[nodiscard]] Gap gap_at(double a, double most) const {
    double ceiling = most, ceiling_slope = 0.0, floor = 0.0, floor_slope = 0.0;
    for (const HalfPlane& row : rows_) {
      const double n = near(row), f = far(row), rest = 1.0 - n * a;
      if (f > 0.0 && rest < ceiling * f) {
        ceiling = rest / f;
        ceiling_slope = -n / f;
      } else if (f < 0.0 && rest < floor * f) {
        floor = rest / f;
        floor_slope = -n / f;
      }
    }
    return {ceiling - floor, ceiling_slope - floor_slope};
  }

  std::span<const HalfPlane> rows_;
  bool backward_;
};

/// Returns the largest value at every knot from which the last knot can be reached.
std::vector<double> reaching(std::vector<double> most, const HalfPlanes& rows) {
  const std::size_t n = most.size() - 1;
  for (std::size_t turn = 0; turn < n && !stops(turn); ++turn) {
    const std::size_t i = n - 1 - turn;
    most[i] = Stage(rows, i, true).largest_near(most[i], most[i + 1]);
  }
  return most;
}

/// Returns the largest of those that can also be reached from the first knot.
std::vector<double> reached(std::vector<double> most, const HalfPlanes& rows) {
  for (std::size_t i = 0; i + 1 < most.size() && !stops(i); ++i) {
    most[i + 1] = Stage(rows, i, false).largest_near(most[i + 1], most[i]);
  }
  return most;
}

/// If a row holds both knots down, a faster choice at one of them makes the other slower. Two caps
/// replace it: the corner that it cuts from the box of `bound`, shrunk.
std::vector<double> cornered(std::vector<double> caps, const std::vector<double>& bound,
                             const HalfPlanes& rows) {
  for (std::size_t i = 0; i + 1 < caps.size() && !stops(i); ++i) {
    for (std::size_t r = rows.first[i]; r < rows.first[i + 1]; ++r) {
      const HalfPlane& row = rows.rows[r];
      if (row.start <= 0.0 || row.end <= 0.0) continue;
      const double use = row.start * bound[i] + row.end * bound[i + 1];
      if (use <= 1.0) continue;
      caps[i] = std::min(caps[i], bound[i] / use);
      caps[i + 1] = std::min(caps[i + 1], bound[i + 1] / use);
    }
  }
  return caps;
}

}  // namespace

std::vector<double> largest_profile(std::vector<double> x, double d, const Rows& rows) {
  const std::size_t n = x.size() - 1;
  std::vector<double> slope, shift;
  for (auto* const of : {&slope, &shift}) of->reserve(rows.rows.size());
  for (std::size_t i = 0; i < n && !stops(i); ++i) {
    // Interval by interval, because filling all at once delays a cancellation.
    for (auto* const of : {&slope, &shift}) of->resize(rows.first[i + 1]);
    for (std::size_t r = rows.first[i]; r < rows.first[i + 1]; ++r) {
      const Row& row = rows.rows[r];
      const double below = row.alpha + 2.0 * d * row.beta;
      slope[r] = below > 0.0 ? row.alpha / below : 1.0;
      shift[r] = below > 0.0 ? 2.0 * d * row.c / below : kUnlimited;
      if (row.beta <= 0.0) continue;
      x[i] = std::min(x[i], row.c / row.beta);
      x[i + 1] = std::min(x[i + 1], row.c / row.beta);
    }
  }
  const auto reach = [&](std::size_t i, double from) {
    double most = kUnlimited;
    for (std::size_t r = rows.first[i]; r < rows.first[i + 1]; ++r) {
      most = std::min(most, slope[r] * from + shift[r]);
    }
    return most;
  };
  for (std::size_t i = 0; i < n && !stops(i); ++i) x[i + 1] = std::min(x[i + 1], reach(i, x[i]));
  for (std::size_t turn = 0; turn < n && !stops(turn); ++turn) {
    const std::size_t i = n - 1 - turn;
    x[i] = std::min(x[i], reach(i, x[i + 1]));
  }
  return x;
}

std::vector<double> fastest_within(const std::vector<double>& caps,
                                   const std::vector<double>& bound, const HalfPlanes& rows) {
  const std::vector<double> most = reaching(cornered(caps, bound, rows), rows);
  std::vector<double> x = most;
  for (std::size_t i = 0; i + 1 < x.size() && !stops(i); ++i) {
    x[i + 1] = Stage(rows, i, true).largest_far(x[i], most[i + 1]);
  }
  return x;
}

Profile fastest_profile(const std::vector<double>& caps, const HalfPlanes& rows) {
  std::vector<double> bound = reached(reaching(caps, rows), rows);
  std::vector<double> x = fastest_within(caps, bound, rows);
  return {std::move(x), std::move(bound)};
}

double duration(const std::vector<double>& x, double d) {
  double time = 0.0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    time += 2.0 * d / (std::sqrt(x[i]) + std::sqrt(x[i + 1]));
  }
  return time;
}

}  // namespace tubecut::motion
