#pragma once

#include <semaphore.h>

#include <mutex>

namespace tubecut::server {

/// Threads that sleep until they are called. The owner's mutex is held at every call but
/// `wake_one`. By a semaphore: who wakes from a condition variable of glibc holds the mutex as one
/// that others wait for, and to give it back takes a call of the system, one for every short job.
class Sleepers {
 public:
  Sleepers() { ::sem_init(&calls_, 0, 0); }
  Sleepers(const Sleepers&) = delete;
  Sleepers& operator=(const Sleepers&) = delete;
  ~Sleepers() { ::sem_destroy(&calls_); }

  void sleep(std::unique_lock<std::mutex>& lock) {
    ++asleep_;
    lock.unlock();
    while (::sem_wait(&calls_) != 0) {  // a signal came
    }
    lock.lock();
    --asleep_;
    --called_;
  }

  /// Whether there was one that nobody had called: `wake_one` is to follow.
  [[nodiscard]] bool call() {
    if (called_ == asleep_) return false;
    ++called_;
    return true;
  }
  void wake_one() { ::sem_post(&calls_); }
  void wake_all() {
    while (call()) wake_one();
  }

  /// How many are called and not awake yet.
  [[nodiscard]] int called() const { return called_; }

 private:
  sem_t calls_{};
  int asleep_ = 0;
  int called_ = 0;
};

}  // namespace tubecut::server
