#pragma once

/// Loops over arrays in the widest lanes of the CPU. The bits are the same for each width, because
/// each entry is computed separately, in the written order, and nothing is contracted.
///
/// Put `TUBECUT_WIDE` before a function that loops over arrays: it is compiled once more for each
/// wider lane, and the process picks the widest at start. List sources with such loops under
/// `tubecut_loops` in their CMakeLists.txt, which allows the compiler to vectorise them. Builds
/// with sanitizers have one width, because a sanitizer starts after that choice.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && !defined(TUBECUT_SANITIZED)
#define TUBECUT_WIDE [[gnu::target_clones("default", "avx", "avx512f")]]
#else
#define TUBECUT_WIDE
#endif
