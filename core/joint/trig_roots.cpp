#include "core/joint/trig_roots.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::joint {
namespace {

constexpr int kSweeps = 80;
constexpr double kOnCircle = 3e-3;

struct Polynomial {
  const Complex* c;
  std::size_t degree;
};

/// p(w)/p'(w). Outside the unit circle through the reversed polynomial, so that no power of w
/// grows.
Complex newton_step(const Polynomial& p, Complex w) {
  const bool inside = modulus(w) <= 1.0;
  const Complex x = inside ? w : Complex{1.0, 0.0} / w;
  Complex value{};
  Complex slope{};
  for (std::size_t k = 0; k <= p.degree; ++k) {
    slope = slope * x + value;
    value = value * x + p.c[inside ? p.degree - k : k];
  }
  if (value.re == 0.0 && value.im == 0.0) return {};
  if (inside) return value / slope;
  // p(w) = w^n q(1/w), so p'/p = (n - x q'/q) / w
  const Complex n{static_cast<double>(p.degree), 0.0};
  return w / (n - x * (slope / value));
}

/// Unequal angles and sizes, so that no symmetry of the roots stalls the iteration.
std::vector<Complex> starts(std::size_t degree) {
  std::vector<Complex> w(degree);
  for (std::size_t k = 0; k < degree; ++k) {
    const double turn = (static_cast<double>(k) + 0.1 * static_cast<double>(k % 3)) * kTwoPi;
    const auto at = elementary::sincos(0.4 + turn / static_cast<double>(degree));
    const double size = 1.0 + 0.03 * (static_cast<double>(k % 4) - 1.4);
    w[k] = {size * at.cos, size * at.sin};
  }
  return w;
}

/// One Aberth correction of every root in turn; the largest relative change.
double sweep(const Polynomial& p, std::vector<Complex>& w) {
  double largest = 0.0;
  for (std::size_t k = 0; k < w.size(); ++k) {
    const Complex step = newton_step(p, w[k]);
    Complex repulsion{};
    for (std::size_t j = 0; j < w.size(); ++j) {
      const Complex apart = w[k] - w[j];
      if (j != k && (apart.re != 0.0 || apart.im != 0.0))
        repulsion = repulsion + Complex{1.0, 0.0} / apart;
    }
    const Complex change = step / (Complex{1.0, 0.0} - step * repulsion);
    const double size = modulus(change);
    if (!std::isfinite(size)) continue;
    w[k] = w[k] - change;
    largest = std::max(largest, size / std::max(modulus(w[k]), 1e-300));
  }
  return largest;
}

}  // namespace

double modulus(Complex z) { return elementary::hypot(z.re, z.im); }

std::vector<double> root_phases(const Complex* coefficients, std::size_t terms) {
  double largest = 0.0;
  for (std::size_t k = 0; k < terms; ++k) largest = std::max(largest, modulus(coefficients[k]));
  // c[-k] is the conjugate of c[k]: a vanishing end vanishes on both sides.
  while (terms > 1 && modulus(coefficients[0]) <= 1e-16 * largest) {
    ++coefficients;
    terms -= 2;
  }
  std::vector<double> phases;
  if (terms < 3) return phases;
  const Polynomial p{coefficients, terms - 1};
  auto w = starts(p.degree);
  for (int i = 0; i < kSweeps && sweep(p, w) > 1e-14; ++i) {
  }
  for (const auto root : w)
    if (std::abs(modulus(root) - 1.0) < kOnCircle)
      phases.push_back(elementary::atan2(root.im, root.re));
  return phases;
}

}  // namespace tubecut::joint
