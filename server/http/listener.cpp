// The service's port: Boost.Asio accepts, and each connection runs on its own (session.hpp).

#include <fmt/format.h>
#include <linux/filter.h>
#include <sys/socket.h>

#include <array>
#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/ip/basic_resolver.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <future>

#include "server/http/port.hpp"
#include "server/http/transport.hpp"

namespace tubecut::server {
namespace {

using namespace std::chrono_literals;
namespace asio = boost::asio;
using Acceptor = asio::basic_socket_acceptor<Tcp, Executor>;

constexpr int kBacklog = 1024;
constexpr int kAcceptsBeforeYield = 64;  // then the connections go on
constexpr auto kOutOfMeans = 10ms;       // descriptors, memory: asked again
constexpr auto kHandshakes = 50ms;       // that have begun: they end within a round trip
constexpr auto kListeningEnds = 5s;      // a loop that does not even do that

/// Drops what opens a connection (SYN) from here on. Its client sends it again a second later, when
/// the port is closed or another process listens: a connection made in the moment in which the port
/// closes would be reset, and its request lost. If the system refuses, that may happen.
void drop_new_connections(Acceptor& acceptor) {
  constexpr std::uint32_t kFlags = 13, kSyn = 2, kAll = 0xffff;  // of a TCP header
  std::array<sock_filter, 4> drops{{BPF_STMT(BPF_LD | BPF_B | BPF_ABS, kFlags),
                                    BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, kSyn, 0, 1),
                                    BPF_STMT(BPF_RET | BPF_K, 0), BPF_STMT(BPF_RET | BPF_K, kAll)}};
  const sock_fprog program{.len = drops.size(), .filter = drops.data()};
  ::setsockopt(acceptor.native_handle(), SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program);
}

/// Takes connections until it is told to stop, and then those that the kernel had taken.
class Listener final : public Strand {
 public:
  Listener(Port& port, Acceptor& acceptor) : Strand(port.loop), port_(port), acceptor_(acceptor) {}
  ~Listener() override { drop(); }

  void start() { begin(live()); }
  void stop() {
    stopped_ = true;
    drop_new_connections(acceptor_);
    closes_ = Clock::now() + kHandshakes;
    wake();
  }
  [[nodiscard]] bool sound() const { return stopped_; }

 private:
  Task<void> live() {
    while (acceptor_.is_open()) {
      const bool goes_on = accept_or_wait();
      if (!acceptor_.is_open()) break;
      if (Clock::now() >= closes_) {
        close();
      } else if (goes_on) {
        co_await yield();
      } else if (stopped_) {
        co_await pause(closes_);
      } else {
        co_await Chain::Pause();
      }
    }
  }

  /// What the kernel has taken for us is work too: closing the port would reset it.
  void close() {
    while (accept_some()) {
    }
    boost::system::error_code error;
    acceptor_.close(error);
  }

  /// Accepts, or asks to be woken when there is something to accept; true when to be called again.
  bool accept_or_wait() {
    try {
      if (accept_some()) return true;
      if (!acceptor_.is_open()) return false;
      if (out_of_means_) {
        static_cast<void>(pause(Clock::now() + kOutOfMeans));
      } else if (!waits_) {
        wait();
        waits_ = true;
      }
      return false;
    } catch (const std::exception&) {  // no memory even to wait
      return true;
    }
  }

  void wait() {
    acceptor_.async_wait(Acceptor::wait_read, [this, self = shared_from_this()](const auto&) {
      waits_ = false;
      wake();
    });
  }

  /// True when there may be more.
  bool accept_some() {
    out_of_means_ = false;
    for (int n = 0; n < kAcceptsBeforeYield; ++n) {
      boost::system::error_code error;
      Socket socket(port_.loop.io());
      acceptor_.accept(socket, error);
      if (!error) {
        open(std::move(socket));
      } else if (error == asio::error::would_block) {
        return false;
      } else if (error == asio::error::bad_descriptor || error == asio::error::invalid_argument ||
                 error == asio::error::not_socket) {
        acceptor_.close(error);
        return false;
      } else if (error != asio::error::interrupted && error != asio::error::connection_aborted) {
        out_of_means_ = true;
        return false;
      }
    }
    return true;
  }

  /// If there is no memory for the connection, closes it.
  void open(Socket socket) {
    try {
      port_.open(std::move(socket));
    } catch (const std::exception&) {
      out_of_means_ = true;
    }
  }

  void on_end() override {
    if (!stopped_) port_.drain(1s);  // listening broke down
    port_.end();
  }

  Port& port_;
  Acceptor& acceptor_;
  bool waits_ = false;
  bool stopped_ = false;
  Clock::time_point closes_ = Clock::time_point::max();
  bool out_of_means_ = false;
};

}  // namespace

struct Transport::Impl {
  Impl(const TransportOptions& options, Service service)
      : port(options, std::move(service)), acceptor(port.loop.io()) {}

  /// Returns an error text, or an empty text.
  std::string bind() {
    const auto& options = port.options;
    boost::system::error_code error;
    asio::ip::basic_resolver<Tcp, Executor> resolver(port.loop.io());
    const auto found = resolver.resolve(options.host, std::to_string(options.port),
                                        asio::ip::resolver_base::passive, error);
    for (const auto& entry : found) {
      if (listen(entry.endpoint(), error)) return {};
    }
    return fmt::format("cannot listen on {}:{}: {}", options.host, options.port, error.message());
  }

  bool listen(const Tcp::endpoint& at, boost::system::error_code& error) {
    acceptor.close(error);
    acceptor.open(at.protocol(), error);
    // Not SO_REUSEPORT, by which a second process would take the same port without a word.
    if (!error) acceptor.set_option(Acceptor::reuse_address(true), error);
    if (!error && at.protocol() == Tcp::v6()) {
      acceptor.set_option(asio::ip::v6_only(false), error);
    }
    if (!error) acceptor.bind(at, error);
    if (!error) acceptor.listen(kBacklog, error);
    if (!error) acceptor.non_blocking(true, error);
    if (!error) number = acceptor.local_endpoint(error).port();
    return !error;
  }

  Port port;
  Acceptor acceptor;
  int number = 0;
  std::shared_ptr<Listener> listener;
  std::atomic<bool> serving = false;
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

int Transport::port() const { return x_->number; }

bool Transport::serve() {
  x_->listener = std::make_shared<Listener>(x_->port, x_->acceptor);
  x_->listener->start();
  x_->serving = true;
  x_->port.run();
  x_->serving = false;
  return x_->listener->sound();
}

bool Transport::serving() const { return x_->serving; }
TransportStats Transport::stats() const { return x_->port.stats(); }

void Transport::close_connections() {
  x_->port.tell([this] { x_->port.close_connections(); });
}

void Transport::drain(std::chrono::milliseconds patience) {
  if (!x_->serving) return;
  auto closed = std::make_shared<std::promise<void>>();
  auto waits = closed->get_future();
  x_->port.tell([this, patience, closed] {
    x_->port.drain(patience);
    x_->listener->stop();
    closed->set_value();
  });
  waits.wait_for(kListeningEnds);
}

void Transport::cancel_jobs() {
  x_->port.tell([this] { x_->port.cancel_jobs(); });
}

}  // namespace tubecut::server
