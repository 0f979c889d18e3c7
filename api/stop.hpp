#pragma once

#include <algorithm>
#include <cstddef>
#include <stop_token>
#include <string>
#include <string_view>
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

/// Appends in parts that take far less than a millisecond to copy.
inline void append(std::string& out, std::string_view bytes, const std::stop_token& stop) {
  constexpr std::size_t kAtOnce = 256u << 10;
  out.reserve(out.size() + bytes.size());
  for (; !bytes.empty(); bytes.remove_prefix(std::min(kAtOnce, bytes.size()))) {
    ask(stop);
    out += bytes.substr(0, kAtOnce);
  }
}

}  // namespace tubecut::api
