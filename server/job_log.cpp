#include "server/job_log.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "server/json_line.hpp"

namespace tubecut::server {
namespace {

constexpr std::size_t kQueueBytes = 4u << 20;
constexpr auto kPatience = std::chrono::milliseconds(500);

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

std::string_view level_of(int status) {
  if (status >= 500) return "error";
  return status >= 400 ? "warning" : "info";
}

}  // namespace

/// Shared with its thread, which a reader that never reads leaves behind.
struct JobLog::Impl {
  void run() {
    std::unique_lock lock(mutex);
    for (;;) {
      some.wait(lock, [this] { return ending || !queue.empty(); });
      if (queue.empty()) break;
      const std::string line = std::move(queue.front());
      queue.pop_front();
      bytes -= line.size();
      const auto drops = overrun - std::exchange(reported, overrun);
      lock.unlock();
      if (drops > 0) put(drops_line(drops));
      put(line);
      lock.lock();
      ++handled;
      idle.notify_all();
    }
    ended = true;
    idle.notify_all();
  }

  void put(const std::string& line) {
    if (!write_all(descriptor, line + '\n')) ++failed;
  }

  [[nodiscard]] static std::string drops_line(std::uint64_t count) {
    return JsonLine{}
        .text("ts", utc(std::chrono::system_clock::now()))
        .text("level", "warning")
        .text("event", "log_dropped")
        .integer("count", static_cast<std::int64_t>(count))
        .done();
  }

  int descriptor = 1;
  std::size_t most = 0;
  std::mutex mutex;
  std::condition_variable some;
  std::condition_variable idle;
  std::deque<std::string> queue;
  std::size_t bytes = 0;
  std::uint64_t queued = 0;
  std::uint64_t handled = 0;
  std::uint64_t overrun = 0;
  std::uint64_t reported = 0;  // of overrun
  bool ending = false;
  bool ended = false;
  std::atomic<std::uint64_t> failed = 0;
};

JobLog::JobLog(std::size_t queue, int descriptor) : x_(std::make_shared<Impl>()) {
  x_->most = queue;
  x_->descriptor = descriptor;
  std::thread([x = x_] { x->run(); }).detach();
}

JobLog::~JobLog() {
  std::unique_lock lock(x_->mutex);
  x_->ending = true;
  x_->some.notify_all();
  x_->idle.wait_for(lock, kPatience, [this] { return x_->ended; });
}

void JobLog::write(std::string_view line) {
  {
    const std::lock_guard lock(x_->mutex);
    x_->queue.emplace_back(line);
    x_->bytes += line.size();
    ++x_->queued;
    while (x_->queue.size() > x_->most || (x_->bytes > kQueueBytes && x_->queue.size() > 1)) {
      x_->bytes -= x_->queue.front().size();
      x_->queue.pop_front();
      ++x_->overrun;
    }
  }
  x_->some.notify_one();
}

std::uint64_t JobLog::dropped() const {
  const std::lock_guard lock(x_->mutex);
  return x_->overrun + x_->failed;
}

bool JobLog::flush(std::chrono::milliseconds patience) {
  std::unique_lock lock(x_->mutex);
  return x_->idle.wait_for(lock, patience,
                           [this] { return x_->handled + x_->overrun >= x_->queued; });
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
  line.text("engine", fmt::format("tubecut {}", api::version()))
      .integer("numerics", api::numerics());
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
