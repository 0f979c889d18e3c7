#pragma once

#include <cstddef>

/// For `elementary` and its test only: SLEEF's reproducible functions over arrays, by lane width.
/// All widths give the same bits.
namespace tubecut::elementary {

struct Lanes {
  int width;
  void (*sincos)(const double* x, double* sin, double* cos, std::size_t n);
  void (*tan)(const double* x, double* out, std::size_t n);
  void (*cos)(const double* x, double* out, std::size_t n);
  void (*atan2)(const double* y, const double* x, double* out, std::size_t n);
  void (*quick_atan2)(const double* y, const double* x, double* out, std::size_t n);
};

/// Returns the functions for every CPU.
[[nodiscard]] const Lanes& narrow_lanes();
#if defined(__x86_64__)
/// Return the functions for a CPU with AVX and with AVX-512.
[[nodiscard]] const Lanes& wide_lanes();
[[nodiscard]] const Lanes& widest_lanes();
#endif

}  // namespace tubecut::elementary
