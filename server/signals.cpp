#include "server/signals.hpp"

#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <csignal>

namespace tubecut::server {
namespace {

sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGHUP);
  return set;
}

/// A handler rather than the default action: the first process of a container has no default
/// action.
extern "C" void end_now(int signal) { _exit(128 + signal); }

}  // namespace

Signals::Signals() {
  const sigset_t set = stop_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
}

void Signals::wait(const std::function<void()>& hang_up) const {
  const sigset_t set = stop_signals();
  int signal = 0;
  while (sigwait(&set, &signal) != 0 || signal == SIGHUP) {
    if (signal == SIGHUP) hang_up();
    signal = 0;
  }
  std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGTERM, end_now);
  std::signal(SIGINT, end_now);
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

void Signals::raise_stop() {
  static std::atomic<bool> raised = false;  // a second signal would end the process at once
  if (!raised.exchange(true)) ::kill(::getpid(), SIGTERM);
}

}  // namespace tubecut::server
