#include "server/job_log.hpp"

#include <fmt/chrono.h>
#include <poll.h>
#include <spdlog/async.h>
#include <spdlog/async_logger.h>
#include <spdlog/sinks/sink.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <functional>
#include <thread>
#include <vector>

#include "server/json_line.hpp"

namespace tubecut::server {
namespace {

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

/// Writes each message as one line. Called by the log's own thread only.
class LineSink final : public spdlog::sinks::sink {
 public:
  LineSink(int descriptor, std::function<std::uint64_t()> overrun)
      : descriptor_(descriptor), overrun_(std::move(overrun)) {}

  void log(const spdlog::details::log_msg& msg) override {
    report_drops();
    put(std::string(msg.payload.data(), msg.payload.size()));
    ++handled_;
  }
  void flush() override {}
  void set_pattern(const std::string&) override {}
  void set_formatter(std::unique_ptr<spdlog::formatter>) override {}

  [[nodiscard]] std::uint64_t handled() const { return handled_; }
  [[nodiscard]] std::uint64_t failed() const { return failed_; }

 private:
  void put(std::string line) {
    line += '\n';
    if (!write_all(descriptor_, line)) ++failed_;
  }

  void report_drops() {
    const auto now = overrun_();
    if (now == reported_) return;
    put(JsonLine{}
            .text("ts", utc(std::chrono::system_clock::now()))
            .text("level", "warning")
            .text("event", "log_dropped")
            .integer("count", static_cast<std::int64_t>(now - reported_))
            .done());
    reported_ = now;
  }

  int descriptor_;
  std::function<std::uint64_t()> overrun_;
  std::uint64_t reported_ = 0;
  std::atomic<std::uint64_t> handled_ = 0;
  std::atomic<std::uint64_t> failed_ = 0;
};

std::string_view level_of(int status) {
  if (status >= 500) return "error";
  return status >= 400 ? "warning" : "info";
}

}  // namespace

struct JobLog::Impl {
  std::shared_ptr<spdlog::details::thread_pool> pool;
  std::shared_ptr<LineSink> sink;
  std::shared_ptr<spdlog::async_logger> logger;
  std::atomic<std::uint64_t> queued = 0;

  [[nodiscard]] std::uint64_t overrun() const { return pool->overrun_counter(); }
};

JobLog::JobLog(std::size_t queue, int descriptor) : x_(std::make_unique<Impl>()) {
  x_->pool = std::make_shared<spdlog::details::thread_pool>(queue, 1);
  const std::weak_ptr<spdlog::details::thread_pool> pool = x_->pool;
  x_->sink = std::make_shared<LineSink>(descriptor, [pool]() -> std::uint64_t {
    const auto alive = pool.lock();
    return alive ? alive->overrun_counter() : 0;
  });
  x_->logger = std::make_shared<spdlog::async_logger>(
      "jobs", x_->sink, x_->pool, spdlog::async_overflow_policy::overrun_oldest);
  x_->logger->set_level(spdlog::level::trace);
}

JobLog::~JobLog() {
  // Ending the pool joins its thread: with a reader that never reads, that would never end. Then
  // the thread is left to the end of the process.
  static auto* const abandoned = new std::vector<std::shared_ptr<spdlog::details::thread_pool>>;
  if (!flush(std::chrono::milliseconds(500))) abandoned->push_back(x_->pool);
}

void JobLog::write(std::string_view line) {
  ++x_->queued;
  x_->logger->log(spdlog::level::info, spdlog::string_view_t(line.data(), line.size()));
}

std::uint64_t JobLog::dropped() const { return x_->overrun() + x_->sink->failed(); }

bool JobLog::flush(std::chrono::milliseconds patience) {
  const auto until = std::chrono::steady_clock::now() + patience;
  while (x_->sink->handled() + x_->overrun() < x_->queued) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

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
  line.text("ts", utc(now)).text("level", level_of(job.status)).text("event", "job");
  line.text("job", job.facts.id).text("request_id", job.request_id);
  line.text("endpoint", job.facts.endpoint).text("method", job.method);
  line.integer("status", job.status).text("input_sha256", job.facts.input_sha256);
  line.text("verdict", job.facts.verdict).text("code", job.facts.error_code);
  line.open("warnings", '[');
  for (const auto& code : job.facts.warnings) line.item(code);
  line.close(']').open("stages_ms", '{');
  for (const auto& stage : job.facts.stages) line.milliseconds(stage.name, stage.seconds);
  line.close('}').open("at_ms", '{');
  for (const auto& event : events_of(job)) line.milliseconds(event.name, event.at);
  line.close('}').milliseconds("total_ms", job.seconds);
  line.integer("bytes_in", static_cast<std::int64_t>(job.bytes_in));
  line.integer("bytes_out", static_cast<std::int64_t>(job.bytes_out));
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
