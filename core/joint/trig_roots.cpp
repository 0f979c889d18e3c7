#include "core/joint/trig_roots.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/base/lanes.hpp"

namespace tubecut::joint {
namespace {

constexpr int kSweeps = 80;
constexpr double kSettled = 1e-9;  // relative to a root: its next change is the cube of it
constexpr double kOnCircle = 3e-3;
constexpr std::size_t kMost = 8;  // roots, all corrected at once

/// Arrays of complex numbers.
// An aggregate, initialised with {}, because clang 16 omits a constructor that functions for
// several lanes call.
struct Row {
  std::array<double, kMost> re, im;
};

/// Returns unequal angles and sizes, so that no symmetry of the roots stalls the iteration.
Row starts(std::size_t degree) {
  Row w{};
  for (std::size_t k = 0; k < kMost; ++k) {
    const double turn = (static_cast<double>(k) + 0.1 * static_cast<double>(k % 3)) * kTwoPi;
    const auto at = elementary::sincos(0.4 + turn / static_cast<double>(degree));
    const double size = 1.0 + 0.03 * (static_cast<double>(k % 4) - 1.4);
    w.re[k] = size * at.cos;
    w.im[k] = size * at.sin;
  }
  return w;
}

/// Computes the repulsion of each root by the others: the sum of 1 / (w - other).
Row repulsion(const Row& w, std::size_t degree) {
  Row out{};
  for (std::size_t j = 0; j < degree; ++j) {
    const double re = w.re[j], im = w.im[j];
    for (std::size_t k = 0; k < kMost; ++k) {
      const double dr = w.re[k] - re, di = w.im[k] - im;
      const double square = dr * dr + di * di;
      const double inverse =
          square > 0.0 ? 1.0 / square : 0.0;  // zero for itself, and for coinciding roots
      out.re[k] += dr * inverse;
      out.im[k] -= di * inverse;
    }
  }
  return out;
}

/// Applies one Aberth correction to all roots of sum c[k] w^k; returns the largest relative change.
/// Outside the unit circle it uses the reversed polynomial, so that no power of w grows: its
/// coefficients are the conjugates. Newton's step p/p' is top/below there with top = w q, below = n
/// q - x q', x = 1/w.
TUBECUT_WIDE double sweep(const Complex* c, std::size_t degree, Row& w) {
  const Row apart = repulsion(w, degree);
  Row x{}, value{}, slope{};
  std::array<double, kMost> side{}, inside{};
  for (std::size_t k = 0; k < kMost; ++k) {
    const double square = w.re[k] * w.re[k] + w.im[k] * w.im[k];
    inside[k] = square <= 1.0 ? 1.0 : 0.0;
    side[k] = square <= 1.0 ? 1.0 : -1.0;
    x.re[k] = square <= 1.0 ? w.re[k] : w.re[k] / square;
    x.im[k] = square <= 1.0 ? w.im[k] : -w.im[k] / square;
  }
  for (std::size_t m = degree + 1; m-- > 0;) {
    const double re = c[m].re, im = c[m].im;
    for (std::size_t k = 0; k < kMost; ++k) {
      const double sr = slope.re[k] * x.re[k] - slope.im[k] * x.im[k] + value.re[k];
      const double si = slope.re[k] * x.im[k] + slope.im[k] * x.re[k] + value.im[k];
      const double vr = value.re[k] * x.re[k] - value.im[k] * x.im[k] + re;
      const double vi = value.re[k] * x.im[k] + value.im[k] * x.re[k] + side[k] * im;
      slope.re[k] = sr;
      slope.im[k] = si;
      value.re[k] = vr;
      value.im[k] = vi;
    }
  }
  const auto n = static_cast<double>(degree);
  std::array<double, kMost> change{};
  for (std::size_t k = 0; k < kMost; ++k) {
    const bool in = inside[k] > 0.0;
    const double tr = in ? value.re[k] : w.re[k] * value.re[k] - w.im[k] * value.im[k];
    const double ti = in ? value.im[k] : w.re[k] * value.im[k] + w.im[k] * value.re[k];
    const double xr = x.re[k] * slope.re[k] - x.im[k] * slope.im[k];
    const double xi = x.re[k] * slope.im[k] + x.im[k] * slope.re[k];
    const double br =
        (in ? slope.re[k] : n * value.re[k] - xr) - (tr * apart.re[k] - ti * apart.im[k]);
    const double bi =
        (in ? slope.im[k] : n * value.im[k] - xi) - (tr * apart.im[k] + ti * apart.re[k]);
    const double below = br * br + bi * bi;
    const double inverse = below > 0.0 ? 1.0 / below : 0.0;
    const double dr = (tr * br + ti * bi) * inverse, di = (ti * br - tr * bi) * inverse;
    const double size = dr * dr + di * di;
    const bool finite = size < 1e300;
    w.re[k] -= finite ? dr : 0.0;
    w.im[k] -= finite ? di : 0.0;
    change[k] = finite ? size / (w.re[k] * w.re[k] + w.im[k] * w.im[k] + 1e-300) : 0.0;
  }
  return std::sqrt(*std::max_element(change.begin(), change.begin() + static_cast<long>(degree)));
}

/// Finds all roots by Aberth's iteration: for polynomials that are zero to rounding nearly
/// everywhere.
RootPhases by_all_roots(const Complex* c, std::size_t degree) {
  Row w = starts(degree);
  for (int i = 0; i < kSweeps && sweep(c, degree, w) > kSettled; ++i) {
  }
  RootPhases phases;
  for (std::size_t k = 0; k < degree; ++k)
    if (std::abs(modulus({w.re[k], w.im[k]}) - 1.0) < kOnCircle)
      phases.add(elementary::atan2(w.im[k], w.re[k]), false);
  return phases;
}

/// A phase with its cosine and sine.
struct PhasePoint {
  double phi, cos, sin;

