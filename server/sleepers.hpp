#pragma once

#include <condition_variable>
#include <mutex>

namespace tubecut::server {

/// Threads that sleep until they are called. The owner's mutex is held at every call but
/// `wake_one`.
class Sleepers {
 public:
  void sleep(std::unique_lock<std::mutex>& lock) {
    ++asleep_;
    wake_.wait(lock, [this] { return called_ > 0; });
    --asleep_;
    --called_;
  }

  /// Whether there was one that nobody had called: `wake_one` is to follow.
  [[nodiscard]] bool call() {
    if (called_ == asleep_) return false;
    ++called_;
    return true;
  }
  void wake_one() { wake_.notify_one(); }
  void wake_all() {
    called_ = asleep_;
    wake_.notify_all();
  }

  /// How many are called and not awake yet.
  [[nodiscard]] int called() const { return called_; }

 private:
  std::condition_variable wake_;
  int asleep_ = 0;
  int called_ = 0;
};

}  // namespace tubecut::server
