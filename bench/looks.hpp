#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <stop_token>

/// For builds with TUBECUT_LOOKS alone, which bench/looks asks: a job's thread says on stderr where
/// it worked for long without a look at its stop token. Stands in the precompiled headers; `|`
/// makes a look also where the other side decides.
namespace tubecut::looks {

constexpr double kLongMs = 4.0;  // of CPU
constexpr std::size_t kCallers = 12;

extern "C" const char __executable_start;  // NOLINT: the linker's

struct Look {
  double ms = 0.0;                            // by the thread's CPU clock
  std::array<std::uintptr_t, kCallers> at{};  // in the program, the innermost first
};
inline thread_local Look last;

/// By frame pointers, which these builds keep.
[[gnu::noinline]] inline Look now() {
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  Look out{.ms = 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec)};
  constexpr std::uintptr_t kWidest = 1u << 20;  // of a frame: beyond it is no frame of ours
  auto* frame = static_cast<const std::uintptr_t*>(__builtin_frame_address(0));
  for (auto& at : out.at) {
    at = frame[1] - reinterpret_cast<std::uintptr_t>(&__executable_start) - 1;  // the call itself
    const auto next = frame[0], here = reinterpret_cast<std::uintptr_t>(frame);
    if (next <= here || next - here > kWidest) break;
    frame = reinterpret_cast<const std::uintptr_t*>(next);
  }
  return out;
}

inline void print(const Look& look) {
  for (const auto at : look.at)
    if (at != 0) std::fprintf(stderr, "%zx,", at);
}

/// The job, or the piece of it that this thread has, begins.
inline void begin() { last = now(); }

/// False, always.
[[gnu::noinline]] inline bool look() {
  const auto at = now();
  if (at.ms - last.ms > kLongMs) {
    std::fprintf(stderr, "look %.1f ", at.ms - last.ms);
    print(last);
    std::fputc(' ', stderr);
    print(at);
    std::fputc('\n', stderr);
  }
  last = now();
  return false;
}

inline void end() { look(); }

}  // namespace tubecut::looks

#define stop_requested() stop_requested() | static_cast<int>(tubecut::looks::look())