  /// Returns it rotated by at most the width of a first cell: the series has an error of 1e-14.
  [[nodiscard]] PhasePoint turned(double by) const {
    const double q = by * by;
    const double c = 1.0 - q * (0.5 - q * (1.0 / 24.0 - q * (1.0 / 720.0 - q / 40320.0)));
    const double s = by * (1.0 - q * (1.0 / 6.0 - q * (1.0 / 120.0 - q / 5040.0)));
    return {phi + by, cos * c - sin * s, sin * c + cos * s};
  }
};

/// The first cells around the circle: their middles, and the cosines and sines of every multiple
/// there.
struct Cells {
  static constexpr std::size_t kNumber = 32;
  static constexpr double kHalf = kPi / kNumber;
  using OfEach = std::array<double, kNumber>;

  std::array<PhasePoint, kNumber> middle;
  std::array<OfEach, kMost / 2 + 1> cos{}, sin{};

  Cells() {
    for (std::size_t j = 0; j < kNumber; ++j) {
      const double phi = (2.0 * static_cast<double>(j) + 1.0) * kHalf - kPi;
      const auto at = elementary::sincos(phi);
      middle[j] = {phi, at.cos, at.sin};
      double c = 1.0, s = 0.0;
      for (std::size_t k = 1; k < cos.size(); ++k) {
        const double next = c * at.cos - s * at.sin;
        s = s * at.cos + c * at.sin;
        c = next;
        cos[k][j] = c;
        sin[k][j] = s;
      }
    }
  }
};

/// mean + sum of cosine[k] cos(k phi) + sine[k] sin(k phi).
struct Harmonics {
  std::size_t order;
  double mean;
  std::array<double, kMost / 2 + 1> cosine{}, sine{};
};

/// Computes for each cell a lower bound of the wave's magnitude: below zero if it may cross zero.
TUBECUT_WIDE void nearest_to_zero(const Harmonics& wave, const Cells& cells, double bend,
                                  Cells::OfEach& out) {
  Cells::OfEach value, slope{};
  value.fill(wave.mean);
  for (std::size_t k = 1; k <= wave.order; ++k) {
    const auto n = static_cast<double>(k);
    const double a = wave.cosine[k], b = wave.sine[k];
    const auto &c = cells.cos[k], &s = cells.sin[k];
    for (std::size_t j = 0; j < Cells::kNumber; ++j) {
      value[j] += a * c[j] + b * s[j];
      slope[j] += n * (b * c[j] - a * s[j]);
    }
  }
  for (std::size_t j = 0; j < Cells::kNumber; ++j)
    out[j] = std::abs(value[j]) - Cells::kHalf * (std::abs(slope[j]) + 0.5 * (bend * Cells::kHalf));
}

/// The polynomial as a real wave, and the search of its zeros around the circle. If the bounds of a
/// cell exclude zeros, it is skipped; if the wave only rises or falls in it, it has at most one, by
/// Newton; otherwise it is halved.
class Wave {
 public:
  Wave(const Complex* c, std::size_t degree) : is_{degree / 2, c[degree / 2].re} {
    largest_ = std::abs(is_.mean);
    for (std::size_t k = 1; k <= is_.order; ++k) {
      is_.cosine[k] = 2.0 * c[is_.order + k].re;
      is_.sine[k] = -2.0 * c[is_.order + k].im;
      const double size = elementary::hypot(is_.cosine[k], is_.sine[k]);
      const auto n = static_cast<double>(k);
      largest_ += size;
      bend_ += n * n * size;
    }
    noise_ = kNoise * largest_;
  }

