#include "server/http/loop.hpp"

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/post.hpp>
#include <exception>
#include <thread>

namespace tubecut::server {

void Loop::run(const std::function<bool()>& over, const std::function<void()>& each) {
  const auto stays = boost::asio::make_work_guard(io_);
  while (!over()) {
    try {
      if (awake_) {
        io_.poll();
      } else {
        io_.run_one();
      }
    } catch (const std::exception&) {  // out of memory: the strand wakes by its timer
    }
    each();
    resume_awake();
  }
}

void Loop::resume_awake() {
  auto next = std::exchange(awake_, nullptr);
  last_awake_ = nullptr;
  while (next) {
    const auto strand = std::exchange(next, nullptr);
    next = std::exchange(strand->next_, nullptr);
    strand->awake_ = false;
    if (strand->ended()) continue;
    strand->chain_.run();
    if (strand->ended()) strand->finish();
  }
}

void Loop::interrupt() noexcept {
  for (;;) {
    try {
      return boost::asio::post(io_, [] {});
    } catch (const std::exception&) {  // the memory of a moment: another job's end brings some
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
}

void Strand::wake() noexcept {
  if (awake_) return;
  awake_ = true;
  auto self = shared_from_this();
  auto& link = loop_.last_awake_ == nullptr ? loop_.awake_ : loop_.last_awake_->next_;
  link = std::move(self);
  loop_.last_awake_ = this;
}

void Strand::finish() {
  timer_.cancel();  // it would keep the strand for as long
  on_end();
}

void Strand::begin(Task<void> life) {
  chain_.begin(std::move(life));
  wake();
}

/// An earlier wait stays: it wakes too soon, and the pause is taken up again. So a connection that
/// is busy sets its timer now and then, not twice a request.
Chain::Pause Strand::pause(Clock::time_point deadline) {
  if (deadline >= armed_) return {};
  armed_ = Clock::time_point::max();
  timer_.expires_at(deadline);
  timer_.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
    if (error) return;  // set anew
    self->armed_ = Clock::time_point::max();
    self->wake();
  });
  armed_ = deadline;
  return {};
}

}  // namespace tubecut::server
