// cpp-httplib behind transport.hpp; written against Debian 12's 0.11.4. The library parses heads,
// chunks and prints answers; reading, deadlines, byte budgets and the end of a connection are in
// `Connection`, since its own have none.

#include <fmt/format.h>
#include <httplib.h>
#include <poll.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <thread>

#include "server/connection.hpp"
#include "server/framing.hpp"
#include "server/transport.hpp"

namespace tubecut::server {
namespace {

constexpr int kBacklog = 1024;  // the library's own is 5: the sixth waits a second for its SYN
constexpr auto kBacklogTime = std::chrono::seconds(1);
constexpr std::size_t kRequestsKept =
    100000;  // per connection; a bound only so that connections are renewed at times
constexpr std::size_t kChunkOverhead =
    65536;  // framing bytes a chunked body may add to twice its size

/// The library's view of a connection.
class Stream final : public httplib::Stream {
 public:
  explicit Stream(Connection& connection) : x_(connection) {}
  bool is_readable() const override { return x_.readable(); }
  bool is_writable() const override { return true; }
  ssize_t read(char* out, std::size_t size) override { return x_.read(out, size); }
  ssize_t write(const char* bytes, std::size_t size) override {
    x_.write({bytes, size});
    return static_cast<ssize_t>(size);
  }
  void get_remote_ip_and_port(std::string& ip, int& /*port*/) const override { ip = x_.peer(); }
  void get_local_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  socket_t socket() const override { return x_.descriptor(); }

