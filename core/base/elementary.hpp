#pragma once

#include <span>

/// The one door of core to the transcendental functions.
///
/// Results are bit-identical on every x86-64 and arm64 CPU: SLEEF's reproducible non-FMA variants
/// (`cinz`), never the C library's, whose own CPU dispatch changes last bits. `std::sqrt`,
/// `std::abs`, `std::floor` and the like are exact by IEEE 754 and are used directly.
///
/// Accuracy  1 ulp (SLEEF u10) for each; `quick_atan2` 3.5 ulp (u35) at two fifths of the price:
///           worst seen of 20 million 5.1e-16 rad; `hypot` 1 ulp for arguments within
///           1e-150..1e150.
namespace tubecut::elementary {

struct SinCos {
  double sin = 0.0;
  double cos = 1.0;
};

[[nodiscard]] SinCos sincos(double x);
[[nodiscard]] double sin(double x);
[[nodiscard]] double cos(double x);
[[nodiscard]] double tan(double x);
[[nodiscard]] double asin(double x);
[[nodiscard]] double acos(double x);
[[nodiscard]] double atan(double x);
[[nodiscard]] double atan2(double y, double x);
[[nodiscard]] double quick_atan2(double y, double x);
[[nodiscard]] double exp(double x);
[[nodiscard]] double pow(double x, double y);
[[nodiscard]] double cbrt(double x);
/// sqrt(x^2 + y^2); lengths here are far from overflow, so no scaling is done.
[[nodiscard]] double hypot(double x, double y);
[[nodiscard]] double hypot(double x, double y, double z);

/// Of arrays of one length, as many side by side as the CPU takes: the bits of the functions above.
void sincos(std::span<const double> x, std::span<double> sin, std::span<double> cos);
void tan(std::span<const double> x, std::span<double> out);
void cos(std::span<const double> x, std::span<double> out);
void atan2(std::span<const double> y, std::span<const double> x, std::span<double> out);
void quick_atan2(std::span<const double> y, std::span<const double> x, std::span<double> out);

}  // namespace tubecut::elementary
