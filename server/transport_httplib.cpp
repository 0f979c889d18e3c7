// cpp-httplib behind transport.hpp; Debian 12 has 0.11.4, newer ones fit too. The library binds,
// accepts and prints answers. Reading, deadlines, byte budgets and slots are ours (docs/adr/0001):
// its handlers never see a byte that a client sent.

#include <fmt/format.h>
#include <httplib.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <thread>

#include "server/event_loop.hpp"
#include "server/transport.hpp"

namespace tubecut::server {
namespace {

constexpr int kBacklog = 1024;  // the library's own is 5: the sixth waits a second for its SYN
constexpr auto kBacklogTime = std::chrono::seconds(1);
constexpr auto kOutOfMeans = std::chrono::milliseconds(10);  // descriptors, memory: asked again

/// A request line of ours in, an answer out. What a library asks of a stream differs (0.41 has no
/// is_writable, 0.11 no waiting): hence no `override`, as some would be one and some not.
// NOLINTBEGIN(modernize-use-override)
class MemoryStream final : public httplib::Stream {
 public:
  explicit MemoryStream(std::string_view in) : in_(in) {}
  [[nodiscard]] bool is_readable() const { return !in_.empty(); }
  [[nodiscard]] bool is_writable() const { return true; }
  [[nodiscard]] bool wait_readable() const { return true; }
  [[nodiscard]] bool wait_writable() const { return true; }
  [[nodiscard]] time_t duration() const { return 0; }
  ssize_t read(char* to, std::size_t size) {
    const auto n = in_.copy(to, size);
    in_.remove_prefix(n);
    return static_cast<ssize_t>(n);
  }
  ssize_t write(const char* bytes, std::size_t size) {
    out_.append(bytes, size);
    return static_cast<ssize_t>(size);
  }
  void get_remote_ip_and_port(std::string& /*ip*/, int& /*port*/) const {}
  void get_local_ip_and_port(std::string& /*ip*/, int& /*port*/) const {}
  [[nodiscard]] socket_t socket() const { return INVALID_SOCKET; }

  [[nodiscard]] std::string take() { return std::move(out_); }

 private:
  std::string_view in_;
  std::string out_;
};
// NOLINTEND(modernize-use-override)

/// What the slot's thread is answering: the library hands its handlers no place of their own.
struct Exchange {
  const Request* request = nullptr;
  const Service* service = nullptr;
  const std::atomic<bool>* close = nullptr;
  httplib::Request* raw = nullptr;
  std::function<void(bool)> sent = {};
};
thread_local Exchange* t_exchange = nullptr;

/// RFC 9110, 6.6.1.
std::string http_date() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  static constexpr const char* kDays[] = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  static constexpr const char* kMonths[] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                            "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  return fmt::format("{}, {:02} {} {} {:02}:{:02}:{:02} GMT", kDays[utc.tm_wday], utc.tm_mday,
                     kMonths[utc.tm_mon], 1900 + utc.tm_year, utc.tm_hour, utc.tm_min, utc.tm_sec);
}

void answer(httplib::Response& out) {
  Exchange& x = *t_exchange;
  Response response = x.service->handle(*x.request);
  out.status = response.status;
  out.body = std::move(response.body);
  out.headers.clear();
  if (!response.content_type.empty()) out.set_header("Content-Type", response.content_type);
  for (const auto& [name, value] : response.headers) out.set_header(name, value);
  out.set_header("Date", http_date());
  if (x.request->method == "HEAD") out.set_header("Accept-Ranges", "none");
  if (*x.close) x.raw->headers.emplace("Connection", "close");  // whence the library copies it
  x.sent = std::move(response.sent);
}

}  // namespace