 private:
  Connection& x_;
};

/// The request that this thread is serving: the library hands its handlers no place of their own.
struct Exchange {
  httplib::Request* raw = nullptr;  // null until the head is read
  Request request;
  std::size_t body_limit = 0;
  bool has_body = false;
  bool unread = false;  // bytes of this request may be left on the wire
  bool close = false;
};
thread_local Exchange* t_exchange = nullptr;

}  // namespace

struct Transport::Impl final : httplib::Server {
  Impl(const TransportOptions& options, Service service)
      : options_(options), service_(std::move(service)) {
    set_tcp_nodelay(true);
    set_keep_alive_max_count(kRequestsKept);
    set_keep_alive_timeout(std::chrono::duration_cast<std::chrono::seconds>(options.idle).count());
    // SO_REUSEPORT, the library's choice, lets a second process take the same port without a word.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    const auto threads = static_cast<std::size_t>(std::max(1, options.connections));
    new_task_queue = [threads] { return new httplib::ThreadPool(threads); };
    set_handlers();
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

  void drain(std::chrono::milliseconds patience) {
    drain_.begin(patience);
    await_empty_backlog();
    stop();
  }

 private:
  /// Connections that the kernel has taken for us are work too: closing the port would reset them.
  void await_empty_backlog() {
    const auto until = Clock::now() + kBacklogTime;
    pollfd port{.fd = svr_sock_, .events = POLLIN, .revents = 0};
    while (Clock::now() < until && ::poll(&port, 1, 0) > 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  void set_handlers() {
    set_pre_routing_handler([this](const httplib::Request&, httplib::Response& out) {
      if (wants_body()) return HandlerResponse::Unhandled;
      answer(out);
      return HandlerResponse::Handled;
    });
    // Every path is "/" to the library (see `read_head`): its regular expressions crash on long
    // ones.
    Post("/", [this](const httplib::Request&, httplib::Response& out,
                     const httplib::ContentReader& reader) {
      read_body(reader);
      answer(out);
    });
    set_expect_100_continue_handler([this](const httplib::Request&, httplib::Response& out) {
      if (wants_body()) return 100;
      answer(out);
      out.set_header("Content-Length",
                     std::to_string(out.body.size()));  // forgotten on this path only
      return out.status;
    });
    set_error_handler(HandlerWithResponse([this](const httplib::Request&, httplib::Response& out) {
      if (!out.body.empty()) return HandlerResponse::Unhandled;  // ours
      answer_unreadable(out);
      return HandlerResponse::Handled;
    }));
    set_exception_handler(
        [](const httplib::Request&, httplib::Response& out, const std::exception_ptr&) {
          out.status = 500;  // `handle` does not throw; this only keeps the library from showing
                             // the text of what did
          out.set_content("The service failed.\n", "text/plain; charset=utf-8");
        });
  }

  /// Runs once a head is parsed, before routing: the one place where the library's request may be
  /// changed. What it would act on by itself (ranges, compression, multipart, regular expressions)
  /// is taken away from it.
  void read_head(Connection& connection, httplib::Request& raw) {
    Exchange& x = *t_exchange;
    x.raw = &raw;
    x.request.method = raw.method;
    x.request.target = raw.target;
    x.request.peer = raw.remote_addr;
    x.request.headers.assign(raw.headers.begin(), raw.headers.end());
    raw.ranges.clear();
    raw.path.assign(1, '/');  // g++ 12 sees an overlap in the assignment of a literal
    for (const auto* name : {"Range", "Accept-Encoding", "Content-Encoding", "Content-Type"}) {
      raw.headers.erase(name);
    }
    decide(x);
    connection.allow(2 * x.body_limit + kChunkOverhead, options_.body);
    if (equal_ignoring_case(header(x.request.headers, "Connection"), "close")) x.close = true;
  }

  /// Whether and how far the body will be read.
  void decide(Exchange& x) const {
    const auto& headers = x.request.headers;
    if (const auto fault = framing_fault(headers); !fault.empty()) {
      x.request.refusal = Refusal{ErrorCode::bad_request, std::string(fault)};
      x.unread = true;
      return;
    }
    x.has_body = announces_body(headers);
    x.body_limit = service_.max_body(x.request.target);
    x.request.refusal = service_.screen(x.request);
    if (!x.request.refusal && x.has_body && announced_length(headers) > x.body_limit) {
      x.request.refusal = too_large(x.body_limit);
    }
    x.unread = x.has_body && !wants_body();
  }

  static Refusal too_large(std::size_t limit) {
    return {ErrorCode::body_too_large, fmt::format("The body is larger than {} bytes.", limit)};
  }

  static bool wants_body() {
    const Exchange& x = *t_exchange;
    return x.has_body && !x.request.refusal && x.request.method == "POST";
  }

  static void read_body(const httplib::ContentReader& reader) {
    Exchange& x = *t_exchange;
    const bool whole = reader([&x](const char* bytes, std::size_t size) {
      if (x.request.body.size() + size > x.body_limit) {
        x.request.refusal = too_large(x.body_limit);
        return false;
      }
      x.request.body.append(bytes, size);
      return true;
    });
    if (whole) return;
    x.unread = true;
    if (!x.request.refusal) {
      x.request.refusal = Refusal{ErrorCode::bad_request,
                                  "The body ended early, came too slowly or is badly chunked."};
    }
  }

  void answer(httplib::Response& out) const {
    Exchange& x = *t_exchange;
    Response response = service_.handle(x.request);
    out.status = response.status;
    out.body = std::move(response.body);
    out.headers.clear();
    out.set_header("Content-Type", response.content_type);
    for (const auto& [name, value] : response.headers) out.set_header(name, value);
    if (x.request.method == "HEAD") out.set_header("Accept-Ranges", "none");
    if (x.unread || drain_.begun()) x.close = true;
    if (!x.close) return;
    if (x.raw == nullptr) {
      out.set_header("Connection", "close");
    } else {  // the library copies it from the request
      x.raw->headers.erase("Connection");
      x.raw->headers.emplace("Connection", "close");
    }
  }

  /// For what the library itself turned away: a head it could not parse.
  void answer_unreadable(httplib::Response& out) const {
    Exchange& x = *t_exchange;
    x.unread = true;
    x.request.refusal = Refusal{ErrorCode::bad_request,
                                "The request's head is malformed, too large or came too slowly."};
    answer(out);
  }

  bool process_and_close_socket(socket_t socket) override {
    Connection connection(socket, drain_);
    connection.allow_write(options_.write);
    Stream stream(connection);
    bool kept = true;
    for (std::size_t n = 0; kept && n < kRequestsKept && connection.wait(options_.idle); ++n) {
      kept = exchange(connection, stream);
    }
    return true;
  }

  /// One request and its answer. Says whether the connection goes on.
  bool exchange(Connection& connection, Stream& stream) {
    Exchange x;
    t_exchange = &x;
    connection.allow(options_.max_head_bytes, options_.head);
    bool closed = false;
    const bool done = process_request(stream, false, closed,
                                      [&](httplib::Request& raw) { read_head(connection, raw); });
    t_exchange = nullptr;
    const bool sent = connection.flush();
    if (sent && x.unread) connection.linger();
    return done && sent && !closed && !x.close;
  }

  TransportOptions options_;
  Service service_;
  Drain drain_;
  int port_ = -1;
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
bool Transport::serve() { return x_->listen_after_bind(); }
bool Transport::serving() const { return x_->is_running(); }
void Transport::drain(std::chrono::milliseconds patience) { x_->drain(patience); }

std::optional<int> probe(const std::string& host, int port, const std::string& path,
                         std::chrono::milliseconds patience) {
  httplib::Client client(host, port);
  client.set_connection_timeout(patience);
  client.set_read_timeout(patience);
  const auto result = client.Get(path);
  return result ? std::optional<int>(result->status) : std::nullopt;
}

}  // namespace tubecut::server
