#include "server/slots.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>

namespace tubecut::server {
namespace {

/// Computing gives way to reading, refusing and sending, which take microseconds. Linux keeps the
/// nice value per thread.
constexpr int kNice = 5;

void step_back() {
  const auto thread = static_cast<id_t>(::syscall(SYS_gettid));
  static_cast<void>(
      ::setpriority(PRIO_PROCESS, thread, ::getpriority(PRIO_PROCESS, thread) + kNice));
}

}  // namespace

Slots::Slots(int count, std::size_t queue, Step work, Step done)
    : work_(std::move(work)),
      done_(std::move(done)),
      most_(queue + static_cast<std::size_t>(std::max(1, count))) {
  for (int i = 0; i < std::max(1, count); ++i) threads_.emplace_back([this] { run(); });
}

void Slots::join() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  some_.notify_all();
  for (auto& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
}

bool Slots::offer(std::shared_ptr<Job> job) {
  {
    const std::lock_guard lock(mutex_);
    if (queue_.size() + static_cast<std::size_t>(busy_.load()) >= most_) return false;
    queue_.push_back(std::move(job));
    waiting_ = queue_.size();
  }
  some_.notify_one();
  return true;
}

bool Slots::withdraw(const std::shared_ptr<Job>& job) {
  const std::lock_guard lock(mutex_);
  const auto at = std::ranges::find(queue_, job);
  if (at == queue_.end()) return false;
  queue_.erase(at);
  waiting_ = queue_.size();
  return true;
}

void Slots::run() {
  step_back();
  std::unique_lock lock(mutex_);
  for (;;) {
    some_.wait(lock, [this] { return ending_ || !queue_.empty(); });
    if (ending_) return;
    auto job = std::move(queue_.front());
    queue_.pop_front();
    waiting_ = queue_.size();
    ++busy_;
    lock.unlock();
    work_(job);
    --busy_;  // before the answer is out: its client's next request finds the slot free
    done_(std::move(job));
    lock.lock();
  }
}

}  // namespace tubecut::server
