#include "server/cpu_clock.hpp"

#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <csignal>

#ifndef sigev_notify_thread_id  // glibc of Debian 12 has the field without the name
#define sigev_notify_thread_id _sigev_un._tid
#endif

namespace tubecut::server {
namespace {

/// Whose time the timer of this thread counts. Read by the signal's handler, in this thread alone.
thread_local std::atomic<std::stop_source*> limited = nullptr;

/// A stop is a few atomic operations here: no job has callbacks of its stop token.
extern "C" void end_job(int) {
  if (auto* const stop = limited.load(std::memory_order_relaxed)) stop->request_stop();
}

bool handle_signal() {
  struct sigaction action {};
  action.sa_handler = end_job;
  action.sa_flags = SA_RESTART;
  return ::sigaction(SIGRTMIN, &action, nullptr) == 0;
}

/// One of each thread that works at jobs, for all of them.
class ThreadTimer {
 public:
  ThreadTimer() {
    static const bool handled = handle_signal();
    sigevent event{};
    event.sigev_notify = SIGEV_THREAD_ID;
    event.sigev_signo = SIGRTMIN;
    event.sigev_notify_thread_id = ::gettid();
    there_ = handled && ::timer_create(CLOCK_THREAD_CPUTIME_ID, &event, &timer_) == 0;
  }
  ThreadTimer(const ThreadTimer&) = delete;
  ThreadTimer& operator=(const ThreadTimer&) = delete;
  ~ThreadTimer() {
    if (there_) ::timer_delete(timer_);
  }

  /// 0: not at all.
  void set(std::chrono::nanoseconds after) {
    if (!there_) return;
    const auto whole = std::chrono::duration_cast<std::chrono::seconds>(after);
    itimerspec at{};
    at.it_value.tv_sec = whole.count();
    at.it_value.tv_nsec = (after - whole).count();
    ::timer_settime(timer_, 0, &at, nullptr);
  }

 private:
  timer_t timer_{};
  bool there_ = false;
};

ThreadTimer& thread_timer() {
  thread_local ThreadTimer timer;
  return timer;
}

}  // namespace

CpuLimit::CpuLimit(std::stop_source& stop, std::chrono::nanoseconds most) {
  limited = &stop;
  thread_timer().set(most);
}

CpuLimit::~CpuLimit() {
  thread_timer().set({});
  limited = nullptr;
}

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
