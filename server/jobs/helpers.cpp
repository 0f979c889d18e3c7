#include "server/jobs/helpers.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

namespace tubecut::server {

Helpers::Helpers(std::size_t threads, const std::function<void()>& started) {
  try {
    while (threads_.size() < threads)
      threads_.emplace_back([this, started] {
        started();
        run();
      });
  } catch (const std::system_error&) {  // with those there are
  }
}

void Helpers::join() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  some_.notify_all();
  for (auto& thread : threads_)
    if (thread.joinable()) thread.join();
}

void Helpers::allow(int most) {
  if (most_.exchange(most) >= most || working_ == 0) return;
  { const std::lock_guard lock(mutex_); }  // nobody is between looking and waiting
  some_.notify_all();
}

Helpers::Work* Helpers::some_work() {
  if (helping_ >= most_) return nullptr;
  const auto with_tasks = std::ranges::find_if(works_, [](const Work* work) {
    return work->next < work->count && !work->failure && work->helped_by < kMost;
  });
  return with_tasks != works_.end() ? *with_tasks : nullptr;
}

void Helpers::run_tasks(Work& work, bool helps) {
  std::unique_lock lock(mutex_);
  while (work.next < work.count && !work.failure && (!helps || helping_ <= most_)) {
    const std::size_t i = work.next++;
    lock.unlock();
    std::exception_ptr failure;
    try {
      work.task(i);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    if (failure && (!work.failure || i < work.failed)) {
      work.failure = std::move(failure);
      work.failed = i;
    }
  }
}

void Helpers::run_parallel(std::size_t count, const ParallelTask& task, const Within& within) {
  Work work{.count = count, .task = task, .within = within};
  const bool shared = count > 1 && !threads_.empty();
  if (shared) {
    {
      const std::lock_guard lock(mutex_);
      works_.push_back(&work);
      ++working_;
    }
    some_.notify_all();
  }
  run_tasks(work, false);
  if (shared) {
    std::unique_lock lock(mutex_);
    std::erase(works_, &work);
    --working_;
    work.left.wait(lock, [&work] { return work.helped_by == 0; });
  }
  if (work.failure) std::rethrow_exception(work.failure);
}

void Helpers::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    Work* work = nullptr;
    some_.wait(lock, [&] { return ending_ || (work = some_work()) != nullptr; });
    if (ending_) return;
    ++helping_;
    ++work->helped_by;
    lock.unlock();
    work->within([this, work] { run_tasks(*work, true); });
    lock.lock();
    --helping_;
    if (--work->helped_by == 0) work->left.notify_all();
  }
}

}  // namespace tubecut::server
