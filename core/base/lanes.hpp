#pragma once

/// Arrays in the widest lanes that the CPU has, with the same bits whatever they are: each entry is
/// reckoned by itself, in the order that is written down, and nothing is contracted.
///
/// `TUBECUT_WIDE` stands before a function that loops over arrays: it is compiled once more for
/// each wider lane, and the process takes the widest when it starts. Sources with such loops are
/// listed with `tubecut_loops` in their CMakeLists.txt, which lets the compiler put entries side by
/// side. Sanitizers come too late for that choice, so their builds have one width.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && !defined(TUBECUT_SANITIZED)
#define TUBECUT_WIDE [[gnu::target_clones("default", "avx", "avx512f")]]
#else
#define TUBECUT_WIDE
#endif
