#include "server/serve.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "server/access.hpp"
#include "server/admin.hpp"
#include "server/admin_port.hpp"
#include "server/app.hpp"
#include "server/http/networks.hpp"
#include "server/http/transport.hpp"
#include "server/jobs/capacity.hpp"
#include "server/machine_files.hpp"
#include "server/observe/job_files.hpp"
#include "server/observe/job_log.hpp"
#include "server/observe/json_line.hpp"
#include "server/observe/metrics.hpp"
#include "server/selftest.hpp"
#include "server/signals.hpp"

namespace tubecut::server {
namespace {

using namespace std::chrono_literals;

constexpr int kOwnDescriptors = 64;  // ports, logs, job files, and what the kernel has accepted
constexpr auto kLastProbe = 100ms;   // to be answered while the admin port closes
constexpr std::size_t kFileQueue = std::size_t{4} << 20;  // bytes that wait for the disk
constexpr auto kLogPatience = 1s;  // for a line that should be read before going on

std::chrono::milliseconds ms(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * seconds));
}

TransportOptions service_port(const Config& c, const Capacity& can) {
  return {.host = c.host,
          .port = c.port,
          .connections = can.connections,
          .per_client = c.connections_per_client,
          .slots = can.slots,
          .queue = c.queue,
          .memory = can.memory,
          .max_head_bytes = c.max_head_bytes,
          .idle = ms(c.idle_s),
          .head = ms(c.head_s),
          .body = ms(c.body_s),
          .write = ms(c.write_s)};
}

/// A job's file could not be written.
std::string files_lost_line(const std::string& identity) {
  return JsonLine{}
      .text("ts", utc(std::chrono::system_clock::now()))
      .text("level", "error")
      .text("event", "job_file_lost")
      .text("identity", identity)
      .done();
}

/// Jobs are logged; of the rest (catalogues, probing strangers) only what failed by our fault, so
/// that they cannot push jobs' lines out of the queue. The metrics count everything.
bool logged(const JobRecord& job) { return job.method == "POST" || job.status >= 500; }

Service service_of(const App& app) {
  return {.handle = [&app](const Request& request) { return app.handle(request); },
          .screen = [&app](const Request& head) { return app.screen(head); },
          .max_body = [&app](std::string_view target) { return app.max_body(target); },
          .admit = [&app](const Request& request) { return app.admit(request); },
          .is_batch = App::is_batch,
          .batch_head = [&app](const Request& request) { return app.batch_head(request); },
          .line = [&app](const Request& request) { return app.line(request); },
          .summary = [&app](const Request& head,
                            const BatchCount& count) { return app.summary(head, count); },
          .memory = App::memory,
          .line_memory =
              [](std::string_view line) { return api::kReservedPerByteOfLarge * line.size(); },
          .room = [&app](std::string_view target) { return app.room(target); },
          .client = [&app](const Request& request) { return app.client(request); },
          .is_short = App::is_short,
          .is_shared = [&app](const std::string& peer) { return app.is_proxy(peer); },
          .budget = [&app](const Request& request) { return app.budget(request); }};
}

/// Returns the number of connections for which there are descriptors. Beyond it, the connection
/// that is idle for longest is closed; without this limit a new one would only wait. The soft limit
/// is often 1024 although the hard one is higher.
int connections_of(int wanted) {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return wanted;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
  const auto own = std::min<rlim_t>(kOwnDescriptors + kAdminConnections, limit.rlim_cur / 2);
  return static_cast<int>(std::min<rlim_t>(static_cast<rlim_t>(wanted), limit.rlim_cur - own));
}

Capacity capacity_of(const Config& c) {
  Capacity can = capacity();
  can.connections = connections_of(c.connections);
  if (c.slots > 0) {
    can.slots = c.slots;
    can.slots_from = "option";
  }
  if (c.memory_bytes > 0) {
    can.memory = c.memory_bytes;
    can.memory_from = "option";
  }
  return can;
}

/// A port served by its own thread. If serving fails, the whole service stops.
template <class Port>
std::future<bool> start(Port& port) {
  return std::async(std::launch::async, [&port] {
    const bool sound = port.serve();
    if (!sound) Signals::raise_stop();
    return sound;
  });
}

template <class Port>
void await_serving(const Port& port, const std::future<bool>& served) {
  while (!port.serving() && served.wait_for(0s) != std::future_status::ready) {
    std::this_thread::sleep_for(100us);
  }
}

bool finished(const std::future<bool>& served, std::chrono::milliseconds patience) {
  return served.wait_for(patience) == std::future_status::ready;
}

int fail(std::string_view why, int code = 1) {
  fmt::print(stderr, "tubecut-server: {}\n", why);
  return code;
}

