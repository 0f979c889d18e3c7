// The problems that the wire suite prevents: the same paths on plain cpp-httplib, without any code
// of ours before it. Prints the ready line of the service, so that the runners start either.

#include <httplib.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>

namespace {

constexpr auto kJob = std::chrono::milliseconds(300);  // of the path that computes
constexpr int kThreads =
    8;  // its number on up to nine cores; on more, the runners' crowds would suffice

}  // namespace

int main() {
  sigset_t stop;
  sigemptyset(&stop);
  sigaddset(&stop, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &stop, nullptr);  // in every thread to come: one waits for it

  httplib::Server server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  server.set_payload_max_length(1u << 20);
  const auto answer = [](const httplib::Request&, httplib::Response& out) {
    out.set_content("{}", "application/json");
  };
  server.Get("/v1/version", answer);
  server.Get("/readyz", answer);
  server.Post("/v1/intersections", answer);
  server.Post("/v1/bevel-tables", [&](const httplib::Request& in, httplib::Response& out) {
    std::this_thread::sleep_for(kJob);
    answer(in, out);
  });
  const int port = server.bind_to_any_port("127.0.0.1");
  std::thread([&] {
    int number = 0;
    sigwait(&stop, &number);
    server.stop();  // its own way to end
  }).detach();
  std::printf("{\"event\":\"ready\",\"port\":%d,\"admin_port\":%d,\"version\":\"stock\"}\n", port,
              port);
  std::fflush(stdout);
  return server.listen_after_bind() ? 0 : 1;
}
