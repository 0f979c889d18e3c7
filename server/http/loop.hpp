#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <memory>

#include "server/http/task.hpp"

namespace tubecut::server {

using Clock = std::chrono::steady_clock;
using Executor = boost::asio::io_context::executor_type;
using Tcp = boost::asio::ip::tcp;
using Socket = boost::asio::basic_stream_socket<Tcp, Executor>;

class Strand;

/// A port's only thread: Asio's events wake strands, and the loop resumes those that are awake, one
/// after another. Handlers only wake, so no code of ours runs while another strand runs.
class Loop {
 public:
  [[nodiscard]] boost::asio::io_context& io() { return io_; }

  /// Runs until `over`. `each` is called between events.
  void run(const std::function<bool()>& over, const std::function<void()>& each);

  /// From any thread: `each` is called soon. Never throws.
  void interrupt() noexcept;

 private:
  friend class Strand;
  void resume_awake();

  boost::asio::io_context io_{1};
  std::shared_ptr<Strand> awake_;  // linked, so that waking needs no memory
  Strand* last_awake_ = nullptr;
};

/// One coroutine of the loop, with the coroutines that it calls, and a timer. Its owner and the
/// events for which it waits keep it alive.
class Strand : public std::enable_shared_from_this<Strand> {
 public:
  explicit Strand(Loop& loop) : loop_(loop), timer_(loop.io()) {}
  virtual ~Strand() = default;
  Strand(const Strand&) = delete;
  Strand& operator=(const Strand&) = delete;

  /// Resumes it in the loop's next round. In the loop's thread.
  void wake() noexcept;
  [[nodiscard]] bool ended() const { return chain_.ended(); }

 protected:
  void begin(Task<void> life);

  /// Suspends until woken, at the latest at `deadline`. Wakes may be spurious, so check the
  /// condition again.
  [[nodiscard]] Chain::Pause pause(Clock::time_point deadline);
  /// Lets the others go on.
  [[nodiscard]] Chain::Pause yield() {
    wake();
    return {};
  }

  /// Ends the coroutine at its current suspension point.
  void drop() { chain_.drop(); }
  /// It has ended: for its owner.
  virtual void on_end() {}

 private:
  friend class Loop;
  void finish();

  Loop& loop_;
  boost::asio::basic_waitable_timer<Clock, boost::asio::wait_traits<Clock>, Executor> timer_;
  Clock::time_point armed_ = Clock::time_point::max();
  bool awake_ = false;
  std::shared_ptr<Strand> next_;
  Chain chain_;
};

}  // namespace tubecut::server
