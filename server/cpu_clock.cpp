#include "server/cpu_clock.hpp"

#include <pthread.h>

namespace tubecut::server {

CpuClock CpuClock::of_this_thread() {
  CpuClock out;
  out.runs_ = ::pthread_getcpuclockid(::pthread_self(), &out.clock_) == 0;
  out.begin_ = out.read();
  return out;
}

std::chrono::nanoseconds CpuClock::read() const {
  timespec time{};
  if (!runs_ || ::clock_gettime(clock_, &time) != 0) return begin_;
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

std::chrono::nanoseconds CpuClock::used() const { return runs_ ? read() - begin_ : used_; }

void CpuClock::stop() {
  used_ = used();
  runs_ = false;
}

}  // namespace tubecut::server