/// Lets accepted work end, then cancels the rest. If a job does not obey even that, ends the
/// process.
void stop_work(Transport& work, const std::future<bool>& served, std::stop_source& jobs,
               const Config& c) {
  work.close_connections();
  std::this_thread::sleep_for(ms(c.drain_delay_s));
  work.drain(ms(c.drain_s));
  if (finished(served, ms(c.drain_s))) return;
  jobs.request_stop();
  work.cancel_jobs();
  if (!finished(served, 1s)) std::_Exit(fail("a job did not stop within its time"));
}

/// Returns the names of `address`, to listen on. Only a port that requires no key and is reachable
/// only from this machine is at risk from a page under a foreign name.
Hosts hosts_of(const Config& c, const std::string& address, bool guarded) {
  const bool any = std::ranges::find(c.hosts, "*") != c.hosts.end();
  if (any || !guarded) return std::nullopt;
  auto out = c.hosts;
  out.push_back(address);
  return out;
}

/// If names are given, the service's port checks them too.
Hosts service_hosts(const Config& c) {
  const bool guarded = c.keys.empty() && !c.open && is_loopback(c.host);
  return hosts_of(c, c.host, guarded || !c.hosts.empty());
}

/// The objects that both ports need during one run.
struct Run {
  Run(const Config& c, std::size_t memory)
      : access(std::make_shared<Access>(c.keys)), log(c.log_queue, c.log_level) {
    if (!c.log_directory.empty())
      files = std::make_unique<JobFiles>(
          c.log_directory, c.log_day, kFileQueue,
          [this](const std::string& identity) { log.write(files_lost_line(identity)); });
    app = std::make_unique<App>(options(c, memory));
  }

  AppOptions options(const Config& c, std::size_t memory) {
    return {.replica = c.replica,
            .max_target_bytes = c.max_target_bytes,
            .max_body_bytes = c.max_body_bytes,
            .max_job_body_bytes = memory / api::kReservedPerByteOfLarge,
            .memory = memory,
            .stop = jobs.get_token(),
            .budget = ms(c.budget_s),
            .cors_origins = c.cors_origins,
            .trusted_proxies = c.trusted_proxies,
            .hosts = service_hosts(c),
            .access = access,
            .started = [this] { metrics.started(); },
            .finished = [this](const JobRecord& job) { metrics.finished(job); },
            .sent = [this](const JobRecord& job) { record(job); }};
  }
  void record(const JobRecord& job) {
    if (!logged(job)) return;
    const auto now = std::chrono::system_clock::now();
    log.write_job(job.status, job_line(job, now));
    if (files && kept(job)) {
      files->write(utc(now).substr(0, 10), job.identity, job.facts.id, job_events(job, now));
    }
  }
  /// Returns whether a job gets a file: an accepted job of a key with any outcome, an answered
  /// batch, and failures. Refused requests leave nothing on the disk.
  [[nodiscard]] static bool kept(const JobRecord& job) {
    const bool accepted = !job.facts.input_sha256.empty() || job.status == 200 || job.status >= 500;
    return accepted && !job.facts.id.empty() && !job.identity.empty();
  }
  AdminSources admin_sources(const Config& c) {
    return {.ready = [this] { return ready.load(); },
            .metrics = [this] { return metrics.text(); },
            .hosts = hosts_of(c, c.admin_host, is_loopback(c.admin_host))};
  }
  MetricSources metric_sources() {
    return {.log_drops = [this] { return log.dropped(); },
            .file_drops = [this] { return files ? files->dropped() : std::uint64_t{0}; },
            .ready = [this] { return ready.load(); },
            .transport = [this] { return work ? work->stats() : TransportStats{}; }};
  }
  /// New keys, machines and posts without a restart; a mistake in a file leaves the old ones.
  void reload(const Config& c) {
    if (access->asks()) reloaded("keys", access->load());
    if (!c.machines.empty()) reloaded("machines", load_machines(c.machines));
    if (!c.posts.empty()) reloaded("posts", load_posts(c.posts));
  }
  void reloaded(const char* what, const std::string& wrong) {
    if (!wrong.empty()) metrics.reload_failed(what);
    JsonLine line;
    line.text("ts", utc(std::chrono::system_clock::now()));
    line.text("level", wrong.empty() ? "info" : "error");
    line.text("event", fmt::format("{}_reloaded", what));
    line.text("configuration_sha256", api::configuration_sha256());
    if (!wrong.empty()) line.text("failure", wrong);
    log.write(line.done());
  }
  void stopping() {
    ready = false;
    log.write(JsonLine{}
                  .text("ts", utc(std::chrono::system_clock::now()))
                  .text("level", "info")
                  .text("event", "stopping")
                  .done());
  }

