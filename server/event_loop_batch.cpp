// Batches: one request whose lines become jobs like others, and whose answer is sent in chunks
// (RFC 9112, 7.1) as they finish.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "server/event_loop.hpp"

namespace tubecut::server {
namespace {

using namespace std::chrono_literals;
using State = Connection::State;

/// Answers held for a client that is slow to take them; no further line begins beyond.
constexpr std::size_t kHeld = 512u << 10;
constexpr auto kAskAgain = 20ms;  // a full queue, memory in use, or the key's rate
constexpr std::size_t kReadAtOnce = 64u << 10;
constexpr std::string_view kLastChunk = "0\r\n\r\n";

std::string chunk(std::string_view text) {
  return fmt::format("{:x}\r\n{}\r\n", text.size(), text);
}

std::string print_head(const Response& head, bool close, bool chunked) {
  std::string out = fmt::format("HTTP/1.1 200 OK\r\nContent-Type: {}\r\n", head.content_type);
  for (const auto& [name, value] : head.headers) out += fmt::format("{}: {}\r\n", name, value);
  if (close) out += "Connection: close\r\n";
  return out + (chunked ? "Transfer-Encoding: chunked\r\n\r\n" : "\r\n");
}

/// A large line is not even read for its id: that would hold up the port.
void refuse_line(Request& line, Refusal refusal) {
  line.refusal = std::move(refusal);
  if (line.body.size() > kReadAtOnce) line.body = {};
}

/// The next line that is not blank, and where the one after begins.
std::string_view next_line(std::string_view lines, std::size_t& at) {
  while (at < lines.size()) {
    const auto end = std::min(lines.find('\n', at), lines.size());
    auto line = lines.substr(at, end - at);
    at = end + 1;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.find_first_not_of(" \t") != line.npos) return line;
  }
  return {};
}

}  // namespace

std::optional<Refusal> EventLoop::batch_refusal(const Request& whole) {
  if (auto refusal = service_.screen(whole)) return refusal;  // an empty one was whole at its head
  const auto memory = whole.body.size();
  const bool room = memory_ == 0 || lines_ + memory <= memory_ / kWaiting;
  if (!room || !make_memory(memory)) {
    ++counters_.bytes;
    return Refusal{ErrorCode::overloaded, "The memory for jobs is in use."};
  }
  return service_.admit ? service_.admit(whole) : std::nullopt;
}

void EventLoop::begin_batch(Connection& c, const std::shared_ptr<Job>& job) {
  const auto memory = job->request.body.size();
  job->request.refusal = batch_refusal(job->request);
  const Response head =
      job->request.refusal ? Response{.status = 0} : service_.batch_head(job->request);
  if (head.status != 200) return write(c, print_(job->request, job->close));
  c.state = State::batching;
  c.batch = std::make_unique<Batch>();
  c.batch->chunked = c.reader.takes_chunks();
  c.batch->lines = std::move(job->request.body);
  c.batch->head = std::move(job->request);
  auto& common = c.batch->head.headers;  // the lines go by the name the client is told
  const auto is_id = [](const auto& field) {
    return equal_ignoring_case(field.first, "X-Request-Id");
  };
  std::erase_if(common, is_id);
  std::ranges::copy_if(head.headers, std::back_inserter(common), is_id);
  counters_.memory += memory;
  lines_ += memory;
  std::size_t at = 0;
  while (!next_line(c.batch->lines, at).empty()) ++c.batch->count.items;
  c.batch->count.bytes_in = memory;
  c.out = print_head(head, c.closing, c.batch->chunked);
  c.out_at = 0;
  counters_.memory += c.out.size();
  feed(c);
}

/// Sends what is answered and begins as many lines as are worked on at a time: one more than there
/// are slots, so that no slot waits, and other requests wait for no more than these.
void EventLoop::feed(Connection& c) {
  send_batch(c);
  if (!connections_.contains(&c)) return;
  Batch& batch = *c.batch;
  batch.again = Clock::time_point::max();
  const auto most = static_cast<std::size_t>(slots_->count()) + 1;
  while (!batch.stopped && batch.running.size() < most && c.out.size() < kHeld) {
    const auto before = batch.at;
    const auto line = next_line(batch.lines, batch.at);
    if (line.empty()) {
      batch.stopped = true;
    } else if (!feed_line(c, line)) {
      batch.at = before;
      batch.again = Clock::now() + kAskAgain;
      break;
    }
  }
  forget_begun(batch);
  if (batch.stopped && batch.running.empty()) return end_batch(c);
  set_batch_deadline(c);
}

