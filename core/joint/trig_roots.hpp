#pragma once

#include <array>
#include <cstddef>

namespace tubecut::joint {

/// A complex number with plain arithmetic, because std::complex calls a compiler's own run-time
/// routines, whose last bits differ between compilers.
struct Complex {
  double re = 0.0;
  double im = 0.0;
  friend Complex operator+(Complex a, Complex b) { return {a.re + b.re, a.im + b.im}; }
  friend Complex operator-(Complex a, Complex b) { return {a.re - b.re, a.im - b.im}; }
  friend Complex operator*(Complex a, Complex b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
  }
  friend Complex operator*(double k, Complex a) { return {k * a.re, k * a.im}; }
  friend Complex operator/(Complex a, Complex b) {
    const double n = b.re * b.re + b.im * b.im;
    return {(a.re * b.re + a.im * b.im) / n, (a.im * b.re - a.re * b.im) / n};
  }
};

/// A real trigonometric polynomial, sum over k = -Degree..Degree of c[k + Degree] e^{i k phi}.
template <std::size_t Degree>
struct Trig {
  static constexpr std::size_t kTerms = 2 * Degree + 1;
  std::array<Complex, kTerms> c = {};

  /// Returns mean + cosine cos(k phi) + sine sin(k phi) with k = 1.
  static Trig first_order(double mean, double cosine, double sine) {
    Trig t;
    t.c[Degree] = {mean, 0.0};
    t.c[Degree + 1] = {0.5 * cosine, -0.5 * sine};
    t.c[Degree - 1] = {0.5 * cosine, 0.5 * sine};
    return t;
  }
  /// Returns a bound of the value: the sum of the terms' magnitudes.
  [[nodiscard]] double bound() const;

  friend Trig operator+(Trig a, const Trig& b) {
    for (std::size_t k = 0; k < kTerms; ++k) a.c[k] = a.c[k] + b.c[k];
    return a;
  }
  friend Trig operator-(Trig a, const Trig& b) {
    for (std::size_t k = 0; k < kTerms; ++k) a.c[k] = a.c[k] - b.c[k];
    return a;
  }
  friend Trig operator*(double f, Trig a) {
    for (auto& term : a.c) term = f * term;
    return a;
  }
};

template <std::size_t M, std::size_t N>
[[nodiscard]] Trig<M + N> operator*(const Trig<M>& a, const Trig<N>& b) {
  Trig<M + N> out;
  for (std::size_t i = 0; i < Trig<M>::kTerms; ++i)
    for (std::size_t j = 0; j < Trig<N>::kTerms; ++j) out.c[i + j] = out.c[i + j] + a.c[i] * b.c[j];
  return out;
}

/// A few phases without heap memory.
class RootPhases {
 public:
  struct Phase {
    double phi;
    bool sharp;  // within 1e-6 rad of a zero, despite the rounding of the coefficients
  };
  static constexpr std::size_t kMost = 24;

  /// Returns false when it is full.
  bool add(double phi, bool sharp) {
    if (count_ == kMost) return false;
    phases_[count_++] = {phi, sharp};
    return true;
  }
  [[nodiscard]] const Phase* begin() const { return phases_.data(); }
  [[nodiscard]] const Phase* end() const { return phases_.data() + count_; }
  [[nodiscard]] const double* last() const {
    return count_ > 0 ? &phases_[count_ - 1].phi : nullptr;
  }

 private:
  std::array<Phase, kMost> phases_{};
  std::size_t count_ = 0;
};

/// Finds phases (rad, in [-pi, pi]) near which the trigonometric polynomial may vanish. It divides
/// the circle into cells: the slope and the bound of the second derivative show where no zero is. A
/// simple zero is found by Newton; one of even order, or a near zero, by the slope's zero. None is
/// missed: if the polynomial is zero to rounding over an interval, Aberth's iteration finds all
/// roots, and those within 3e-3 of the unit circle count. Spurious phases occur. Coefficients are
/// those of `Trig::c`; an all-zero polynomial returns none.
/// Accuracy  a simple zero 1e-14 rad of the coefficients' own; one of order m eps^(1/m).
/// Cost      order 4: about 0.5 us, 2 us with zeros of even order.
[[nodiscard]] RootPhases root_phases(const Complex* coefficients, std::size_t terms);

template <std::size_t Degree>
[[nodiscard]] RootPhases root_phases(const Trig<Degree>& t) {
  static_assert(Degree <= 4);
  return root_phases(t.c.data(), t.c.size());
}

[[nodiscard]] double modulus(Complex z);

template <std::size_t Degree>
double Trig<Degree>::bound() const {
  double sum = 0.0;
  for (const auto& term : c) sum += modulus(term);
  return sum;
}

}  // namespace tubecut::joint
