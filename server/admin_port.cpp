// cpp-httplib behind admin_port.hpp; Debian 12 has 0.11.4.

#include "server/admin_port.hpp"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/socket.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <functional>
#include <semaphore>

namespace tubecut::server {
namespace {

using namespace std::chrono_literals;

constexpr int kBacklog = 128;  // the library's own is 5: the sixth waits a second for its SYN
constexpr std::size_t kThreads = 8;
constexpr std::size_t kBody = 1024;  // no path here takes one

/// Threads, and no more connections waiting for them than that: the others wait in the kernel.
class Connections final : public httplib::TaskQueue {
 public:
  void enqueue(std::function<void()> serve) override {
    room_.acquire();
    threads_.enqueue([this, serve = std::move(serve)] {
      serve();
      room_.release();
    });
  }
  void shutdown() override { threads_.shutdown(); }

 private:
  std::counting_semaphore<> room_{AdminPort::kConnections};
  httplib::ThreadPool threads_{kThreads};
};

void answer(const httplib::Request& in, httplib::Response& out, const AdminSources& sources) {
  Response response = admin({.method = in.method,
                             .target = in.target,
                             .headers = {{"Host", in.get_header_value("Host")}}},
                            sources);
  out.status = response.status;
  for (const auto& [name, value] : response.headers) out.set_header(name, value);
  out.set_content(response.body, response.content_type);
}

}  // namespace

struct AdminPort::Impl final : httplib::Server {
  explicit Impl(AdminSources of) : sources(std::move(of)) {
    new_task_queue = [] { return new Connections; };
    set_tcp_nodelay(true);
    set_keep_alive_timeout(1);
    set_keep_alive_max_count(1);  // one that is kept alive would keep a thread, and the end waiting
    set_read_timeout(2s);
    set_write_timeout(5s);
    set_payload_max_length(kBody);
    // SO_REUSEPORT, the library's choice, lets a second process take the same port without a word.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    set_pre_routing_handler([this](const httplib::Request& in, httplib::Response& out) {
      answer(in, out, sources);
      return HandlerResponse::Handled;
    });
    set_exception_handler([](const httplib::Request&, httplib::Response& out,
                             const std::exception_ptr&) {  // cpp-httplib 0.11 sends the exception's
                                                           // text in a header
      out.headers.clear();
      out.status = 500;
      out.set_content("The service failed.\n", "text/plain; charset=utf-8");
    });
  }

  /// Returns an error text, or an empty text.
  std::string bind(const std::string& host, int wanted) {
    number = wanted == 0 ? bind_to_any_port(host) : (bind_to_port(host, wanted) ? wanted : -1);
    if (number < 0) {
      return fmt::format("cannot listen on {}:{}: {}", host, wanted, std::strerror(errno));
    }
    ::listen(svr_sock_, kBacklog);
    return {};
  }

  AdminSources sources;
  int number = -1;
  std::atomic<bool> stopped = false;
};

AdminPort::AdminPort(std::unique_ptr<Impl> impl) : x_(std::move(impl)) {}
AdminPort::AdminPort(AdminPort&&) noexcept = default;
AdminPort::~AdminPort() = default;

tl::expected<AdminPort, std::string> AdminPort::open(const std::string& host, int port,
                                                     AdminSources sources) {
  auto impl = std::make_unique<Impl>(std::move(sources));
  if (auto why = impl->bind(host, port); !why.empty()) return tl::unexpected(std::move(why));
  return AdminPort(std::move(impl));
}

int AdminPort::port() const { return x_->number; }
bool AdminPort::serving() const { return x_->is_running(); }

bool AdminPort::serve() { return x_->listen_after_bind() || x_->stopped; }

void AdminPort::stop() {
  x_->stopped = true;
  x_->stop();
}

std::optional<int> probe(const std::string& host, int port, const std::string& path,
                         std::chrono::milliseconds patience) {
  httplib::Client client(host, port);
  client.set_connection_timeout(patience);
  client.set_read_timeout(patience);
  const auto result = client.Get(path);
  return result ? std::optional<int>(result->status) : std::nullopt;
}

}  // namespace tubecut::server
