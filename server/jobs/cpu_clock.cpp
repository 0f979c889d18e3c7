#include "server/jobs/cpu_clock.hpp"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <limits>
#include <utility>

#ifndef sigev_notify_thread_id  // glibc of Debian 12 has the field without the name
#define sigev_notify_thread_id _sigev_un._tid
#endif

namespace tubecut::server {
namespace {

/// Left of a budget, less is not shared: each share costs a signal.
constexpr std::chrono::nanoseconds kLeastShare = std::chrono::microseconds(500);
/// Until all that is left is used a job may come to hold more, and to give that back takes time
/// too: looked at halfway, until so little is left that it cannot come to hold much.
constexpr std::chrono::nanoseconds kNear = std::chrono::milliseconds(4);
/// What a job holds it gives back when it is stopped, in its own CPU: so much per byte. Of a
/// replay's values, a few large blocks that in part were never touched, it was 0.14 to 0.18 ms per
/// MiB; of a frame's parts, a million small blocks, 0.13 to 0.22.
constexpr double kGiveBackNs = 0.25e6 / (1u << 20);

/// Whose time the timer of this thread counts. Read by the signal's handler, in this thread alone.
thread_local std::atomic<CpuBudget*> limited = nullptr;
/// When the timer of this thread fires at the latest, by the thread's clock; none: not at all, or
/// nobody knows. It stays set from one short job to the next, which spares two calls a job: one
/// that fires early only looks.
constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();
thread_local std::atomic<std::int64_t> fires_ns = kNone;

extern "C" void end_job(int) {
  const int before = errno;
  fires_ns.store(kNone, std::memory_order_relaxed);
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

/// Of what is left of a budget.
std::chrono::nanoseconds until_look(std::chrono::nanoseconds left) {
  return left > kNear ? left / 2 : left;
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

std::chrono::nanoseconds CpuBudget::to_give_back() const {
  if (held_ == nullptr) return {};
  const std::size_t bytes = held_->own + held_->helpers;
  return std::chrono::nanoseconds(
      static_cast<std::int64_t>(kGiveBackNs * static_cast<double>(bytes)));
}

bool CpuBudget::look() {
  using std::chrono::nanoseconds;
  nanoseconds left = nanoseconds(most_ns_ - done_ns_) - to_give_back();
  int threads = 0;
  for (const auto& part : parts_) {
    if (!part.runs) continue;
    left -= part.used();
    ++threads;
  }
  if (left <= nanoseconds::zero()) {
    stop_.request_stop();
    return false;
  }
  const auto share = std::max(kLeastShare, until_look(left) / std::max(1, threads));
  for (const auto& part : parts_)
    if (part.runs) set(part.timer, share);
  return true;
}

CpuBudget::Part* CpuBudget::take_part() {
  for (auto& part : parts_) {
    if (part.taken.exchange(true)) continue;
    if (&part != parts_.data()) shared_ = true;
    return &part;
  }
  return nullptr;
}

CpuLimit::CpuLimit(CpuBudget& budget, std::chrono::nanoseconds most, const CpuClock& clock)
    : budget_(budget), clock_(clock) {
  const auto& timer = thread_timer();
  if (most.count() <= 0 || !timer.there() || !clock.runs_) return;
  part_ = budget.take_part();
  if (part_ == nullptr) return;
  budget.most_ns_ = most.count();
  part_->clock = clock.clock_;
  part_->begin_ns = clock.begin_.count();
  part_->timer = timer.timer();
  part_->runs = true;
  limited = &budget;
  const auto left = std::chrono::nanoseconds(budget.most_ns_ - budget.done_ns_);
  const std::int64_t looks_ns = part_->begin_ns + until_look(left).count();
  if (budget.shared_ || fires_ns > looks_ns) {
    const bool set = budget.look();
    fires_ns = set && !budget.shared_ ? looks_ns : kNone;
  }
#ifdef TUBECUT_LOOKS
  const bool own = part_ == budget.parts_.data();  // what a helper holds others give back
  looks::begin([&budget, own] {
    return own ? 1e-6 * static_cast<double>(budget.to_give_back().count()) : 0.0;
  });
#endif
}

std::chrono::nanoseconds CpuLimit::end() {
  if (std::exchange(ended_, true)) return {};
#ifdef TUBECUT_LOOKS
  if (part_ != nullptr) looks::end();
#endif
  if (part_ != nullptr) {
    part_->runs = false;
    limited = nullptr;
    if (budget_.shared_) {  // others may have set it
      set(part_->timer, {});
      fires_ns = kNone;
    }
  }
  const auto used = clock_.used();
  if (part_ != nullptr) {
    budget_.done_ns_ += used.count();
    part_->taken = false;
  }
  return used;
}

CpuClock CpuClock::of_this_thread() {
  CpuClock out;
  out.runs_ = ::pthread_getcpuclockid(::pthread_self(), &out.clock_) == 0;
  out.begin_ = out.read();
  return out;
}

std::chrono::nanoseconds CpuClock::read() const { return runs_ ? server::read(clock_) : begin_; }

std::chrono::nanoseconds CpuClock::used() const { return runs_ ? read() - begin_ : used_; }

void CpuClock::stop(std::chrono::nanoseconds used) {
  used_ = used;
  runs_ = false;
}

}  // namespace tubecut::server
