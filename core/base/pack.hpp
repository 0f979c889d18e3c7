#pragma once

namespace tubecut {

/// Eight numbers, each computed separately: an operation has the same bits in two, four or eight
/// lanes of the CPU, as wide as the compilation of the surrounding function (`TUBECUT_WIDE`,
/// base/lanes.hpp). Pass a pack by reference, or through functions that are always inlined (never
/// return one from a lambda), because its registers depend on that width. Its alignment does too,
/// so a type with packs as members is `alignas(sizeof(Pack))`.
using Pack [[gnu::vector_size(64)]] = double;

#define TUBECUT_INLINE [[gnu::always_inline]] inline
/// Put it before a function that is compiled for several lanes; it covers all functions that it
/// calls. clang has no such clones: there a function is wide if it is always inlined; a lambda may
/// stay narrow.
#ifdef __clang__
#define TUBECUT_WHOLE
#else
#define TUBECUT_WHOLE [[gnu::flatten]]
#endif

/// The element count of a pack; a single number is a pack of one.
template <class Numbers>
struct PackOf {
  using Real = Numbers;
  static constexpr int kSize = 1;
};
template <>
struct PackOf<Pack> {
  using Real = double;
  static constexpr int kSize = 8;
};

template <class Numbers>
TUBECUT_INLINE auto lane(const Numbers& pack, int k) {
  if constexpr (PackOf<Numbers>::kSize == 1)
    return pack;
  else
    return pack[k];
}

template <class Numbers>
TUBECUT_INLINE void set_lane(Numbers& pack, int k, typename PackOf<Numbers>::Real value) {
  if constexpr (PackOf<Numbers>::kSize == 1)
    pack = value;
  else
    pack[k] = value;
}

/// Returns a pack whose lane k holds lane k + `by` of `a`, cyclically.
template <int by, class Numbers>
TUBECUT_INLINE Numbers from_lane(const Numbers& a) {
  if constexpr (PackOf<Numbers>::kSize == 1)
    return a;
  else
    return __builtin_shufflevector(a, a, by % 8, (by + 1) % 8, (by + 2) % 8, (by + 3) % 8,
                                   (by + 4) % 8, (by + 5) % 8, (by + 6) % 8, (by + 7) % 8);
}

template <class Numbers>
TUBECUT_INLINE Numbers larger(const Numbers& a, const Numbers& b) {
  return a > b ? a : b;
}

/// Returns the sum by halves, so its bits do not depend on the CPU's lanes.
template <class Numbers>
TUBECUT_INLINE auto sum_of(const Numbers& a) {
  if constexpr (PackOf<Numbers>::kSize == 1)
    return a;
  else
    return ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7]));
}

template <class Numbers>
TUBECUT_INLINE auto largest_of(const Numbers& a) {
  auto most = lane(a, 0);
  for (int k = 1; k < PackOf<Numbers>::kSize; ++k) most = lane(a, k) > most ? lane(a, k) : most;
  return most;
}

}  // namespace tubecut
