// A client of many connections on one thread: load SECONDS CONNECTIONS PORT FILE... [--rate R]
// [--pace MS] Each FILE is a whole request as bytes (head and body); connections take them in turn,
// keep alive, one at a time each. Without --rate a connection sends as soon as it is answered;
// --rate bounds requests per second over all of them. If a connection is told to end, it
// reconnects. Prints one line of JSON: answers by status, latencies in ms of accepted and of
// refused ones, and the number of lost ones.

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

struct Connection {
  int socket = -1;
  bool busy = false;
  bool closing = false;
  std::size_t sent = 0;
  std::size_t request = 0;
  std::string in;
  Clock::time_point since;
};

struct Tally {
  std::map<int, long> statuses;
  std::vector<float> accepted;
  std::vector<float> refused;
  long lost = 0;  // sent, and the connection ended without an answer
  long without_retry_after = 0;
};

class Load {
 public:
  Load(int port, std::vector<std::string> requests, std::size_t connections)
      : port_(port), requests_(std::move(requests)), connections_(connections) {
    for (std::size_t i = 0; i < connections_.size(); ++i) {
      connections_[i].request = i % requests_.size();
      open(i);
    }
  }

  void run(double seconds, double rate) {
    const auto start = Clock::now();
    const auto end =
        start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    double begun = 0.0;
    std::size_t next = 0;
    while (Clock::now() < end) {
      const double due =
          rate > 0.0 ? rate * std::chrono::duration<double>(Clock::now() - start).count() : 1e18;
      for (std::size_t n = 0; n < connections_.size() && begun < due; ++n) {
        Connection& c = connections_[next];
        next = (next + 1) % connections_.size();
        if (c.busy || c.socket < 0) continue;
        begin(c);
        begun += 1.0;
      }
      if (rate > 0.0) begun = std::max(begun, due - rate);  // no debt beyond a second
      poll(rate > 0.0 ? 1 : 100);
    }
    const auto last = Clock::now() + std::chrono::seconds(5);
    while (Clock::now() < last && std::ranges::any_of(connections_, &Connection::busy)) poll(50);
  }

  void print(double seconds) {
    std::printf("{\"seconds\":%g,\"statuses\":{", seconds);
    const char* comma = "";
    for (const auto& [status, count] : tally_.statuses) {
      std::printf("%s\"%d\":%ld", comma, status, count);
      comma = ",";
    }
    std::printf("},\"lost\":%ld,\"without_retry_after\":%ld", tally_.lost,
                tally_.without_retry_after);
    quantiles("accepted_ms", tally_.accepted);
    quantiles("refused_ms", tally_.refused);
    std::printf("}\n");
  }

 private:
  static void quantiles(const char* name, std::vector<float>& ms) {
    std::ranges::sort(ms);
    const auto at = [&](double q) {
      return ms.empty() ? 0.0F
                        : ms[static_cast<std::size_t>(q * static_cast<double>(ms.size() - 1))];
    };
    const auto late = std::ranges::count_if(ms, [](float each) { return each > 10.0F; });
    std::printf(",\"%s\":{\"p50\":%.3f,\"p90\":%.3f,\"p99\":%.3f,\"max\":%.3f,\"over_10_ms\":%td}",
                name, static_cast<double>(at(0.5)), static_cast<double>(at(0.9)),
                static_cast<double>(at(0.99)), static_cast<double>(at(1.0)), late);
  }

  void open(std::size_t i) {
    Connection& c = connections_[i];
    c = Connection{.request = c.request};
    c.socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port_));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const auto* generic = static_cast<const sockaddr*>(static_cast<const void*>(&address));
    if (::connect(c.socket, generic, sizeof address) != 0) {
      ::close(c.socket);
      c.socket = -1;
      return;
    }
    const int yes = 1;
    ::setsockopt(c.socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    ::fcntl(c.socket, F_SETFL, O_NONBLOCK);
    epoll_event event{.events = EPOLLIN | EPOLLOUT | EPOLLET, .data = {.u64 = i}};
    ::epoll_ctl(epoll_, EPOLL_CTL_ADD, c.socket, &event);
  }

  void begin(Connection& c) {
    c.busy = true;
    c.sent = 0;
    c.since = Clock::now();
    push(c);
  }

  void push(Connection& c) const {
    const std::string& bytes = requests_[c.request];
    while (c.busy && c.sent < bytes.size()) {
      const auto n = ::send(c.socket, bytes.data() + c.sent, bytes.size() - c.sent, MSG_NOSIGNAL);
      if (n <= 0) return;
      c.sent += static_cast<std::size_t>(n);
    }
  }

  void poll(int ms) {
    std::array<epoll_event, 256> events{};
    const int n = ::epoll_wait(epoll_, events.data(), 256, ms);
    for (int i = 0; i < n; ++i) {
      const auto index = static_cast<std::size_t>(events[static_cast<std::size_t>(i)].data.u64);
      Connection& c = connections_[index];
      if (c.socket < 0) continue;
      push(c);
      if (!pull(c)) {
        if (c.busy) ++tally_.lost;
        ::close(c.socket);
        open(index);
      }
    }
  }

  /// Reads the available bytes; returns false at the connection's end.
  bool pull(Connection& c) {
    for (;;) {
      const auto n = ::recv(c.socket, buffer_.data(), buffer_.size(), 0);
      if (n == 0) return false;
      if (n < 0) return errno == EAGAIN || errno == EINTR;
      c.in.append(buffer_.data(), static_cast<std::size_t>(n));
      if (!take(c)) return false;
    }
  }

  /// Removes a whole answer from the received bytes; returns false if the connection ends with it.
  bool take(Connection& c) {
    const auto end = c.in.find("\r\n\r\n");
    if (end == std::string::npos) return true;
    const std::string_view head(c.in.data(), end + 2);
    const auto length = head.find("\r\nContent-Length: ");
    const std::size_t body =
        length == std::string_view::npos ? 0 : std::strtoul(head.data() + length + 18, nullptr, 10);
    if (c.in.size() < end + 4 + body) return true;
    const int status = std::atoi(c.in.c_str() + 9);
    const bool closes = head.find("\r\nConnection: close") != std::string_view::npos;
    const bool turned_away = status == 429 || status == 503;
    if (turned_away && head.find("\r\nRetry-After: ") == std::string_view::npos) {
      ++tally_.without_retry_after;
    }
    const auto ms = std::chrono::duration<float, std::milli>(Clock::now() - c.since).count();
    ++tally_.statuses[status];
    (turned_away ? tally_.refused : tally_.accepted).push_back(ms);
    c.in.clear();
    c.busy = false;
    c.request = (c.request + connections_.size()) % requests_.size();
    return !closes;
  }

  int port_;
  std::vector<std::string> requests_;
  std::vector<Connection> connections_;
  Tally tally_;
  int epoll_ = ::epoll_create1(EPOLL_CLOEXEC);
  std::array<char, 65536> buffer_{};
};

std::string contents(const char* file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) return 2;
  double rate = 0.0;
  std::vector<std::string> requests;
  for (int i = 4; i < argc; ++i) {
    if (std::strcmp(argv[i], "--rate") == 0 && i + 1 < argc) {
      rate = std::atof(argv[++i]);
    } else {
      requests.push_back(contents(argv[i]));
    }
  }
  const double seconds = std::atof(argv[1]);
  Load load(std::atoi(argv[3]), std::move(requests), static_cast<std::size_t>(std::atoi(argv[2])));
  load.run(seconds, rate);
  load.print(seconds);
}