  std::shared_ptr<Access> access;
  JobLog log;
  std::unique_ptr<JobFiles> files;
  std::atomic<bool> ready = false;
  std::stop_source jobs;
  const Transport* work = nullptr;
  Metrics metrics{metric_sources()};
  std::unique_ptr<App> app;
};

constexpr int kRefusedToStart = 78;  // EX_CONFIG of sysexits.h
constexpr int kNoThread = 71;        // EX_OSERR

/// The option by which other machines reach either port, and its address.
std::optional<std::pair<std::string_view, std::string>> reached(const Config& c) {
  if (!is_loopback(c.host)) return std::pair{"--host", c.host};
  if (!is_loopback(c.admin_host)) return std::pair{"--admin-host", c.admin_host};
  return std::nullopt;
}

/// Returns an error text if jobs' files cannot be written into the folder.
std::string folder_fault(const Config& c) {
  const auto& folder = c.log_directory;
  if (folder.empty()) return {};
  if (c.keys.empty())
    return "--log-directory requires --keys, because otherwise everyone who reaches the port could "
           "fill it";
  std::error_code unknown;
  if (!std::filesystem::is_directory(folder, unknown))
    return fmt::format("--log-directory: {} is no folder", folder);
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    return fmt::format("--log-directory: cannot write into {}", folder);
  return {};
}

/// Everyone who reaches the port may use it, so the operator must confirm this or give keys.
int refuse_open(std::string_view option, const std::string& host) {
  fmt::print(stderr,
             "tubecut-server: {1} is reached from other machines and no keys are set. Either\n"
             "  tubecut-server new-key NAME | tee /dev/stderr | tail -n 1 >> keys.txt\n"
             "  tubecut-server {0} {1} --keys keys.txt\n"
             "or stay on this machine, behind a proxy:\n"
             "  tubecut-server {0} 127.0.0.1\n"
             "or let everybody in who reaches the port (TUBECUT_OPEN=true does the same):\n"
             "  tubecut-server {0} {1} --open\n",
             option, host);
  return kRefusedToStart;
}

/// An uncaught exception ends the process. If the system had no thread to give, that is not a fault
/// of the program, so this reports it and leaves no core file. An exception in flight (a library
/// ends the process when it cannot start all of its threads) is of that kind too, because no other
/// leaves the start.
[[noreturn]] void end_uncaught() {
  bool of_system = std::uncaught_exceptions() > 0;
  try {
    if (const auto failure = std::current_exception()) std::rethrow_exception(failure);
  } catch (const std::system_error&) {
    of_system = true;
  } catch (...) {  // the core file has the reason
  }
  if (!of_system) std::abort();
  std::_Exit(
      fail("the system refuses a thread: raise its limit on processes (ulimit -u, pids.max) or "
           "lower --slots",
           kNoThread));
}

}  // namespace

// The only function that starts threads. If one cannot start, it ends the process (noexcept),
// because stopping the others in order would wait for ports that are being served.
int serve(const Config& c) noexcept {
  std::set_terminate(end_uncaught);
  const Signals signals;
  if (const auto by = reached(c); by && c.keys.empty() && !c.open)
    return refuse_open(by->first, by->second);
  if (const auto wrong = folder_fault(c); !wrong.empty()) return fail(wrong, kRefusedToStart);
  const Capacity can = capacity_of(c);
  const TransportOptions port = service_port(c, can);
  Run run(c, memory_for_jobs(port));
  if (const auto wrong = run.access->load(); !wrong.empty()) return fail(wrong, kRefusedToStart);
  auto work = Transport::open(port, service_of(*run.app));
  if (!work) return fail(work.error());
  auto probes = open_admin_port(c.admin_host, c.admin_port, run.admin_sources(c));
  if (!probes) return fail(probes.error());
  run.work = &*work;

  auto probes_served = start(*probes);
  await_serving(*probes, probes_served);
  if (finished(probes_served, 0s)) probes_served.get();  // rethrows its exception
  if (const auto fault = selftest_fault(); !fault.empty()) {
    probes->drain(0ms);
    return fail(fault);
  }
  run.log.write(ready_line(work->port(), probes->port(), api::version()));
  run.log.write(capacity_line(can, c.queue));
  run.log.flush(kLogPatience);  // first, before any request can queue a line
  auto work_served = start(*work);
  await_serving(*work, work_served);
  if (finished(work_served, 0s)) work_served.get();
  run.ready = true;

  signals.wait([&] { run.reload(c); });
  run.stopping();
  stop_work(*work, work_served, run.jobs, c);
  probes->drain(kLastProbe);
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
