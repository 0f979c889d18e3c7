#include "server/jobs/cpu_clock.hpp"

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

void CpuClock::stop(std::chrono::nanoseconds used) {
  used_ = used;
  runs_ = false;
}

HelpersCpu::Share::Share(HelpersCpu& all) : all_(all) {
  const std::lock_guard lock(all_.mutex_);
  all_.running_.push_back(&clock_);
}

HelpersCpu::Share::~Share() {
  const std::lock_guard lock(all_.mutex_);
  std::erase(all_.running_, &clock_);
  all_.done_ += clock_.used();
}

std::chrono::nanoseconds HelpersCpu::used() const {
  const std::lock_guard lock(mutex_);
  auto out = done_;
  for (const auto* clock : running_) out += clock->used();
  return out;
}

int HelpersCpu::threads() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(running_.size());
}

}  // namespace tubecut::server
