#include "server/cpu_clock.hpp"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>

#ifndef sigev_notify_thread_id  // glibc of Debian 12 has the field without the name
#define sigev_notify_thread_id _sigev_un._tid
#endif

namespace tubecut::server {
namespace {

/// Left of a budget, less is not shared: each share costs a signal.
constexpr std::chrono::nanoseconds kLeastShare = std::chrono::microseconds(500);

/// Whose time the timer of this thread counts. Read by the signal's handler, in this thread alone.
thread_local std::atomic<CpuBudget*> limited = nullptr;

extern "C" void end_job(int) {
  const int before = errno;
  if (auto* const mine = limited.load(std::memory_order_relaxed)) mine->look();
  errno = before;
}

std::chrono::nanoseconds read(clockid_t clock) {
  timespec time{};
  if (::clock_gettime(clock, &time) != 0) return {};
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

/// Once, so much later; 0: not at all.
void set(timer_t timer, std::chrono::nanoseconds after) {
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(after);
  itimerspec at{};
  at.it_value.tv_sec = whole.count();
  at.it_value.tv_nsec = (after - whole).count();
  ::timer_settime(timer, 0, &at, nullptr);
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

  [[nodiscard]] bool there() const { return there_; }
  [[nodiscard]] timer_t timer() const { return timer_; }

 private:
  timer_t timer_{};
  bool there_ = false;
};

ThreadTimer& thread_timer() {
  thread_local ThreadTimer timer;
  return timer;
}

}  // namespace

std::chrono::nanoseconds CpuBudget::Part::used() const {
  return read(clock) - std::chrono::nanoseconds(begin_ns);
}

void CpuBudget::look() {
  using std::chrono::nanoseconds;
  nanoseconds left(most_ns_ - done_ns_);
  int threads = 0;
  for (const auto& part : parts_) {
    if (!part.runs) continue;
    left -= part.used();
    ++threads;
  }
  if (left <= nanoseconds::zero()) {
    stop_.request_stop();
    return;
  }
  for (const auto& part : parts_)
    if (part.runs) set(part.timer, std::max(kLeastShare, left / std::max(1, threads)));
}

CpuLimit::CpuLimit(CpuBudget& budget, std::chrono::nanoseconds most) : budget_(budget) {
  const auto& timer = thread_timer();
  if (most.count() <= 0 || !timer.there()) return;
  for (auto& part : budget.parts_) {
    if (part.taken.exchange(true)) continue;
    part_ = &part;
    break;
  }
  clockid_t clock{};
  if (part_ == nullptr || ::pthread_getcpuclockid(::pthread_self(), &clock) != 0) return;
  budget.most_ns_ = most.count();
  part_->clock = clock;
  part_->begin_ns = read(clock).count();
  part_->timer = timer.timer();
  part_->runs = true;
  limited = &budget;
  budget.look();
#ifdef TUBECUT_LOOKS
  looks::begin();
#endif
}

CpuLimit::~CpuLimit() {
  if (part_ == nullptr) return;
#ifdef TUBECUT_LOOKS
  looks::end();
#endif
  if (part_->runs.exchange(false)) {
    limited = nullptr;
    set(part_->timer, {});
    budget_.done_ns_ += part_->used().count();
  }
  part_->taken = false;
}

CpuClock CpuClock::of_this_thread() {
  CpuClock out;
  out.runs_ = ::pthread_getcpuclockid(::pthread_self(), &out.clock_) == 0;
  out.begin_ = out.read();
  return out;
}

std::chrono::nanoseconds CpuClock::read() const { return runs_ ? server::read(clock_) : begin_; }

std::chrono::nanoseconds CpuClock::used() const { return runs_ ? read() - begin_ : used_; }

void CpuClock::stop() {
  used_ = used();
  runs_ = false;
}

}  // namespace tubecut::server
