#include "core/base/elementary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

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
  expect_one_ulp(
      sin, [](long double x) { return std::sin(x); }, -50, 50);
  expect_one_ulp(
      cos, [](long double x) { return std::cos(x); }, -50, 50);
  expect_one_ulp(
      tan, [](long double x) { return std::tan(x); }, -50, 50);
  expect_one_ulp(
      asin, [](long double x) { return std::asin(x); }, -1, 1);
  expect_one_ulp(
      acos, [](long double x) { return std::acos(x); }, -1, 1);
  expect_one_ulp(
      atan, [](long double x) { return std::atan(x); }, -100, 100);
  expect_one_ulp(
      exp, [](long double x) { return std::exp(x); }, -50, 50);
  expect_one_ulp(
      log, [](long double x) { return std::log(x); }, 1e-6, 1e6);
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

}  // namespace
}  // namespace tubecut::elementary
