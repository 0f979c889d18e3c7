#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/bevel/smoothing/smoothing.hpp"

/// The envelope written down again as the theory note has it, whole at every evaluation: sweeps
/// stepped by slope at both ends, the upper hull over three periods in (s, e - A s^2/2). Slow; for
/// tests only.
namespace tubecut::bevel {

class PlainEnvelope {
 public:
  PlainEnvelope(const AngleProfile& profile, const EnvelopeSpec& spec)
      : p_(profile),
        k_(spec.limits.slope),
        a_(spec.limits.curvature),
        top_(spec.highest),
        n_(profile.b.size()) {
    for (std::size_t j = 0; j < n_; ++j) {
      const double in = (b(j) - b(j + n_ - 1)) / h(j + n_ - 1);
      const double out = (b(j + 1) - b(j)) / h(j);
      const double lo = in - a_ * h(j + n_ - 1) / 2.0;
      const double hi = out + a_ * h(j) / 2.0;
      corner_.push_back(lo > hi);
      double m = (lo + hi) / 2.0;
      if (lo > hi) m = std::abs(in) <= std::abs(out) ? lo : hi;
      m_.push_back(std::min(std::max(m, -bound(j)), bound(j)));
    }
  }

  std::vector<double> smooth() const {
    const auto e = braked();
    // hull over three periods, s centred on the middle one
    std::vector<double> x, y;
    for (std::size_t i = 0; i < 3 * n_; ++i) {
      x.push_back(p_.s[i % n_] - p_.s[0] + p_.period * (static_cast<double>(i / n_) - 1.5));
      y.push_back(e[i % n_] - a_ * x.back() * x.back() / 2.0);
    }
    std::vector<std::size_t> hull;
    for (std::size_t i = 0; i < 3 * n_; ++i) {
      while (hull.size() > 1) {
        const auto o = hull[hull.size() - 2];
        const auto q = hull.back();
        if ((x[q] - x[o]) * (y[i] - y[o]) - (y[q] - y[o]) * (x[i] - x[o]) < 0.0) break;
        hull.pop_back();
      }
      hull.push_back(i);
    }
    std::vector<double> f(n_);
    for (std::size_t c = 0; c + 1 < hull.size(); ++c) {
      for (std::size_t i = hull[c]; i <= hull[c + 1]; ++i) {
        if (i < n_ || i >= 2 * n_) continue;
        const double t = (x[i] - x[hull[c]]) / (x[hull[c + 1]] - x[hull[c]]);
        f[i - n_] = (1.0 - t) * y[hull[c]] + t * y[hull[c + 1]] + a_ * x[i] * x[i] / 2.0;
      }
    }
    return f;
  }

  void refine() {
    const double share = (3.0 - std::sqrt(5.0)) / 2.0;
    for (int round = 0; round < 3; ++round) {
      for (std::size_t j = 0; j < n_; ++j) {
        if (!corner_[j] || braked()[j] > b(j) + 1e-12 * std::atan(1.0) / 45.0) continue;
        const double now = area();
        const double kept = m_[j];
        const auto at = [&](double m) {
          m_[j] = m;
          return area();
        };
        double left = -bound(j), right = bound(j);
        double x1 = left + share * (right - left), x2 = right - share * (right - left);
        double f1 = at(x1), f2 = at(x2);
        for (int i = 0; i < 12; ++i) {
          if (f2 < f1 - 1e-9 * now) {
            left = x1, x1 = x2, f1 = f2, x2 = right - share * (right - left), f2 = at(x2);
          } else {
            right = x2, x2 = x1, f2 = f1, x1 = left + share * (right - left), f1 = at(x1);
          }
        }
        if (f2 < f1 - 1e-9 * now) x1 = x2, f1 = f2;
        m_[j] = f1 < now - 1e-9 * now ? x1 : kept;
      }
    }
  }

  double area() const {
    const auto f = smooth();
    double sum = 0.0;
    for (std::size_t j = 0; j < n_; ++j) sum += (f[j] - b(j)) * (h(j + n_ - 1) + h(j)) / 2.0;
    return sum;
  }

 private:
  double b(std::size_t j) const { return p_.b[j % n_]; }
  double h(std::size_t j) const {
    j %= n_;
    return j + 1 < n_ ? p_.s[j + 1] - p_.s[j] : p_.period - (p_.s[j] - p_.s[0]);
  }
  double bound(std::size_t j) const {
    return std::min({k_, a_ * p_.period / 4.0, std::sqrt(2.0 * a_ * (top_ - b(j)))});
  }

  /// Travels from the highest B three times round; `sense` 1 or -1.
  void sweep(std::vector<double>& e, int sense) const {
    const auto first =
        static_cast<std::size_t>(std::max_element(p_.b.begin(), p_.b.end()) - p_.b.begin());
    std::vector<double> kept(n_);
    double value = b(first), slope = sense * m_[first];
    std::size_t j = first;
    for (std::size_t visit = 0; visit < 3 * n_; ++visit) {
      const auto to = (j + (sense > 0 ? 1 : n_ - 1)) % n_;
      const double length = h(sense > 0 ? j : to);
      const double braking = std::min(length, (slope + k_) / a_);
      const double end = slope - a_ * braking;
      value += (slope + end) / 2.0 * braking - k_ * (length - braking);
      slope = end;
      j = to;
      if (b(j) >= value) value = b(j), slope = sense * m_[j];
      kept[j] = value;
    }
    for (std::size_t i = 0; i < n_; ++i) e[i] = std::max(e[i], kept[i]);
  }

  std::vector<double> braked() const {
    auto e = p_.b;
    sweep(e, 1);
    sweep(e, -1);
    return e;
  }

  const AngleProfile& p_;
  double k_, a_, top_;
  std::size_t n_;
  std::vector<double> m_;
  std::vector<char> corner_;
};

}  // namespace tubecut::bevel
