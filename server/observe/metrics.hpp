#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "server/app.hpp"
#include "server/http/transport.hpp"

namespace tubecut::server {

/// The values that each scrape reads.
struct MetricSources {
  std::function<std::uint64_t()> log_drops = [] { return std::uint64_t{0}; };
  std::function<std::uint64_t()> file_drops = [] { return std::uint64_t{0}; };
  std::function<bool()> ready = [] { return false; };
  std::function<TransportStats()> transport = [] { return TransportStats{}; };
};

/// Counters and histograms for Prometheus; HTTP metrics use OpenTelemetry's names. Labels come from
/// closed sets only (endpoint ids, error codes, statuses), so clients cannot increase the number of
/// series.
class Metrics {
 public:
  explicit Metrics(MetricSources sources);
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  void started();
  void finished(const JobRecord& job);
  /// A file that was read again and is wrong; `what` is `keys` or `machines`.
  void reload_failed(const char* what);

  /// The text exposition format, version 0.0.4.
  [[nodiscard]] std::string text();

 private:
  struct Impl;
  std::unique_ptr<Impl> x_;
};

}  // namespace tubecut::server
