#include "server/connection.hpp"

#include <fcntl.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace tubecut::server {
namespace {

std::string peer_of(int descriptor) {
  sockaddr_storage address{};
  socklen_t length = sizeof address;
  auto* generic = static_cast<sockaddr*>(static_cast<void*>(&address));
  std::array<char, NI_MAXHOST> host{};
  if (getpeername(descriptor, generic, &length) != 0) return {};
  if (getnameinfo(generic, length, host.data(), host.size(), nullptr, 0, NI_NUMERICHOST) != 0) {
    return {};
  }
  return host.data();
}

}  // namespace

Connection::Connection(int of, const ReaderLimits& limits)
    : descriptor(of), peer(peer_of(of)), reader(limits) {
  const int flags = ::fcntl(descriptor, F_GETFL);
  static_cast<void>(::fcntl(descriptor, F_SETFL, flags | O_NONBLOCK));
}

Connection::~Connection() {
  report(false);
  ::close(descriptor);
}

ssize_t Connection::receive(char* to, std::size_t size) const {
  for (;;) {
    const auto n = ::recv(descriptor, to, size, 0);
    if (n >= 0) return n;
    if (errno == EAGAIN) return -1;
    if (errno != EINTR) return -2;
  }
}

std::optional<bool> Connection::send() {
  while (out_at < out.size()) {
    const auto n = ::send(descriptor, out.data() + out_at, out.size() - out_at, MSG_NOSIGNAL);
    if (n > 0) {
      out_at += static_cast<std::size_t>(n);
    } else if (errno == EAGAIN) {
      return false;
    } else if (errno != EINTR) {
      return std::nullopt;
    }
  }
  out = {};
  out_at = 0;
  return true;
}

void Connection::send_now(std::string_view bytes) const {
  static_cast<void>(::send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL));
}

void Connection::finish_sending() const { ::shutdown(descriptor, SHUT_WR); }

void Connection::restart(const ReaderLimits& limits) {
  reader = RequestReader(limits);
  state = State::idle;
  fresh = false;
}

}  // namespace tubecut::server
