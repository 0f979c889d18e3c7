#include "server/jobs/slots.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace tubecut::server {
namespace {

/// Computing gives way to reading, refusing and sending, which take microseconds. Linux keeps the
/// nice value per thread.
constexpr int kNice = 5;
constexpr int kNiceExtra = 1;  // of the thread for short jobs: they come before long ones

void step_back(int by) {
  const auto thread = static_cast<id_t>(::syscall(SYS_gettid));
  static_cast<void>(::setpriority(PRIO_PROCESS, thread, ::getpriority(PRIO_PROCESS, thread) + by));
}

}  // namespace

std::chrono::nanoseconds used(const Job& job) { return job.cpu.used() + job.helped.used(); }

Slots::Slots(int count, std::size_t queue, Step work, Step done)
    : work_(std::move(work)),
      done_(std::move(done)),
      count_(std::max(1, count)),
      queue_(queue),
      helpers_(static_cast<std::size_t>(count_) - 1, [] { step_back(kNice); }) {
  helpers_.allow(count_);
  while (threads_.size() < threads(count_))
    threads_.emplace_back([this, in_slot = !threads_.empty()] { run(in_slot); });
}

std::size_t Slots::threads(int slots) { return static_cast<std::size_t>(std::max(1, slots)) + 1; }

void Slots::join() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    slots_.wake_all();
    extra_.wake_all();
  }
  for (auto& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
  helpers_.join();
}

std::chrono::nanoseconds Slots::cpu(const Job& job) const {
  const std::lock_guard lock(mutex_);  // a thread whose job runs lives
  return used(job);
}

Slots::Offer Slots::offer(const std::shared_ptr<Job>& job) {
  Offer out{.taken = true};
  std::unique_lock lock(mutex_);
  auto& queue = queue_of(*job);
  const int places = job->is_short ? count_ + 1 : count_;
  const int held = job->is_short ? in_slots_ + in_extra_ : in_slots_;
  if (queue.size() + static_cast<std::size_t>(held) >= queue_ + static_cast<std::size_t>(places)) {
    out.displaced = queue.give_way(job->claim.client);
    if (!out.displaced) return {};
  }
  queue.push(job);
  count_waiting();
  auto* const called = call_one(job->is_short);
  lock.unlock();  // who is woken would at once wait for the mutex
  if (called != nullptr) called->wake_one();
  return out;
}

bool Slots::waits(const Job& job) const {
  const std::lock_guard lock(mutex_);
  return !job.begun;
}

bool Slots::withdraw(const std::shared_ptr<Job>& job) {
  const std::lock_guard lock(mutex_);
  const bool waited = queue_of(*job).remove(job);
  count_waiting();
  return waited;
}

/// Calls a thread for a job that has come: a slot's, if one is free that nobody is on the way to,
/// because to wake more took longer than a short job. Returns whom to `wake_one`, best without the
/// mutex, which is held here.
Sleepers* Slots::call_one(bool is_short) {
  if (in_slots_ + back_ + slots_.called() < count_) return slots_.call() ? &slots_ : nullptr;
  return is_short && extra_.call() ? &extra_ : nullptr;
}

/// Slots that nobody uses or waits for are the helpers'.
void Slots::count_waiting() {
  waiting_ = short_.size() + long_.size();
  busy_ = in_slots_ + in_extra_;
  helpers_.allow(waiting_ > 0 ? 0 : std::max(0, count_ - in_slots_));
}

/// A slot takes from both classes alternately.
std::shared_ptr<Job> Slots::pop(bool in_slot) {
  if (!in_slot) return short_.pop();
  auto& first = long_next_ ? long_ : short_;
  auto job = first.size() > 0 ? first.pop() : (long_next_ ? short_ : long_).pop();
  if (job) long_next_ = job->is_short;
  return job;
}

std::shared_ptr<Job> Slots::next(bool in_slot) {
  auto job = pop(in_slot);
  if (!job) return nullptr;
  ++(in_slot ? in_slots_ : in_extra_);
  job->begun = true;
  job->cpu = CpuClock::of_this_thread();
  count_waiting();
  return job;
}

/// `own`: CPU of the job's thread.
void Slots::finish(Job& job, bool in_slot, std::chrono::nanoseconds own) {
  job.cpu.stop(own);
  --(in_slot ? in_slots_ : in_extra_);
  count_waiting();
}

void Slots::run(bool in_slot) {
  step_back(in_slot ? kNice : kNiceExtra);
  auto& sleepers = in_slot ? slots_ : extra_;
  std::unique_lock lock(mutex_);
  std::shared_ptr<Job> done;  // to be handed over, once the next one is found or there is none
  for (;;) {
    auto job = ending_ ? nullptr : next(in_slot);
    // The slot may have been called for a short job and taken a long one that came after it.
    const bool leaves_short = job && !job->is_short && short_.size() > 0 && extra_.call();
    if (!job && !done) {
      if (ending_) return;
      sleepers.sleep(lock);
      continue;
    }
    const bool seeks_again = in_slot && !job;
    if (seeks_again) ++back_;
    lock.unlock();
    if (leaves_short) extra_.wake_one();
    if (done) done_(std::exchange(done, nullptr));
    std::chrono::nanoseconds own{0};
    if (job) {
      work_(job);
      own = job->cpu.used();
    }
    lock.lock();
    if (seeks_again) --back_;
    if (job)
      finish(*job, in_slot, own);  // before its answer is out: who gets it finds the slot free
    done = std::move(job);
  }
}

}  // namespace tubecut::server
