#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "server/app.hpp"

namespace tubecut::server {

/// Counters and histograms in Prometheus' terms. Labels come from closed sets only (endpoint ids,
/// error codes, statuses), so the number of series is bounded whatever clients send.
class Metrics {
 public:
  /// `log_drops` is read at each scrape, `ready` too.
  Metrics(std::function<std::uint64_t()> log_drops, std::function<bool()> ready);
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  void started();
  void finished(const JobRecord& job);

  /// The text exposition format, version 0.0.4.
  [[nodiscard]] std::string text();

 private:
  struct Impl;
  std::unique_ptr<Impl> x_;
};

}  // namespace tubecut::server
