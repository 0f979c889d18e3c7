#include "core/joint/section/flat_sheets.hpp"

#include <algorithm>
#include <cmath>

#include "core/math/search.hpp"

namespace tubecut::joint::detail {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr std::size_t kTerms = 5;  // of a polynomial of degree 4
using Polynomial = std::array<double, kTerms>;

constexpr double kBeyond = 1e-9;    // shares looked at beyond both ends
constexpr double kLeading = 1e-13;  // of the largest coefficient: no higher degree
constexpr double kTouches = 1e-6;   // of the largest coefficient: a root of even order, or none

double value(const Polynomial& p, double x) {
  double out = 0.0;
  for (std::size_t k = kTerms; k-- > 0;) out = out * x + p[k];
  return out;
}

std::size_t degree(const Polynomial& p) {
  double most = 0.0;
  for (const double c : p) most = std::max(most, std::abs(c));
  std::size_t out = kTerms - 1;
  while (out > 0 && !(std::abs(p[out]) > kLeading * most)) --out;
  return out;
}

/// Places in [0, 1] where the polynomial changes its sign or nearly touches zero: between
/// neighbouring extremes it is monotone.
std::vector<double> roots(const Polynomial& p) {
  const auto n = degree(p);
  if (n == 0) return {};
  Polynomial slope{};
  for (std::size_t k = 1; k <= n; ++k) slope[k - 1] = static_cast<double>(k) * p[k];
  std::vector<double> stops{-kBeyond};
  double most = 0.0;
  for (const double c : p) most = std::max(most, std::abs(c));
  std::vector<double> out;
  if (n > 1)
    for (const double x : roots(slope)) {
      stops.push_back(x);
      if (std::abs(value(p, x)) <= kTouches * most) out.push_back(x);
    }
  stops.push_back(1.0 + kBeyond);
  std::ranges::sort(stops);
  const auto at = [&](double x) { return value(p, x); };
  for (std::size_t k = 0; k + 1 < stops.size(); ++k)
    if ((at(stops[k]) > 0.0) != (at(stops[k + 1]) > 0.0))
      out.push_back(math::sign_change(at, stops[k], stops[k + 1]));
  std::ranges::sort(out);
  return out;
}

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial out{};
  for (std::size_t i = 0; i < kTerms; ++i)
    for (std::size_t j = 0; i + j < kTerms; ++j) out[i + j] += a[i] * b[j];
  return out;
}

Polynomial sum(const Polynomial& a, double factor, const Polynomial& b) {
  Polynomial out{};
  for (std::size_t k = 0; k < kTerms; ++k) out[k] = a[k] + factor * b[k];
  return out;
}

}  // namespace

std::vector<PlaneSheets> plane_sheets(const PreparedCutter& cutter, double radius) {
  const double wide = 2.0 * radius;
  const auto near = sheets(cutter, radius), far = sheets(cutter, wide);
  std::vector<PlaneSheets> out;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const auto& mid = near[i].mid.c;
    const auto& q = near[i].square.c;
    // On a circle x^2 + y^2 is a constant: a second circle tells the two apart.
    const double trace = 2.0 * (far[i].square.c[2].re - q[2].re) / (wide * wide - radius * radius);
    const double unlike = 4.0 * q[4].re / (radius * radius);
    const double mixed = -4.0 * q[4].im / (radius * radius);
    Matrix2d bend;
    bend << 0.5 * (trace + unlike), 0.5 * mixed, 0.5 * mixed, 0.5 * (trace - unlike);
    out.push_back({.mid = mid[1].re,
                   .mid_slope = Vector2d(mid[2].re, -mid[2].im) * (2.0 / radius),
                   .square = q[2].re - 0.5 * trace * radius * radius,
                   .square_slope = Vector2d(q[3].re, -q[3].im) * (2.0 / radius),
                   .square_bend = bend,
                   .size = near[i].size,
                   .curved = near[i].curved});
  }
  return out;
}

LineSheets along_line(const PlaneSheets& s, const Vector2d& from, const Vector2d& way) {
  const Vector2d bend = s.square_bend * from;
  return {.mid = {s.mid + s.mid_slope.dot(from), s.mid_slope.dot(way)},
          .square = {s.square + s.square_slope.dot(from) + from.dot(bend),
                     s.square_slope.dot(way) + 2.0 * way.dot(bend), way.dot(s.square_bend * way)},
          .curved = s.curved};
}

std::vector<double> crossings(const LineSheets& a, const LineSheets& b) {
  const Polynomial apart{a.mid[0] - b.mid[0], a.mid[1] - b.mid[1]};
  if (!a.curved && !b.curved) return roots(apart);
  const Polynomial qa{a.square[0], a.square[1], a.square[2]},
      qb{b.square[0], b.square[1], b.square[2]};
  const auto apart2 = product(apart, apart);
  if (!b.curved) return roots(sum(apart2, -1.0, qa));
  if (!a.curved) return roots(sum(apart2, -1.0, qb));
  const auto unlike = sum(qa, -1.0, qb);
  return roots(sum(sum(product(unlike, unlike), -2.0, product(apart2, sum(qa, 1.0, qb))), 1.0,
                   product(apart2, apart2)));
}

}  // namespace tubecut::joint::detail
