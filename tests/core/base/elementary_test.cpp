#include "core/base/elementary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "core/base/elementary_lanes.hpp"

namespace tubecut::elementary {
namespace {

// The header promises 1 ulp; the reference is the C library in 80-bit long double.
template <class Ours, class Reference>
void expect_one_ulp(Ours ours, Reference reference, double low, double high) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(low, high);
  for (int i = 0; i < 20'000; ++i) {
    const double x = any(random);
    const long double want = reference(static_cast<long double>(x));
    const double near = static_cast<double>(want);
    const double ulp = std::nextafter(std::abs(near), INFINITY) - std::abs(near);
    ASSERT_LE(std::abs(static_cast<long double>(ours(x)) - want),
              1.0L * static_cast<long double>(ulp))
        << x;
  }
}

TEST(Elementary, EachWithinOneUlp) {
  using One = double (*)(double);  // not of arrays
  expect_one_ulp(
      sin, [](long double x) { return std::sin(x); }, -50, 50);
  expect_one_ulp(
      One(cos), [](long double x) { return std::cos(x); }, -50, 50);
  expect_one_ulp(
      One(tan), [](long double x) { return std::tan(x); }, -50, 50);
  expect_one_ulp(
      asin, [](long double x) { return std::asin(x); }, -1, 1);
  expect_one_ulp(
      acos, [](long double x) { return std::acos(x); }, -1, 1);
  expect_one_ulp(
      atan, [](long double x) { return std::atan(x); }, -100, 100);
  expect_one_ulp(
      exp, [](long double x) { return std::exp(x); }, -50, 50);
  expect_one_ulp(
      cbrt, [](long double x) { return std::cbrt(x); }, -1e6, 1e6);
  expect_one_ulp([](double y) { return atan2(y, -0.7); },
                 [](long double y) { return std::atan2(y, -0.7L + (0.7L - 0.7)); }, -3, 3);
}

TEST(Elementary, SinCosWithinOneUlp) {
  expect_one_ulp([](double x) { return sincos(x).sin; }, [](long double x) { return std::sin(x); },
                 -50, 50);
  expect_one_ulp([](double x) { return sincos(x).cos; }, [](long double x) { return std::cos(x); },
                 -50, 50);
}

TEST(Elementary, QuickAtan2WithinItsBound) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int i = 0; i < 200'000; ++i) {
    const double y = any(random), x = any(random);
    const long double want = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    ASSERT_LE(std::abs(static_cast<long double>(quick_atan2(y, x)) - want), 1e-15L)
        << y << ' ' << x;
  }
}

/// Of arrays, in every width the CPU has, the same bits as one by one; of any length.
TEST(Elementary, ArraysHaveTheBitsOfTheirEntries) {
  std::vector<const Lanes*> all{&narrow_lanes()};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx")) all.push_back(&wide_lanes());
  if (__builtin_cpu_supports("avx512f")) all.push_back(&widest_lanes());
#endif
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> any(-7, 7);
  for (const std::size_t n : {0, 1, 2, 3, 4, 5, 7, 8, 9, 15, 16, 1001}) {
    std::vector<double> x(n), y(n), a(n), b(n);
    for (std::size_t i = 0; i < n; ++i) {
      x[i] = any(random);
      y[i] = i % 11 == 5 ? 0.0 : any(random);
    }
    for (const auto* lanes : all) {
      lanes->sincos(x.data(), a.data(), b.data(), n);
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_EQ(a[i], sincos(x[i]).sin);
        ASSERT_EQ(b[i], sincos(x[i]).cos);
      }
      lanes->tan(x.data(), a.data(), n);
      lanes->cos(x.data(), b.data(), n);
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_EQ(a[i], tan(x[i]));
        ASSERT_EQ(b[i], cos(x[i]));
      }
      lanes->atan2(y.data(), x.data(), a.data(), n);
      lanes->quick_atan2(y.data(), x.data(), b.data(), n);
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_EQ(a[i], atan2(y[i], x[i]));
        ASSERT_EQ(b[i], quick_atan2(y[i], x[i]));
      }
    }
  }
}

}  // namespace
}  // namespace tubecut::elementary
