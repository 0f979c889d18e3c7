#include "server/connection.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <utility>

namespace tubecut::server {
namespace {

constexpr std::size_t kReadBytes = 16384;
constexpr std::size_t kKeptOutBytes = 256u << 10;  // a larger answer's buffer is given back
constexpr auto kFirstByteWhileDraining = std::chrono::milliseconds(500);
constexpr auto kLingerTime = std::chrono::seconds(1);
constexpr std::size_t kLingerBytes = 16u << 20;

/// Whole ms until `until`, rounded up, within poll's range.
int remaining_ms(Clock::time_point until) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
  return static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 3'600'000));
}

}  // namespace

Drain::Drain() : descriptor_(eventfd(0, EFD_CLOEXEC)) {
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

Drain::~Drain() { ::close(descriptor_); }

void Drain::begin(std::chrono::milliseconds patience) {
  deadline_ = (Clock::now() + patience).time_since_epoch();
  begun_ = true;
  const std::uint64_t one = 1;
  static_cast<void>(!::write(descriptor_, &one, sizeof one));
}

Connection::Connection(int descriptor, const Drain& drain)
    : descriptor_(descriptor), drain_(drain), in_(kReadBytes) {}

Connection::~Connection() {
  ::shutdown(descriptor_, SHUT_RDWR);
  ::close(descriptor_);
}

bool Connection::wait(std::chrono::milliseconds patience) {
  const bool first = std::exchange(first_, false);
  if (readable()) return true;
  auto until = Clock::now() + patience;
  std::array<pollfd, 2> who{{{descriptor_, POLLIN, 0}, {drain_.descriptor(), POLLIN, 0}}};
  for (nfds_t watched = 2;;) {
    const int n = ::poll(who.data(), watched, remaining_ms(until));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    if (who[0].revents != 0) return true;
    // The port drains. A fresh connection was accepted as work: its request may still be on the
    // wire.
    if (!first) return false;
    watched = 1;
    until = std::min(until, Clock::now() + kFirstByteWhileDraining);
  }
}

void Connection::allow(std::size_t bytes, std::chrono::milliseconds time) {
  budget_ = bytes;
  deadline_ = Clock::now() + time;
}

/// Waits for the socket; a drain shortens the wait to its own deadline.
bool Connection::poll_for(short events, Clock::time_point until) const {
  std::array<pollfd, 2> who{{{descriptor_, events, 0}, {drain_.descriptor(), POLLIN, 0}}};
  for (;;) {
    const bool draining = drain_.begun();
    const auto end = draining ? std::min(until, drain_.deadline()) : until;
    const int n = ::poll(who.data(), draining ? 1 : 2, remaining_ms(end));
    if (n == 0) return false;
    if (n < 0 && errno != EINTR) return false;
    if (n > 0 && who[0].revents != 0) return true;
  }
}

ssize_t Connection::read(char* out, std::size_t size) {
  if (!readable()) {
    if (!flush() || !poll_for(POLLIN, deadline_)) return -1;
    const auto n = ::recv(descriptor_, in_.data(), in_.size(), 0);
    if (n <= 0) return n;
    next_ = 0;
    filled_ = static_cast<std::size_t>(n);
  }
  const auto n = std::min({size, filled_ - next_, budget_});
  if (n == 0) return -1;
  std::memcpy(out, in_.data() + next_, n);
  next_ += n;
  budget_ -= n;
  return static_cast<ssize_t>(n);
}

bool Connection::flush() {
  const auto until = Clock::now() + write_time_;
  std::string_view left = out_;
  while (!left.empty()) {
    const auto n = ::send(descriptor_, left.data(), left.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n > 0) {
      left.remove_prefix(static_cast<std::size_t>(n));
    } else if (errno == EAGAIN) {
      if (!poll_for(POLLOUT, until)) return false;
    } else if (errno != EINTR) {
      return false;
    }
  }
  out_.clear();
  if (out_.capacity() > kKeptOutBytes) out_.shrink_to_fit();
  return true;
}

void Connection::linger() {
  ::shutdown(descriptor_, SHUT_WR);
  const auto until = Clock::now() + kLingerTime;
  for (std::size_t dropped = 0; dropped < kLingerBytes;) {
    if (!poll_for(POLLIN, until)) return;
    const auto n = ::recv(descriptor_, in_.data(), in_.size(), 0);
    if (n <= 0) return;
    dropped += static_cast<std::size_t>(n);
  }
}

std::string Connection::peer() const {
  sockaddr_storage address{};
  socklen_t length = sizeof address;
  auto* generic = static_cast<sockaddr*>(static_cast<void*>(&address));
  std::array<char, NI_MAXHOST> host{};
  if (getpeername(descriptor_, generic, &length) != 0) return {};
  if (getnameinfo(generic, length, host.data(), host.size(), nullptr, 0, NI_NUMERICHOST) != 0) {
    return {};
  }
  return host.data();
}

}  // namespace tubecut::server
