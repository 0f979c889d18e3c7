#include "server/serve.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <future>
#include <string>
#include <thread>

#include "server/admin.hpp"
#include "server/app.hpp"
#include "server/job_log.hpp"
#include "server/metrics.hpp"
#include "server/signals.hpp"
#include "server/transport.hpp"

namespace tubecut::server {
namespace {

using namespace std::chrono_literals;

constexpr int kAdminConnections = 8;
constexpr auto kLogPatience = 1s;  // for a line that should be read before going on

std::chrono::milliseconds ms(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * seconds));
}

TransportOptions service_port(const Config& c) {
  return {.host = c.host,
          .port = c.port,
          .connections = c.connections,
          .max_head_bytes = c.max_head_bytes,
          .idle = ms(c.idle_s),
          .head = ms(c.head_s),
          .body = ms(c.body_s),
          .write = ms(c.write_s)};
}

TransportOptions admin_port(const Config& c) {
  return {.host = c.admin_host,
          .port = c.admin_port,
          .connections = kAdminConnections,
          .slots = 1,
          .idle = 2s,
          .head = 2s,
          .body = 2s,
          .write = 5s};
}

/// Jobs are logged; of the rest (catalogues, probing strangers) only what failed by our fault, so
/// that they cannot push jobs' lines out of the queue. The metrics count everything.
bool logged(const JobRecord& job) { return job.method == "POST" || job.status >= 500; }

Service service_of(const App& app) {
  return {.handle = [&app](const Request& request) { return app.handle(request); },
          .screen = [&app](const Request& head) { return app.screen(head); },
          .max_body = [&app](std::string_view target) { return app.max_body(target); }};
}

Service service_of(const AdminSources& sources) {
  return {.handle = [sources](const Request& request) { return admin(request, sources); },
          .screen = [](const Request&) { return std::optional<Refusal>{}; },
          .max_body = [](std::string_view) { return std::size_t{0}; }};
}

/// A port being served by a thread of its own. When serving breaks down the whole service is asked
/// to stop.
std::future<bool> start(Transport& transport) {
  return std::async(std::launch::async, [&transport] {
    const bool sound = transport.serve();
    if (!sound) Signals::raise_stop();
    return sound;
  });
}

void await_serving(const Transport& transport, const std::future<bool>& served) {
  while (!transport.serving() && served.wait_for(0s) != std::future_status::ready) {
    std::this_thread::sleep_for(100us);
  }
}

bool finished(const std::future<bool>& served, std::chrono::milliseconds patience) {
  return served.wait_for(patience) == std::future_status::ready;
}

int fail(std::string_view why) {
  fmt::print(stderr, "tubecut-server: {}\n", why);
  return 1;
}

/// Lets accepted work end, then cancels what is left; a job that does not even obey that ends the
/// process.
void stop_work(Transport& work, const std::future<bool>& served, std::stop_source& jobs,
               const Config& c) {
  std::this_thread::sleep_for(ms(c.drain_delay_s));
  work.drain(ms(c.drain_s));
  if (finished(served, ms(c.drain_s))) return;
  jobs.request_stop();
  work.cancel_jobs();
  if (!finished(served, 1s)) std::_Exit(fail("a job did not stop within its time"));
}

/// What both ports need, for the length of one run.
struct Run {
  explicit Run(const Config& c) : log(c.log_queue), app(options(c)) {}

  AppOptions options(const Config& c) {
    return {.replica = c.replica,
            .max_target_bytes = c.max_target_bytes,
            .max_body_bytes = c.max_body_bytes,
            .stop = jobs.get_token(),
            .started = [this] { metrics.started(); },
            .finished = [this](const JobRecord& job) { record(job); }};
  }
  void record(const JobRecord& job) {
    metrics.finished(job);
    if (logged(job)) log.write(job_line(job, std::chrono::system_clock::now()));
  }
  AdminSources admin_sources() {
    return {.ready = [this] { return ready.load(); }, .metrics = [this] { return metrics.text(); }};
  }

  JobLog log;
  std::atomic<bool> ready = false;
  std::stop_source jobs;
  Metrics metrics{[this] { return log.dropped(); }, [this] { return ready.load(); }};
  App app;
};

}  // namespace

int serve(const Config& c) {
  const Signals signals;
  Run run(c);
  auto work = Transport::open(service_port(c), service_of(run.app));
  if (!work) return fail(work.error());
  auto probes = Transport::open(admin_port(c), service_of(run.admin_sources()));
  if (!probes) return fail(probes.error());

  run.log.write(ready_line(work->port(), probes->port(), api::version()));
  run.log.flush(kLogPatience);  // first, before any request can queue a line
  auto probes_served = start(*probes);
  auto work_served = start(*work);
  await_serving(*probes, probes_served);
  await_serving(*work, work_served);
  run.ready = true;

  signals.wait();
  run.ready = false;
  stop_work(*work, work_served, run.jobs, c);
  probes->drain(500ms);
  const bool sound = work_served.get() && probes_served.get();
  run.log.flush(kLogPatience);
  return sound ? 0 : fail("listening broke down");
}

int health(const Config& c) {
  const bool any = c.admin_host == "0.0.0.0" || c.admin_host == "::";
  const auto status = probe(any ? "127.0.0.1" : c.admin_host, c.admin_port, "/readyz", 2s);
  if (status == 200) return 0;
  return fail(status ? fmt::format("not ready (status {})", *status) : "nobody answers");
}

}  // namespace tubecut::server
