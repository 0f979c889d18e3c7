#include "core/base/elementary_lanes.hpp"

#include <sleef.h>

// Compiled once for every width. The linker may share functions between these objects, so they must
// hold no wide instruction: include only SLEEF and the compiler's own headers here.
#if defined(__AVX512F__)
#define TUBECUT_SLEEF(name, accuracy) Sleef_cinz_##name##d8_##accuracy##avx512fnofma
#elif defined(__AVX__)
#define TUBECUT_SLEEF(name, accuracy) Sleef_cinz_##name##d4_##accuracy##avx
#elif defined(__SSE2__)
#define TUBECUT_SLEEF(name, accuracy) Sleef_cinz_##name##d2_##accuracy##sse2
#else
#define TUBECUT_SLEEF(name, accuracy) Sleef_cinz_##name##d1_##accuracy##purec
#endif

namespace tubecut::elementary {
namespace {

#if defined(__AVX512F__)
using Pack = __m512d;
Pack load(const double* from) { return _mm512_loadu_pd(from); }
void store(double* to, Pack pack) { _mm512_storeu_pd(to, pack); }
#elif defined(__AVX__)
using Pack = __m256d;
Pack load(const double* from) { return _mm256_loadu_pd(from); }
void store(double* to, Pack pack) { _mm256_storeu_pd(to, pack); }
#elif defined(__SSE2__)
using Pack = __m128d;
Pack load(const double* from) { return _mm_loadu_pd(from); }
void store(double* to, Pack pack) { _mm_storeu_pd(to, pack); }
#else
using Pack = double;
Pack load(const double* from) { return *from; }
void store(double* to, Pack pack) { *to = pack; }
#endif

constexpr std::size_t kWidth = sizeof(Pack) / sizeof(double);

/// The last entries of an array, in a pack padded with ones.
struct Rest {
  double values[kWidth];
  Rest(const double* from, std::size_t n) {
    for (std::size_t k = 0; k < kWidth; ++k) values[k] = k < n ? from[k] : 1.0;
  }
};
void store_rest(double* to, Pack pack, std::size_t n) {
  double values[kWidth];
  store(values, pack);
  for (std::size_t k = 0; k < n; ++k) to[k] = values[k];
}

template <class F>
void unary(F f, const double* x, double* out, std::size_t n) {
  std::size_t i = 0;
  for (; i + kWidth <= n; i += kWidth) store(out + i, f(load(x + i)));
  if (i < n) store_rest(out + i, f(load(Rest(x + i, n - i).values)), n - i);
}

template <class F>
void binary(F f, const double* y, const double* x, double* out, std::size_t n) {
  std::size_t i = 0;
  for (; i + kWidth <= n; i += kWidth) store(out + i, f(load(y + i), load(x + i)));
  if (i < n)
    store_rest(out + i, f(load(Rest(y + i, n - i).values), load(Rest(x + i, n - i).values)), n - i);
}

void sincos_of(const double* x, double* sin, double* cos, std::size_t n) {
  std::size_t i = 0;
  for (; i + kWidth <= n; i += kWidth) {
    const auto both = TUBECUT_SLEEF(sincos, u10)(load(x + i));
    store(sin + i, both.x);
    store(cos + i, both.y);
  }
  if (i == n) return;
  const auto both = TUBECUT_SLEEF(sincos, u10)(load(Rest(x + i, n - i).values));
  store_rest(sin + i, both.x, n - i);
  store_rest(cos + i, both.y, n - i);
}
void tan_of(const double* x, double* out, std::size_t n) {
  unary([](Pack p) { return TUBECUT_SLEEF(tan, u10)(p); }, x, out, n);
}
void cos_of(const double* x, double* out, std::size_t n) {
  unary([](Pack p) { return TUBECUT_SLEEF(cos, u10)(p); }, x, out, n);
}
void atan2_of(const double* y, const double* x, double* out, std::size_t n) {
  binary([](Pack a, Pack b) { return TUBECUT_SLEEF(atan2, u10)(a, b); }, y, x, out, n);
}
void quick_atan2_of(const double* y, const double* x, double* out, std::size_t n) {
  binary([](Pack a, Pack b) { return TUBECUT_SLEEF(atan2, u35)(a, b); }, y, x, out, n);
}

constexpr Lanes kLanes{
    static_cast<int>(kWidth), sincos_of, tan_of, cos_of, atan2_of, quick_atan2_of};

}  // namespace

#if defined(__AVX512F__)
const Lanes& widest_lanes() { return kLanes; }
#elif defined(__AVX__)
const Lanes& wide_lanes() { return kLanes; }
#else
const Lanes& narrow_lanes() { return kLanes; }
#endif

}  // namespace tubecut::elementary
