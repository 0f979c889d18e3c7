#include "server/observe/job_log.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <poll.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/sink.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "server/observe/json_line.hpp"

namespace tubecut::server {
namespace {

constexpr std::size_t kQueueBytes = 4u << 20;
constexpr auto kLogPatience = std::chrono::milliseconds(500);

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto n = ::write(descriptor, bytes.data(), bytes.size());
    if (n > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(n));
    } else if (errno == EAGAIN) {
      pollfd ready{.fd = descriptor, .events = POLLOUT, .revents = 0};
      ::poll(&ready, 1, -1);
    } else if (errno != EINTR) {
      return false;  // a closed pipe, a full disk: the line is lost, the service lives
    }
  }
  return true;
}

spdlog::level::level_enum level_of(int status) {
  if (status >= 500) return spdlog::level::err;
  return status >= 400 ? spdlog::level::warn : spdlog::level::info;
}

std::string_view name_of(spdlog::level::level_enum level) {
  const auto name = spdlog::level::to_string_view(level);
  return {name.data(), name.size()};
}

}  // namespace

/// The bounded queue and its thread, as a sink: each message is a line. Shared with the thread,
/// which a reader that never reads leaves behind.
class JobLog::Queue final : public spdlog::sinks::sink {
 public:
  Queue(std::size_t most, int descriptor) : descriptor_(descriptor), most_(most) {}

  void log(const spdlog::details::log_msg& message) override {
    {
      const std::lock_guard lock(mutex_);
      lines_.emplace_back(message.payload.data(), message.payload.size());
      bytes_ += lines_.back().size();
      ++queued_;
      while (lines_.size() > most_ || (bytes_ > kQueueBytes && lines_.size() > 1)) {
        bytes_ -= lines_.front().size();
        lines_.pop_front();
        ++overrun_;
      }
    }
    some_.notify_one();
  }
  void flush() override {}  // the thread writes as soon as it can
  void set_pattern(const std::string& /*pattern*/) override {}  // a line is JSON as it comes
  void set_formatter(std::unique_ptr<spdlog::formatter> /*formatter*/) override {}

  void run() {
    std::unique_lock lock(mutex_);
    for (;;) {
      some_.wait(lock, [this] { return ending_ || !lines_.empty(); });
      if (lines_.empty()) break;
      const std::string line = std::move(lines_.front());
      lines_.pop_front();
      bytes_ -= line.size();
      const auto drops = overrun_ - std::exchange(reported_, overrun_);
      lock.unlock();
      if (drops > 0) put(drops_line(drops));
      put(line);
      lock.lock();
      ++handled_;
      idle_.notify_all();
    }
    ended_ = true;
    idle_.notify_all();
  }
  void end(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    ending_ = true;
    some_.notify_all();
    idle_.wait_for(lock, patience, [this] { return ended_; });
  }
  bool wait(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    return idle_.wait_for(lock, patience, [this] { return handled_ + overrun_ >= queued_; });
  }
  [[nodiscard]] std::uint64_t dropped() {
    const std::lock_guard lock(mutex_);
    return overrun_ + failed_;
  }

 private:
  void put(const std::string& line) {
    if (!write_all(descriptor_, line + '\n')) ++failed_;
  }

  [[nodiscard]] static std::string drops_line(std::uint64_t count) {
    return JsonLine{}
        .text("ts", utc(std::chrono::system_clock::now()))
        .text("level", name_of(spdlog::level::warn))
        .text("event", "log_dropped")
        .integer("count", static_cast<std::int64_t>(count))
        .done();
  }

  const int descriptor_;
  const std::size_t most_;
  std::mutex mutex_;
  std::condition_variable some_;
  std::condition_variable idle_;
  std::deque<std::string> lines_;
  std::size_t bytes_ = 0;
  std::uint64_t queued_ = 0;
  std::uint64_t handled_ = 0;
  std::uint64_t overrun_ = 0;
  std::uint64_t reported_ = 0;  // of overrun_
  bool ending_ = false;
  bool ended_ = false;
  std::atomic<std::uint64_t> failed_ = 0;
};

struct JobLog::Loggers {
  spdlog::logger jobs, service;
};

JobLog::JobLog(std::size_t queue, const std::string& least, int descriptor)
    : queue_(std::make_shared<Queue>(queue, descriptor)),
      loggers_(std::make_unique<Loggers>(
          Loggers{spdlog::logger("jobs", queue_), spdlog::logger("service", queue_)})) {
  loggers_->jobs.set_level(spdlog::level::from_str(least));
  std::thread([q = queue_] { q->run(); }).detach();
}

JobLog::~JobLog() { queue_->end(kLogPatience); }

void JobLog::write_job(int status, std::string_view line) {
  loggers_->jobs.log(level_of(status), spdlog::string_view_t(line.data(), line.size()));
}

void JobLog::write(std::string_view line) {
  loggers_->service.log(spdlog::level::info, spdlog::string_view_t(line.data(), line.size()));
}

