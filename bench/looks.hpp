#pragma once

#include <cstdio>
#include <cstring>
#include <ctime>
#include <stop_token>

/// For builds with TUBECUT_LOOKS alone, which bench/looks asks: a job's thread says on stderr where
/// it worked for long without a look at its stop token. Stands in the precompiled headers, so that
/// every look is one that says where it is: `|` makes it also where the other side decides.
namespace tubecut::looks {

constexpr double kLongMs = 4.0;  // of CPU

struct Look {
  double ms = 0.0;  // by the thread's CPU clock
  const char* file = "";
  int line = 0;
};
inline thread_local Look last;

inline Look now(const char* file, int line) {
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return {1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec), file, line};
}

/// The job, or the piece of it that this thread has, begins.
inline void begin() { last = now("begin", 0); }

/// Who calls `stops`, which looks in its own file.
inline thread_local Look caller;
inline bool called(const char* file, int line) {
  caller = {0.0, file, line};
  return false;
}

/// False, always.
inline bool look(const char* file, int line) {
  const auto at = std::strstr(file, "core/base/stop.hpp") != nullptr ? now(caller.file, caller.line)
                                                                     : now(file, line);
  if (at.ms - last.ms > kLongMs)
    std::fprintf(stderr, "look %.1f %s:%d %s:%d\n", at.ms - last.ms, last.file, last.line, at.file,
                 at.line);
  last = now(at.file, at.line);
  return false;
}

inline void end() { look("end", 0); }

}  // namespace tubecut::looks

#define stop_requested() \
  stop_requested() | static_cast<int>(tubecut::looks::look(__FILE__, __LINE__))
#include "core/base/stop.hpp"  // whose own look is one too
#define stops(token, turn) (tubecut::looks::called(__FILE__, __LINE__) || stops(token, turn))
