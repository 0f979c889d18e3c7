#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "server/app.hpp"
#include "server/jobs/capacity.hpp"

namespace tubecut::server {

/// Lines on a file descriptor, written by a separate thread. If a reader stops reading, it blocks
/// no job: the queue is bounded, in lines and in bytes (4 MiB); the oldest lines are dropped and
/// counted, and a line reports their number when writing continues. Two loggers of spdlog write to
/// the queue, which is their sink, because spdlog's own queue counts messages and not their bytes.
class JobLog {
 public:
  /// `least`: "info", "warning" or "error", the level from which jobs' lines are written.
  explicit JobLog(std::size_t queue, const std::string& least = "info", int descriptor = 1);
  ~JobLog();
  JobLog(const JobLog&) = delete;
  JobLog& operator=(const JobLog&) = delete;

  /// Queue one line (without its end of line): of a job that ended with that status, or of the
  /// service, at any level. Never block on the descriptor.
  void write_job(int status, std::string_view line);
  void write(std::string_view line);

  /// Number of lines dropped or not writable until now.
  [[nodiscard]] std::uint64_t dropped() const;

  /// Waits until every queued line is written, at most for `patience`. Returns whether all were
  /// written.
  bool flush(std::chrono::milliseconds patience);

 private:
  class Queue;
  struct Loggers;
  std::shared_ptr<Queue> queue_;
  std::unique_ptr<Loggers> loggers_;
};

/// {"event":"ready",...}: the first line of every run.
[[nodiscard]] std::string ready_line(int port, int admin_port, std::string_view version);

/// Returns {"event":"capacity",...}: the resources that the process may use.
[[nodiscard]] std::string capacity_line(const Capacity& capacity, std::size_t queue);

/// The line of one job, at that UTC time.
[[nodiscard]] std::string job_line(const JobRecord& job, std::chrono::system_clock::time_point now);

/// Returns the events of one job for its own file: received, read, started, decoded, validated,
/// computed, verified, encoded, sent; one line each, then the job's line.
[[nodiscard]] std::string job_events(const JobRecord& job,
                                     std::chrono::system_clock::time_point now);

/// "2024-03-01T12:00:00.123Z"
[[nodiscard]] std::string utc(std::chrono::system_clock::time_point time);

}  // namespace tubecut::server
