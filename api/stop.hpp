#pragma once

#include <algorithm>
#include <cstddef>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>

namespace tubecut::api {

/// Thrown in the api if a job has to end; `dispatch` answers it by `over_budget`. In core a stop is
/// returned as an error.
struct Stopped {};

inline void ask(const std::stop_token& stop) {
  if (stop.stop_requested()) throw Stopped{};
}

/// Checks for a stop now and then, for loops whose iterations take much less than a microsecond.
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

constexpr std::size_t kBytesAtOnce = 256u << 10;  // far less than a millisecond to copy

/// Room for `more` bytes. A text that has to move for it moves in parts.
inline void make_room(std::string& out, std::size_t more, const std::stop_token& stop) {
  if (out.capacity() - out.size() >= more) return;
  std::string larger;
  larger.reserve(std::max(out.size() + more, 2 * out.capacity()));
  for (std::string_view rest = out; !rest.empty();) {
    ask(stop);
    larger += rest.substr(0, kBytesAtOnce);
    rest.remove_prefix(std::min(kBytesAtOnce, rest.size()));
  }
  out = std::move(larger);
}

/// Appends in parts, with checks for a stop between them.
inline void append(std::string& out, std::string_view bytes, const std::stop_token& stop) {
  make_room(out, bytes.size(), stop);
  for (; !bytes.empty(); bytes.remove_prefix(std::min(kBytesAtOnce, bytes.size()))) {
    ask(stop);
    out += bytes.substr(0, kBytesAtOnce);
  }
}

}  // namespace tubecut::api
