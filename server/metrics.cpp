#include "server/metrics.hpp"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>
#include <unistd.h>

#include <fstream>
#include <mutex>
#include <sstream>

#include "api/api.hpp"

namespace tubecut::server {
namespace {

using prometheus::Counter;
using prometheus::Family;
using prometheus::Gauge;
using prometheus::Histogram;

/// Seconds; from a table of one tube to the largest job.
const Histogram::BucketBoundaries kSeconds = {0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025,
                                              0.05,   0.1,   0.25,   0.5,   1.0,  2.5};

Family<Counter>& counter(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(registry);
}

Family<Gauge>& gauge(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildGauge().Name(name).Help(help).Register(registry);
}

/// Bytes of memory resident now; 0 where /proc is not there.
double resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  double total = 0.0;
  double resident = 0.0;
  statm >> total >> resident;
  return statm ? resident * static_cast<double>(sysconf(_SC_PAGESIZE)) : 0.0;
}

}  // namespace

struct Metrics::Impl {
  std::function<std::uint64_t()> drops;
  std::function<bool()> is_ready;
  std::mutex scrape;
  prometheus::Registry registry;

  Family<Counter>& requests = counter(registry, "tubecut_http_requests_total",
                                      "Requests answered, by endpoint and HTTP status.");
  Family<Histogram>& seconds = prometheus::BuildHistogram()
                                   .Name("tubecut_http_request_seconds")
                                   .Help("Time from the whole request to the whole answer.")
                                   .Register(registry);
  Family<Counter>& errors =
      counter(registry, "tubecut_errors_total", "Problems answered, by endpoint and error code.");
  Family<Counter>& stages =
      counter(registry, "tubecut_stage_seconds_total", "Seconds spent in each stage of a job.");
  Family<Counter>& unproven = counter(registry, "tubecut_verification_failures_total",
                                      "Answers withheld because a check failed: each is a bug.");
  Counter& bytes_in =
      counter(registry, "tubecut_request_body_bytes_total", "Bytes of request bodies.").Add({});
  Counter& bytes_out =
      counter(registry, "tubecut_response_body_bytes_total", "Bytes of answers' bodies.").Add({});
  Counter& dropped = counter(registry, "tubecut_log_lines_dropped_total",
                             "Log lines dropped because stdout was not read.")
                         .Add({});
  Gauge& in_flight = gauge(registry, "tubecut_in_flight", "Requests being answered now.").Add({});
  Gauge& ready = gauge(registry, "tubecut_ready", "1 while /readyz says yes.").Add({});
  Gauge& resident = gauge(registry, "process_resident_memory_bytes", "Resident memory.").Add({});

  Impl(std::function<std::uint64_t()> log_drops, std::function<bool()> ready_now)
      : drops(std::move(log_drops)), is_ready(std::move(ready_now)) {
    gauge(registry, "tubecut_build_info", "Always 1; the labels name the engine.")
        .Add({{"version", std::string(api::version())},
              {"numerics", std::to_string(api::numerics())}})
        .Set(1.0);
    unproven.Add({});  // there from the start: an alert on it needs a zero to rise from
  }
};

Metrics::Metrics(std::function<std::uint64_t()> log_drops, std::function<bool()> ready)
    : x_(std::make_unique<Impl>(std::move(log_drops), std::move(ready))) {}
Metrics::~Metrics() = default;

void Metrics::started() { x_->in_flight.Increment(); }

void Metrics::finished(const JobRecord& job) {
  x_->in_flight.Decrement();
  const std::string endpoint = job.facts.endpoint.empty() ? "none" : job.facts.endpoint;
  const std::string status = std::to_string(job.status);
  x_->requests.Add({{"endpoint", endpoint}, {"status", status}}).Increment();
  x_->seconds.Add({{"endpoint", endpoint}, {"status", status}}, kSeconds).Observe(job.seconds);
  for (const auto& stage : job.facts.stages) {
    x_->stages.Add({{"endpoint", endpoint}, {"stage", std::string(stage.name)}})
        .Increment(stage.seconds);
  }
  if (!job.facts.error_code.empty()) {
    x_->errors.Add({{"endpoint", endpoint}, {"code", job.facts.error_code}}).Increment();
  }
  if (job.facts.error_code == "verification_failed") x_->unproven.Add({}).Increment();
  x_->bytes_in.Increment(static_cast<double>(job.bytes_in));
  x_->bytes_out.Increment(static_cast<double>(job.bytes_out));
}

std::string Metrics::text() {
  const std::lock_guard one_scrape(x_->scrape);
  const auto drops = static_cast<double>(x_->drops());
  x_->dropped.Increment(drops - x_->dropped.Value());
  x_->ready.Set(x_->is_ready() ? 1.0 : 0.0);
  x_->resident.Set(resident_bytes());
  std::ostringstream out;
  prometheus::TextSerializer().Serialize(out, x_->registry.Collect());
  return out.str();
}

}  // namespace tubecut::server
