#pragma once

namespace tubecut {

/// Eight numbers side by side, each reckoned by itself: an operation has the same bits in two, four
/// or eight lanes of the CPU, as wide as the function around it is compiled (`TUBECUT_WIDE`,
/// base/lanes.hpp). Handed on by reference, or by functions that are always inlined (no lambda
/// returns one): in which registers it is passed depends on that width. So does how it is aligned,
/// so that what has packs as members is `alignas(sizeof(Pack))`.
using Pack [[gnu::vector_size(64)]] = double;

#define TUBECUT_INLINE [[gnu::always_inline]] inline
/// Before a function that is compiled for several lanes: with all that it calls. clang has no such
/// clones; there what is always inlined is wide, and lambdas may not be.
#ifdef __clang__
#define TUBECUT_WHOLE
#else
#define TUBECUT_WHOLE [[gnu::flatten]]
#endif

/// Of how many of what a pack is; a number by itself is a pack of one.
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

/// In each lane what is `by` lanes further on, round the pack.
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

/// By halves, whatever the lanes of the CPU.
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
