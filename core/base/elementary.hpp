#pragma once

#include <span>

/// The only access of core to transcendental functions.
///
/// The results are bit-identical on every x86-64 and arm64 CPU, because they come from SLEEF's
/// reproducible non-FMA variants (`cinz`). The C library is not used, because its own CPU dispatch
/// changes the last bits. Call `std::sqrt`, `std::abs`, `std::floor` and the like directly: IEEE
/// 754 makes them exact.
///
/// Accuracy  1 ulp (SLEEF u10) for each function; `quick_atan2` 3.5 ulp (u35) at two fifths of the
///           cost: worst seen of 20 million 5.1e-16 rad; `hypot` 1 ulp for arguments within
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
/// Computes sqrt(x^2 + y^2) without scaling, because lengths here are far from overflow.
[[nodiscard]] double hypot(double x, double y);
[[nodiscard]] double hypot(double x, double y, double z);

/// Compute arrays of one length, several entries in parallel; the bits equal those of the functions
/// above.
void sincos(std::span<const double> x, std::span<double> sin, std::span<double> cos);
void tan(std::span<const double> x, std::span<double> out);
void cos(std::span<const double> x, std::span<double> out);
void atan2(std::span<const double> y, std::span<const double> x, std::span<double> out);
void quick_atan2(std::span<const double> y, std::span<const double> x, std::span<double> out);

}  // namespace tubecut::elementary
