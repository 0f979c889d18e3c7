#include "server/observe/metrics.hpp"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "api/api.hpp"
#include "server/status.hpp"

namespace tubecut::server {
namespace {

using prometheus::Counter;
using prometheus::Family;
using prometheus::Gauge;
using prometheus::Histogram;

/// Seconds: OpenTelemetry's advice for http.server.request.duration, and three below it: most jobs
/// take about a millisecond.
const Histogram::BucketBoundaries kSeconds = {0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025,
                                              0.05,   0.075, 0.1,    0.25,  0.5,  0.75,
                                              1.0,    2.5,   5.0,    7.5,   10.0};
const Histogram::BucketBoundaries kBytes = {1e3, 1e4, 1e5, 1e6, 1e7};

Family<Counter>& counter(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(registry);
}

Family<Gauge>& gauge(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildGauge().Name(name).Help(help).Register(registry);
}

Family<Histogram>& histogram(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildHistogram().Name(name).Help(help).Register(registry);
}

/// Returns the resident bytes of memory now; 0 without /proc.
double resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  double total = 0.0;
  double resident = 0.0;
  statm >> total >> resident;
  return statm ? resident * static_cast<double>(sysconf(_SC_PAGESIZE)) : 0.0;
}

/// Returns the start time of this process in seconds since 1970, to a hundredth; 0 without /proc.
double begun_at() {
  std::ifstream file("/proc/self/stat");
  std::string stat{std::istreambuf_iterator<char>(file), {}};
  std::istringstream after_name(stat.substr(std::min(stat.rfind(')') + 1, stat.size())));
  const std::vector<std::string> fields{std::istream_iterator<std::string>(after_name), {}};
  constexpr std::size_t kStartTime = 19;  // the 22nd of all, proc(5)
  timespec booted{};
  timespec now{};
  if (fields.size() <= kStartTime || clock_gettime(CLOCK_BOOTTIME, &booted) != 0 ||
      clock_gettime(CLOCK_REALTIME, &now) != 0)
    return 0.0;
  const auto seconds = [](const timespec& t) {
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  };
  return seconds(now) - seconds(booted) +
         std::stod(fields[kStartTime]) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

/// Seconds of CPU of all threads, in the system's calls too.
double cpu_seconds() {
  timespec used{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

double open_descriptors() {
  std::error_code unknown;
  double count = -1.0;  // that which reads the folder
  for (std::filesystem::directory_iterator it("/proc/self/fd", unknown), end; !unknown && it != end;
       it.increment(unknown))
    ++count;
  return std::max(count, 0.0);
}

double most_descriptors() {
  rlimit limit{};
  return getrlimit(RLIMIT_NOFILE, &limit) == 0 ? static_cast<double>(limit.rlim_cur) : 0.0;
}

/// Clients may send any method; the label may not be any text.
std::string method_label(std::string_view method) {
  constexpr std::array<std::string_view, 8> kKnown = {"GET",    "HEAD",    "POST",  "PUT",
                                                      "DELETE", "OPTIONS", "PATCH", "TRACE"};
  const bool known = std::ranges::find(kKnown, method) != kKnown.end();
  return known ? std::string(method) : "_OTHER";
}

constexpr const char* kNoEndpoint = "none";

prometheus::Labels error_labels(std::string_view endpoint, std::string_view code, int status) {
  return {{"endpoint", std::string(endpoint)},
          {"code", std::string(code)},
          {"http_response_status_code", std::to_string(status)}};
}

/// The codes answered with 5xx, and their statuses.
std::vector<std::pair<std::string_view, int>> failures() {
  std::vector<std::pair<std::string_view, int>> out = {
#define X(code, kind, meaning, action) {#code, status_of(ErrorKind::kind)},
      TUBECUT_ERRORS(X)
#undef X
  };
  std::erase_if(out, [](const auto& code) { return code.second < 500; });
  return out;
}

void catch_up(Counter& counter, std::uint64_t total) {
  const double behind = static_cast<double>(total) - counter.Value();
  if (behind > 0.0) counter.Increment(behind);
}

std::string_view compiler() {
#if defined(__clang__)
  return "clang " __clang_version__;
#else
  return "gcc " __VERSION__;
#endif
}

}  // namespace

struct Metrics::Impl {
  MetricSources sources;
  std::mutex scrape;
  prometheus::Registry registry;

  Family<Histogram>& requests =
      histogram(registry, "http_server_request_duration_seconds",
                "From the whole request to the whole answer, waiting for a slot included.");
  Gauge& active =
      gauge(registry, "http_server_active_requests", "Requests being answered.").Add({});
  Family<Histogram>& bytes_in =
      histogram(registry, "http_server_request_body_size_bytes", "Bytes of requests' bodies.");
  Family<Histogram>& bytes_out =
      histogram(registry, "http_server_response_body_size_bytes", "Bytes of answers' bodies.");
  Family<Histogram>& stages = histogram(registry, "tubecut_stage_duration_seconds",
                                        "Time in each stage of a job, and its wait for a slot.");
  Family<Counter>& jobs = counter(registry, "tubecut_jobs_total",
                                  "Jobs by endpoint and verdict: ok, review, reject, or refused.");
  Family<Counter>& errors = counter(registry, "tubecut_errors_total",
                                    "Problems answered, by endpoint, error code and status.");
  Family<Counter>& unproven = counter(registry, "tubecut_verification_failures_total",
                                      "Answers withheld because a check failed: each is a bug.");
  Family<Counter>& refused = counter(registry, "tubecut_refused_total",
                                     "Requests refused because a limit was reached, by reason.");
  Counter& rate = refused.Add({{"reason", "rate"}});
  Family<Counter>& lines = counter(registry, "tubecut_log_lines_dropped_total",
                                   "Log lines dropped because stdout was not read.");
  Counter& dropped = lines.Add({});
  Counter& files =
      counter(registry, "tubecut_log_files_dropped_total", "Jobs whose file could not be written.")
          .Add({});
  Gauge& ready = gauge(registry, "tubecut_ready", "1 while /readyz is 200.").Add({});
  Gauge& resident = gauge(registry, "process_resident_memory_bytes", "Resident memory.").Add({});
  Counter& cpu =
      counter(registry, "process_cpu_seconds_total", "CPU of all threads, system time included.")
          .Add({});
  Gauge& descriptors = gauge(registry, "process_open_fds", "Open descriptors.").Add({});
  Gauge& descriptors_most = gauge(registry, "process_max_fds", "The most of them.").Add({});
  Family<Counter>& reloads = counter(registry, "tubecut_reloads_failed_total",
                                     "Files read again at SIGHUP that are wrong, by kind.");
  Family<Gauge>& configuration = gauge(
      registry, "tubecut_configuration_info",
      "Always 1; sha256 covers everything that answers depend on in addition to their requests.");
  std::pair<std::string, Gauge*> configured;
  std::vector<std::pair<Counter*, std::uint64_t TransportStats::*>> counts;
  std::vector<std::pair<Gauge*, std::uint64_t TransportStats::*>> levels;

  explicit Impl(MetricSources of) : sources(std::move(of)) {
    gauge(registry, "tubecut_build_info", "Always 1; the labels name the build.")
        .Add({{"version", std::string(api::version())},
              {"commit", std::string(api::commit())},
              {"compiler", std::string(compiler())}})
        .Set(1.0);
    gauge(registry, "tubecut_numerics_info",
          "The integer raised with every change of a result bit.")
        .Add({})
        .Set(api::numerics());
    gauge(registry, "process_start_time_seconds", "Start time of the process, since 1970.")
        .Add({})
        .Set(begun_at());
    start_at_zero();
    count_refusals();
    show_levels();
  }

  /// increase() sees only growth, so a series that begins with its first failure would hide it.
  void start_at_zero() {
    auto endpoints = api::endpoint_ids();
    endpoints.emplace_back(kNoEndpoint);
    const auto codes = failures();
    for (const auto* what : {"keys", "machines", "posts"}) reloads.Add({{"what", what}});
    for (const auto endpoint : endpoints) {
      unproven.Add({{"endpoint", std::string(endpoint)}});
      for (const auto& [code, status] : codes) {
        errors.Add(error_labels(endpoint, code, status));
      }
    }
  }

  /// Ends the series of a configuration that no longer applies.
  void show_configuration() {
    auto sha256 = api::configuration_sha256();
    if (sha256 == configured.first) return;
    if (configured.second != nullptr) configuration.Remove(configured.second);
    auto& now = configuration.Add({{"sha256", sha256}});
    now.Set(1.0);
    configured = {std::move(sha256), &now};
  }

  void show_process() {
    ready.Set(sources.ready() ? 1.0 : 0.0);
    resident.Set(resident_bytes());
    cpu.Increment(std::max(cpu_seconds() - cpu.Value(), 0.0));
    descriptors.Set(open_descriptors());
    descriptors_most.Set(most_descriptors());
  }

  void count_refusals() {
    using T = TransportStats;
    const std::vector<std::pair<const char*, std::uint64_t T::*>> reasons = {
        {"queue_full", &T::refused_queue},
        {"no_slot_in_time", &T::refused_wait},
        {"memory", &T::refused_memory},
        {"connections", &T::refused_connections}};
    for (const auto& [reason, field] : reasons) {
      counts.emplace_back(&refused.Add({{"reason", reason}}), field);
    }
    counts.emplace_back(&counter(registry, "tubecut_clients_hung_up_total",
                                 "Clients that left before their answer.")
                             .Add({}),
                        &T::hung_up);
    counts.emplace_back(&counter(registry, "tubecut_clients_too_slow_total",
                                 "Clients beyond their time to send or to take.")
                             .Add({}),
                        &T::over_time);
  }

  void show_levels() {
    using T = TransportStats;
    const auto level = [&](const char* name, const char* help, std::uint64_t T::*field) {
      levels.emplace_back(&gauge(registry, name, help).Add({}), field);
    };
    level("tubecut_slots", "Jobs that can be computed at a time.", &T::slots);
    level("tubecut_slots_busy", "Jobs being computed.", &T::busy);
    level("tubecut_queue_depth", "Jobs that wait for a slot.", &T::waiting);
    level("tubecut_connections", "Connections open.", &T::connections);
    level("tubecut_memory_reserved_bytes", "Set aside for bodies and answers.", &T::memory);
    level("tubecut_memory_bound_bytes", "For bodies, jobs and answers; 0: no bound.",
          &T::memory_bound);
  }
};

Metrics::Metrics(MetricSources sources) : x_(std::make_unique<Impl>(std::move(sources))) {}
Metrics::~Metrics() = default;

void Metrics::started() { x_->active.Increment(); }

void Metrics::finished(const JobRecord& job) {
  x_->active.Decrement();
  const bool known = !job.facts.endpoint.empty();
  const std::string endpoint = known ? job.facts.endpoint : kNoEndpoint;
  const std::string route = known ? "/v1/" + job.facts.endpoint : "other";
  const prometheus::Labels http = {{"http_request_method", method_label(job.method)},
                                   {"http_route", route},
                                   {"http_response_status_code", std::to_string(job.status)}};
  const double waited = job.times.started > 0.0 ? job.times.started - job.times.read : 0.0;
  x_->requests.Add(http, kSeconds).Observe(waited + job.seconds);
  x_->bytes_in.Add({{"http_route", route}}, kBytes).Observe(static_cast<double>(job.bytes_in));
  x_->bytes_out.Add({{"http_route", route}}, kBytes).Observe(static_cast<double>(job.bytes_out));
  auto stages = job.facts.stages;
  if (job.times.started > 0.0) stages.insert(stages.begin(), {"wait", waited});
  for (const auto& stage : stages) {
    x_->stages.Add({{"endpoint", endpoint}, {"stage", std::string(stage.name)}}, kSeconds)
        .Observe(stage.seconds);
  }
  const std::string& code = job.facts.error_code;
  if (known && !job.batch) {  // a batch's lines are the jobs
    const std::string verdict = code.empty() ? job.facts.verdict : "refused";
    x_->jobs.Add({{"endpoint", endpoint}, {"verdict", verdict}}).Increment();
  }
  if (!code.empty()) x_->errors.Add(error_labels(endpoint, code, job.status)).Increment();
  if (code == "verification_failed") x_->unproven.Add({{"endpoint", endpoint}}).Increment();
  if (code == "rate_limited") x_->rate.Increment();
}

void Metrics::reload_failed(const char* what) { x_->reloads.Add({{"what", what}}).Increment(); }

std::string Metrics::text() {
  const std::lock_guard one_scrape(x_->scrape);
  catch_up(x_->dropped, x_->sources.log_drops());
  catch_up(x_->files, x_->sources.file_drops());
  const auto stats = x_->sources.transport();
  for (const auto& [counter, field] : x_->counts) catch_up(*counter, stats.*field);
  for (const auto& [gauge, field] : x_->levels) gauge->Set(static_cast<double>(stats.*field));
  x_->show_configuration();
  x_->show_process();
  std::ostringstream out;
  prometheus::TextSerializer().Serialize(out, x_->registry.Collect());
  return out.str();
}

}  // namespace tubecut::server
