#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <functional>
#include <stop_token>
#include <utility>

/// Only for builds with TUBECUT_LOOKS, which bench/looks uses: a job's thread reports on stderr
/// where it worked for long without a check of its stop token. Is in the precompiled headers; `|`
/// checks also if the other side decides.
namespace tubecut::looks {

constexpr double kLongMs = 4.0;  // of CPU
constexpr std::size_t kCallers = 12;

extern "C" const char __executable_start;  // NOLINT: the linker's

struct Look {
  double ms = 0.0;                            // by the thread's CPU clock
  double kept_ms = 0.0;                       // to free the memory that the job holds here
  std::array<std::uintptr_t, kCallers> at{};  // in the program, the innermost first
};
inline thread_local Look last;
inline thread_local std::function<double()> kept_ms;  // that the job's budget keeps, as it is now

/// By frame pointers, which these builds keep.
[[gnu::noinline]] inline Look now() {
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  Look out{.ms = 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec),
           .kept_ms = kept_ms ? kept_ms() : 0.0};
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

/// The job, or the piece of it that this thread has, begins. `kept`: empty without a budget.
inline void begin(std::function<double()> kept = {}) {
  kept_ms = std::move(kept);
  last = now();
}

/// Reports the thread's work since the last check, minus `but_ms`, if it was long.
[[gnu::noinline]] inline void say(double but_ms) {
  const auto at = now();
  const double ms = at.ms - last.ms - but_ms;
  if (ms > kLongMs) {
    std::fprintf(stderr, "look %.1f ", ms);
    print(last);
    std::fputc(' ', stderr);
    print(at);
    std::fputc('\n', stderr);
  }
  last = now();
}

/// False, always.
[[gnu::noinline]] inline bool look() {
  say(0.0);
  return false;
}

/// By now the job has freed the memory that it held at its last check, in time that its budget
/// reserved.
inline void end() {
  say(last.kept_ms);
  kept_ms = {};
}

}  // namespace tubecut::looks

#define stop_requested() stop_requested() | static_cast<int>(tubecut::looks::look())