struct Transport::Impl final : httplib::Server {
  Impl(const TransportOptions& options, Service service)
      : options_(options),
        service_(std::move(service)),
        loop_(options_, service_, [this](const Request& request, const std::atomic<bool>& close) {
          return print(request, close);
        }) {
    set_tcp_nodelay(true);
    set_keep_alive_timeout(std::chrono::duration_cast<std::chrono::seconds>(options.idle).count());
    set_keep_alive_max_count(100000);  // only printed
    // SO_REUSEPORT, the library's choice, lets a second process take the same port without a word.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    set_pre_routing_handler([](const httplib::Request&, httplib::Response& out) {
      answer(out);
      return HandlerResponse::Handled;
    });
    set_exception_handler([](const httplib::Request&, httplib::Response& out,
                             const std::exception_ptr&) {  // 0.11 says `what` in a header
      out.headers.clear();
      out.status = 500;
      out.set_content("The service failed.\n", "text/plain; charset=utf-8");
    });
  }

  std::string bind() {
    port_ = options_.port == 0 ? bind_to_any_port(options_.host)
                               : (bind_to_port(options_.host, options_.port) ? options_.port : -1);
    if (port_ < 0) {
      return fmt::format("cannot listen on {}:{}: {}", options_.host, options_.port,
                         std::strerror(errno));
    }
    ::listen(svr_sock_, kBacklog);
    return {};
  }

  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] TransportStats stats() const { return loop_.stats(); }

  bool serve() {
    std::thread sockets([this] { loop_.run(); });
    const bool sound = accept_all();
    if (!draining_) loop_.drain(std::chrono::seconds(1));  // listening broke down
    loop_.end();
    sockets.join();
    return sound;
  }

  void drain(std::chrono::milliseconds patience) {
    draining_ = true;
    loop_.drain(patience);
    await_empty_backlog();
    ::shutdown(svr_sock_, SHUT_RDWR);  // wakes `accept`
  }

  [[nodiscard]] bool serving() const { return accepting_; }

  void cancel_jobs() { loop_.cancel_jobs(); }

 private:
  /// Until `drain`. The library's own loop gives the port up at the first error it does not know,
  /// such as a machine out of descriptors, which passes (accept(2)). False when the port is gone.
  bool accept_all() {
    accepting_ = true;
    for (;;) {
      const int socket = ::accept4(svr_sock_, nullptr, nullptr, SOCK_CLOEXEC);
      if (socket >= 0) {
        loop_.adopt(socket);
      } else if (errno == EBADF || errno == EINVAL || errno == ENOTSOCK) {
        break;
      } else if (errno != EINTR && errno != ECONNABORTED) {
        std::this_thread::sleep_for(kOutOfMeans);
      }
    }
    accepting_ = false;
    ::close(svr_sock_.exchange(INVALID_SOCKET));
    return draining_;
  }

  /// Connections that the kernel has taken for us are work too: closing the port would reset them.
  void await_empty_backlog() {
    const auto until = Clock::now() + kBacklogTime;
    pollfd port{.fd = svr_sock_, .events = POLLIN, .revents = 0};
    while (Clock::now() < until && ::poll(&port, 1, 0) > 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  bool process_and_close_socket(socket_t /*never asked*/) override { return false; }

  /// The library parses a request line of ours, and nothing else; `answer` gets the client's
  /// request.
  Printed print(const Request& request, const std::atomic<bool>& close) {
    Exchange exchange{.request = &request, .service = &service_, .close = &close};
    t_exchange = &exchange;
    MemoryStream stream(request.method == "HEAD" ? "HEAD / HTTP/1.1\r\n\r\n"
                                                 : "GET / HTTP/1.1\r\n\r\n");
    run_library(*this, stream);
    t_exchange = nullptr;
    return {stream.take(), std::move(exchange.sent)};
  }

  /// From 0.15 on the addresses are arguments.
  template <class Library>
  static void run_library(Library& library, httplib::Stream& stream) {
    bool closed = false;
    const std::function<void(httplib::Request&)> keep_it = [](httplib::Request& raw) {
      t_exchange->raw = &raw;
    };
    if constexpr (requires { library.process_request(stream, false, closed, keep_it); }) {
      library.process_request(stream, false, closed, keep_it);
    } else {
      library.process_request(stream, std::string(), 0, std::string(), 0, false, closed, keep_it);
    }
  }

  TransportOptions options_;
  Service service_;
  EventLoop loop_;
  int port_ = -1;
  std::atomic<bool> draining_ = false;
  std::atomic<bool> accepting_ = false;
};

Transport::Transport(std::unique_ptr<Impl> impl) : x_(std::move(impl)) {}
Transport::Transport(Transport&&) noexcept = default;
Transport::~Transport() = default;

tl::expected<Transport, std::string> Transport::open(const TransportOptions& options,
                                                     Service service) {
  auto impl = std::make_unique<Impl>(options, std::move(service));
  if (auto why = impl->bind(); !why.empty()) return tl::unexpected(std::move(why));
  return Transport(std::move(impl));
}

int Transport::port() const { return x_->port(); }
bool Transport::serve() { return x_->serve(); }
bool Transport::serving() const { return x_->serving(); }
TransportStats Transport::stats() const { return x_->stats(); }
void Transport::drain(std::chrono::milliseconds patience) { x_->drain(patience); }
void Transport::cancel_jobs() { x_->cancel_jobs(); }

std::optional<int> probe(const std::string& host, int port, const std::string& path,
                         std::chrono::milliseconds patience) {
  httplib::Client client(host, port);
  client.set_connection_timeout(patience);
  client.set_read_timeout(patience);
  const auto result = client.Get(path);
  return result ? std::optional<int>(result->status) : std::nullopt;
}

}  // namespace tubecut::server