std::uint64_t JobLog::dropped() const { return queue_->dropped(); }

bool JobLog::flush(std::chrono::milliseconds patience) { return queue_->wait(patience); }

std::string utc(std::chrono::system_clock::time_point time) {
  const auto ms = std::chrono::floor<std::chrono::milliseconds>(time);
  const auto seconds = std::chrono::floor<std::chrono::seconds>(ms);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03d}Z",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(seconds)),
                     (ms - seconds).count());
}

std::string ready_line(int port, int admin_port, std::string_view version) {
  return JsonLine{}
      .text("event", "ready")
      .integer("port", port)
      .integer("admin_port", admin_port)
      .text("version", version)
      .done();
}

std::string capacity_line(const Capacity& capacity, std::size_t queue) {
  return JsonLine{}
      .text("event", "capacity")
      .integer("slots", capacity.slots)
      .text("slots_from", capacity.slots_from)
      .integer("queue", static_cast<std::int64_t>(queue))
      .integer("memory_bytes", static_cast<std::int64_t>(capacity.memory))
      .text("memory_from", capacity.memory_from)
      .integer("connections", capacity.connections)
      .done();
}

namespace {

struct Event {
  std::string_view name;
  double at = 0.0;  // seconds since the first byte
};

std::vector<Event> events_of(const JobRecord& job) {
  const double zero = job.times.received > 0.0 ? job.times.received : job.begun;
  std::vector<Event> events = {{"received", 0.0}};
  if (job.times.read > 0.0) events.push_back({"read", job.times.read - zero});
  if (job.times.started > 0.0) events.push_back({"started", job.times.started - zero});
  double at = job.begun - zero;
  for (const auto& stage : job.facts.stages) {
    at += stage.seconds;
    events.push_back({api::event_of(stage.name), at});
  }
  if (job.sent > 0.0) events.push_back({"sent", job.sent - zero});
  return events;
}

}  // namespace

std::string job_events(const JobRecord& job, std::chrono::system_clock::time_point now) {
  const auto events = events_of(job);
  std::string out;
  for (const auto& event : events) {
    const auto before = std::chrono::duration_cast<std::chrono::system_clock::duration>(
        std::chrono::duration<double>(events.back().at - event.at));
    out += JsonLine{}
               .text("ts", utc(now - before))
               .text("event", event.name)
               .text("job", job.facts.id)
               .text("request_id", job.request_id)
               .milliseconds("at_ms", event.at)
               .done();
    out += '\n';
  }
  return out + job_line(job, now) + '\n';
}

std::string job_line(const JobRecord& job, std::chrono::system_clock::time_point now) {
  JsonLine line;
  line.text("ts", utc(now)).text("level", name_of(level_of(job.status))).text("event", "job");
  line.text("job", job.facts.id).text("request_id", job.request_id);
  line.text("endpoint", job.facts.endpoint).text("method", job.method);
  line.text("engine", api::engine()).integer("numerics", api::numerics());
  line.text("replica", job.replica);
  line.integer("status", job.status).text("input_sha256", job.facts.input_sha256);
  line.text("result_sha256", job.facts.result_sha256);
  if (!job.facts.body_sha256.empty()) line.text("body_sha256", job.facts.body_sha256);
  line.text("verdict", job.facts.verdict).text("code", job.facts.error_code);
  line.open("reasons", '[');
  for (const auto& reason : job.facts.reasons) line.item(reason);
  line.close(']').open("warnings", '[');
  for (const auto& code : job.facts.warnings) line.item(code);
  line.close(']').open("stages_ms", '{');
  for (const auto& stage : job.facts.stages) line.milliseconds(stage.name, stage.seconds);
  line.close('}').open("at_ms", '{');
  for (const auto& event : events_of(job)) line.milliseconds(event.name, event.at);
  line.close('}').milliseconds("total_ms", job.seconds).milliseconds("cpu_ms", job.cpu);
  line.integer("bytes_in", static_cast<std::int64_t>(job.bytes_in));
  line.integer("bytes_out", static_cast<std::int64_t>(job.bytes_out));
  if (job.memory > 0) line.integer("memory_bytes", static_cast<std::int64_t>(job.memory));
  if (job.batch) {
    line.integer("items", static_cast<std::int64_t>(job.batch->items));
    line.integer("answered", static_cast<std::int64_t>(job.batch->answered));
    line.integer("refused", static_cast<std::int64_t>(job.batch->refused));
  }
  if (!job.client.empty()) line.text("client", job.client);
  if (!job.identity.empty()) line.text("identity", job.identity);
  if (!job.traceparent.empty()) line.text("traceparent", job.traceparent);
  line.open("reference", '{');
  for (const auto& [name, value] : job.facts.reference) line.text(name, value);
  line.close('}');
  if (!job.failure.empty()) line.text("failure", job.failure);
  return line.done();
}

}  // namespace tubecut::server