/// False when the line has to wait: for memory, for a full queue, or for the rate of the batch's
/// key.
bool EventLoop::feed_line(Connection& c, std::string_view line) {
  Batch& batch = *c.batch;
  const bool fits = memory_ == 0 || memory_of(line.size()) <= memory_ - memory_ / kWaiting;
  const auto memory = fits ? memory_of(line.size()) : 0;
  const bool has = has_memory_in_time(batch, memory);
  if (!has && !over_wait(batch)) return false;
  if (!batch.paid && service_.admit && service_.admit(batch.head)) return false;
  batch.paid = true;
  auto job = std::make_shared<Job>();
  job->request = batch.head;
  job->request.body = line;
  job->request.line = batch.line + 1;
  job->request.stop = job->stop.get_token();
  job->request.times.read = job->request.times.received =
      std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  job->owner = &c;
  if (!fits) {
    refuse_line(job->request, {ErrorCode::body_too_large,
                               "This replica's memory has no room for a line of that size."});
  } else if (!has) {
    refuse_line(job->request, {ErrorCode::overloaded, "The memory for jobs is in use."});
  } else {
    job->memory = memory;
  }
  if (service_.budget) job->end = Clock::now() + service_.budget(job->request);
  if (!slots_->offer(job)) return false;
  if (!has) ++counters_.bytes;
  batch.waits_since.reset();
  counters_.memory += job->memory;
  ++batch.line;
  batch.paid = false;
  batch.running.push_back(std::move(job));
  return true;
}

/// Whether the memory for the next line is there. Slow takers give way when the wait for it begins
/// and when it is over: to ask all connections each time would hold up the port.
bool EventLoop::has_memory_in_time(Batch& batch, std::size_t bytes) {
  if (has_memory(bytes)) return true;
  const bool first = !batch.waits_since;
  if (first) batch.waits_since = Clock::now();
  return (first || over_wait(batch)) && make_memory(bytes);
}

/// Whether the next line has waited for memory as long as a job may take.
bool EventLoop::over_wait(const Batch& batch) const {
  const auto most = service_.budget ? service_.budget(batch.head) : 0ms;
  return most > 0ms && Clock::now() - *batch.waits_since >= most;
}

/// Lines already begun need not be kept.
void EventLoop::forget_begun(Batch& batch) {
  if (2 * batch.at < batch.lines.size()) return;
  const auto begun = std::min(batch.at, batch.lines.size());
  batch.lines.erase(0, begun);
  batch.lines.shrink_to_fit();
  batch.at = 0;
  counters_.memory -= begun;
  lines_ -= begun;
}

void EventLoop::say(Connection& c, const std::string& bytes) {
  c.out += bytes;
  counters_.memory += bytes.size();
}

void EventLoop::answer_line(Connection& c, std::string_view text, bool refused) {
  ++(refused ? c.batch->count.refused : c.batch->count.answered);
  say(c, c.batch->chunked ? chunk(text) : std::string(text));
  c.batch->count.bytes_out += text.size();
}

void EventLoop::finish_line(Connection& c, Job& job) {
  std::erase_if(c.batch->running, [&job](const auto& one) { return one.get() == &job; });
  answer_line(c, job.answer, job.refused);
  feed(c);
}

/// What is held for the client has to be taken within the time for an answer, not a byte of it.
void EventLoop::send_batch(Connection& c) {
  Batch& batch = *c.batch;
  const auto size = c.out.size();
  const auto done = c.send();
  if (!done) {
    ++counters_.hung_up;
    return close(c);
  }
  c.out.erase(0, c.out_at);
  c.out_at = 0;
  const auto taken = size - c.out.size();
  counters_.memory -= taken;
  batch.owed -= std::min(batch.owed, taken);
  if (batch.owed > 0) return;
  batch.owed = c.out.size();
  batch.stalled = c.out.empty() ? Clock::time_point::max() : Clock::now() + options_.write;
}

void EventLoop::end_batch(Connection& c) {
  Response summary = service_.summary(c.batch->head, c.batch->count);
  say(c, c.batch->chunked ? chunk(summary.body) + std::string(kLastChunk) : summary.body);
  c.sent = std::move(summary.sent);
  drop_batch(c);
  begin_writing(c);
}

void EventLoop::drop_batch(Connection& c) {
  if (!c.batch) return;
  for (const auto& job : c.batch->running) {
    job->owner = nullptr;
    job->stop.request_stop();
    if (slots_->withdraw(job)) release(*job);
  }
  counters_.memory -= c.batch->lines.size();
  lines_ -= c.batch->lines.size();
  c.batch = nullptr;
}

void EventLoop::set_batch_deadline(Connection& c) {
  auto when = std::min(c.batch->stalled, c.batch->again);
  for (const auto& job : c.batch->running) when = std::min(when, job->end);
  set_deadline(c, when);
}

void EventLoop::expire_batch(Connection& c) {
  const auto now = Clock::now();
  if (c.gone_by <= now || c.batch->stalled <= now) {
    ++(c.gone_by <= now ? counters_.hung_up : counters_.over_time);
    return close(c);
  }
  const auto running = c.batch->running;
  for (const auto& job : running) {
    if (job->end > now) continue;
    job->end = Clock::time_point::max();
    if (!slots_->withdraw(job)) {
      job->stop.request_stop();
      continue;
    }
    ++counters_.wait;
    release(*job);
    refuse_line(job->request, {ErrorCode::overloaded, "No slot was free within the job's budget."});
    std::erase(c.batch->running, job);
    answer_line(c, service_.line(job->request).text, true);
  }
  feed(c);
}

}  // namespace tubecut::server