  /// Returns false when too many cells may contain a zero.
  [[nodiscard]] bool search(RootPhases& found) {
    static const Cells kCells;
    Cells::OfEach nearest;
    nearest_to_zero(is_, kCells, bend_, nearest);
    for (std::size_t j = 0; j < Cells::kNumber; ++j)
      if (!(nearest[j] > noise_) && !find_roots(kCells.middle[j], Cells::kHalf, found))
        return false;
    return true;
  }

 private:
  static constexpr double kNarrow = 1e-6;  // rad, half a cell: a zero of even order, or nearly one
  static constexpr double kNoise =
      1e-10;  // of the wave's largest possible value: a zero to rounding
  static constexpr int kMaxCells = 1000;
  static constexpr int kSteps = 60;

  struct At {
    double value, slope, bend;
  };
  [[nodiscard]] At at(const PhasePoint& p) const {
    At out{is_.mean, 0.0, 0.0};
    double c = 1.0, s = 0.0;
    for (std::size_t k = 1; k <= is_.order; ++k) {
      const double next = c * p.cos - s * p.sin;
      s = s * p.cos + c * p.sin;
      c = next;
      const auto n = static_cast<double>(k);
      const double term = is_.cosine[k] * c + is_.sine[k] * s;
      out.value += term;
      out.slope += n * (is_.sine[k] * c - is_.cosine[k] * s);
      out.bend -= n * n * term;
    }
    return out;
  }

  [[nodiscard]] bool find_roots(const PhasePoint& middle, double half, RootPhases& found) {
    if (++cells_ > kMaxCells) return false;
    const At here = at(middle);
    const double turn = bend_ * half;  // maximum change of the slope
    if (std::abs(here.value) - half * (std::abs(here.slope) + 0.5 * turn) > noise_) return true;
    if (std::abs(here.slope) > turn) return close(middle, half, here, found);
    if (half > kNarrow)
      return find_roots(middle.turned(-0.5 * half), 0.5 * half, found) &&
             find_roots(middle.turned(0.5 * half), 0.5 * half, found);
    const double step = -here.slope / here.bend;
    const double phi = middle.phi + (std::abs(step) <= 2.0 * half ? step : 0.0);
    if (found.last() && phi - *found.last() < 8.0 * kNarrow) return true;
    return found.add(phi, false);
  }

  /// Finds the zero of a cell in which the wave only rises or falls, if the values at its ends
  /// permit one.
  [[nodiscard]] bool close(const PhasePoint& middle, double half, const At& here,
                           RootPhases& found) {
    const double rise = here.slope > 0.0 ? 1.0 : -1.0;
    const double low = rise * at(middle.turned(-half)).value;
    const double high = rise * at(middle.turned(half)).value;
    if (low > noise_ || high < -noise_) return true;
    double before = -half, after = half, off = 0.0;
    At there = here;
    for (int k = 0; k < kSteps; ++k) {
      (rise * there.value < 0.0 ? before : after) = off;
      double next = off - there.value / there.slope;
      if (!(next >= before && next <= after)) next = before + 0.5 * (after - before);
      const bool still = std::abs(next - off) <= kStill;
      off = next;
      if (still) break;
      there = at(middle.turned(off));
    }
    const bool sharp = noise_ < kSharp * std::abs(there.slope);
    return found.add(middle.phi + off, sharp);
  }

  static constexpr double kStill = 1e-14;  // rad
  static constexpr double kSharp = 1e-6;   // rad: the shift of the zero by `noise_`

  Harmonics is_;
  double largest_ = 0.0, bend_ = 0.0, noise_ = 0.0;
  int cells_ = 0;
};

}  // namespace

double modulus(Complex z) { return elementary::hypot(z.re, z.im); }

RootPhases root_phases(const Complex* coefficients, std::size_t terms) {
  double largest = 0.0;
  for (std::size_t k = 0; k < terms; ++k) largest = std::max(largest, modulus(coefficients[k]));
  // c[-k] is the conjugate of c[k]: if one end vanishes, so does the other.
  while (terms > 1 && modulus(coefficients[0]) <= 1e-16 * largest) {
    ++coefficients;
    terms -= 2;
  }
  RootPhases phases;
  if (terms < 3) return phases;
  if (Wave(coefficients, terms - 1).search(phases)) return phases;
  return by_all_roots(coefficients, terms - 1);
}

}  // namespace tubecut::joint
