#pragma once

#include <cstddef>
#include <stop_token>
#include <utility>

namespace tubecut::api {

/// Thrown in the api where a job has to end; `dispatch` answers it by `over_budget`. In core a stop
/// comes back as an error.
struct Stopped {};

inline void ask(const std::stop_token& stop) {
  if (stop.stop_requested()) throw Stopped{};
}

/// Asks now and then, for loops whose turns take much less than a microsecond.
class Pace {
 public:
  explicit Pace(std::stop_token stop = {}) : stop_(std::move(stop)) {}
  void turn() {
    if (++turns_ % kTurns == 0) ask(stop_);
  }
  [[nodiscard]] const std::stop_token& stop() const { return stop_; }

 private:
  static constexpr std::size_t kTurns = 1024;
  std::stop_token stop_;
  std::size_t turns_ = 0;
};

}  // namespace tubecut::api
