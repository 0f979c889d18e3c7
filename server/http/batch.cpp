// One request whose lines become jobs like others, and whose answer is sent in chunks (RFC 9112,
// 7.1) as they finish.

#include "server/http/batch.hpp"

#include <algorithm>
#include <iterator>

#include "api/batch.hpp"

namespace tubecut::server {
namespace {

using namespace std::chrono_literals;

/// Answers held for a client that is slow to take them; no further line begins beyond.
constexpr std::size_t kHeld = 2u << 20;
/// The delay with which the scheduler may wake the port: lines that end within it begin ahead.
constexpr double kWakeDelayS = 0.004;
constexpr std::size_t kAhead = 8;
constexpr auto kAskAgain = 20ms;        // a full queue, memory in use, or the key's rate
constexpr auto kBatchPeerCheck = 50ms;  // whether the client is still there
/// Lines that are not jobs, after which further ones are answered and counted but not logged,
/// because a line of log is many times as long as such a line.
constexpr std::size_t kLogged = 100;
/// A gateway cuts off an answer that is silent for longer, so a blank line follows.
constexpr auto kSilence = 5s;
constexpr std::size_t kReadAtOnce = 64u << 10;
constexpr std::size_t kScanAtOnce = 256u << 10;  // bytes scanned before it yields

/// A large line is not even read for its id: that would hold up the port.
void refuse_line(Request& line, Refusal refusal) {
  line.refusal = std::move(refusal);
  if (line.body.size() > kReadAtOnce) give_back(line.body);
}

}  // namespace

Batch::Batch(Session& session, std::shared_ptr<Job> whole)
    : on_(session), port_(session.port_), whole_(std::move(whole)), held_(port_.lines) {}

std::optional<Refusal> Batch::refusal() {
  const Request& whole = whole_->request;
  if (auto refusal = port_.service.screen(whole))
    return refusal;  // an empty one was whole at its head
  if (auto refusal = memory_refusal(whole.body.size())) return refusal;
  return port_.service.admit ? port_.service.admit(whole) : std::nullopt;
}

std::optional<Refusal> Batch::memory_refusal(std::size_t bytes) {
  if (port_.lines.has(bytes) && port_.make_memory(bytes)) return std::nullopt;
  ++port_.counters.memory;
  return Refusal{ErrorCode::overloaded, "The memory for jobs is in use."};
}

Task<void> Batch::live() {
  if (whole_->begins) {
    co_await follow();
    co_return;
  }
  Request& request = whole_->request;
  request.refusal = refusal();
  const Response head = request.refusal ? Response{.status = 0} : port_.service.batch_head(request);
  if (head.status != 200) {
    Printed refused = port_.answer(request, whole_->close);
    co_await on_.send(std::move(refused));
    co_return;
  }
  auto lines = std::move(request.body);
  co_await stream(head, std::move(lines));
}

/// Behind the answer that the whole job begins with.
Task<void> Batch::follow() {
  Response head = *std::move(whole_->begins);
  whole_->memory = {};
  if (head.sent) std::exchange(head.sent, nullptr)(true);
  if (auto refusal = memory_refusal(head.lines.size())) {
    whole_->request.refusal = std::move(refusal);
    Printed refused = port_.answer(whole_->request, whole_->close);
    co_await on_.send(std::move(refused));
    co_return;
  }
  auto lines = std::exchange(head.lines, {});
  head_.target = api::kBatchesPath;
  co_await stream(std::move(head), std::move(lines));
}

Task<void> Batch::stream(Response head, std::string lines) {
  Request& request = whole_->request;
  chunked_ = on_.reader_.takes_chunks();
  lines_ = std::move(lines);
  held_.resize(lines_.size());
  count_.bytes_in = lines_.size();
  head_ = std::move(request);
  auto& common = head_.headers;  // the lines use the name that is sent to the client
  const auto is_id = [](const auto& field) {
    return equal_ignoring_case(field.first, "X-Request-Id");
  };
  std::erase_if(common, is_id);
  std::ranges::copy_if(head.headers, std::back_inserter(common), is_id);
  const auto idle = std::chrono::ceil<std::chrono::seconds>(port_.options.idle);
  on_.out_ =
      print_head(head, whole_->close ? 0s : idle, chunked_ ? "Transfer-Encoding: chunked\r\n" : "");
  if (!head.body.empty()) on_.out_ += chunked_ ? print_chunk(head.body) : head.body;
  try {
    co_await answer_lines();
  } catch (...) {
    on_.sent_ = port_.service.summary(head_, count_).sent;  // for the log
    throw;
  }
  Response last = port_.service.summary(head_, count_);
  on_.out_ += chunked_ ? print_chunk(last.body) + std::string(kLastChunk) : last.body;
  held_.resize(0);
  Printed rest{.bytes = std::exchange(on_.out_, {}), .sent = std::move(last.sent)};
  co_await on_.send(std::move(rest));  // gcc 12 destroys a temporary here twice
}

/// Returns the next line that is not blank; empty at the end. Returns nothing if the bytes that may
/// be scanned at a time contain no such line, because blank lines cost time too.
std::optional<std::string_view> Batch::next_line() {
  const auto all = std::string_view(lines_);
  const auto near = all.substr(0, std::min(all.size(), at_ + kScanAtOnce));
  const auto begin = near.find_first_not_of(" \t\r\n", at_);
  if (begin == near.npos) {
    at_ = near.size();
    return at_ == all.size() ? std::optional(std::string_view()) : std::nullopt;
  }
  const auto end = std::min(all.find('\n', begin), all.size());
  at_ = std::min(end + 1, all.size());
  const auto line = all.substr(begin, end - begin);
  return line.substr(0, line.find_last_not_of('\r') + 1);
}

Task<void> Batch::count_lines() {
  for (std::size_t scanned = 0;;) {
    const auto before = at_;
    const auto line = next_line();
    if (line && line->empty()) break;
    count_.items += line ? 1 : 0;
    scanned += at_ - before;
    if (scanned < kScanAtOnce) continue;
    scanned = 0;
    co_await on_.yield();
  }
  at_ = 0;
}

Task<void> Batch::answer_lines() {
  co_await count_lines();
  on_.gone_by_ = Clock::time_point::max();
  for (auto next_check = Clock::now() + kBatchPeerCheck;;) {
    stopped_ = stopped_ || port_.draining;
    take_finished();
    refuse_late();
    break_silence();
    send();
    begin_lines();
    if (stopped_ && on_.jobs_.empty()) co_return;
    co_await on_.pause(std::min(due(), next_check));
    if (Clock::now() < next_check) continue;
    on_.check_peer();
    next_check = Clock::now() + kBatchPeerCheck;
  }
}

void Batch::take_finished() {
  const auto ended = std::ranges::count_if(on_.jobs_, &Job::finished);
  if (const auto now = Clock::now(); ended > 0) {
    const double one =
        (seconds(now) - seconds(std::exchange(ended_, now))) / static_cast<double>(ended);
    pace_s_ = pace_s_ == 0.0 ? one : 0.8 * pace_s_ + 0.2 * one;
  }
  std::erase_if(on_.jobs_, [this](const auto& job) {
    if (job->finished && job->answer.bytes.empty()) throw Session::Gone{};
    if (job->finished) answer_line(job->answer.bytes, job->refused);
    if (job->finished && job->malformed) ++malformed_;
    return job->finished;
  });
}

/// One more than there are slots, so that no slot waits.
std::size_t Batch::worked_on() const { return static_cast<std::size_t>(port_.slots.count()) + 1; }

/// Returns the number of additional lines to start, if they are so short that slots would wait for
/// the port.
std::size_t Batch::ahead() const {
  return pace_s_ > 0.0 ? static_cast<std::size_t>(std::min(1.0 * kAhead, kWakeDelayS / pace_s_))
                       : 0;
}

/// As many as are worked on at a time, so that other requests wait for no more than these.
void Batch::begin_lines() {
  again_ = Clock::time_point::max();
  const auto most = worked_on() + ahead();
  while (!stopped_ && on_.jobs_.size() < most && on_.out_.size() < kHeld) {
    const auto before = at_;
    const auto line = next_line();
    if (!line) {
      on_.wake();
      break;
    }
    if (line->empty()) {
      stopped_ = true;
    } else if (!begin_line(*line)) {
      at_ = before;
      again_ = Clock::now() + kAskAgain;
      break;
    }
  }
  forget_begun();
}

std::shared_ptr<Job> Batch::job_of(std::string_view line) const {
  auto job = std::make_shared<Job>();
  job->request = head_;
  job->request.body = line;
  job->request.line = line_ + 1;
  job->request.logged = malformed_ < kLogged;
  job->request.stop = job->stop.get_token();
  job->request.times.read = job->request.times.received = seconds(Clock::now());
  job->owner = on_.weak_from_this();
  on_.claim(*job);
  return job;
}

/// False when the line has to wait: for memory, for a full queue, or for the rate of the batch's
/// key.
bool Batch::begin_line(std::string_view line) {
  const auto& service = port_.service;
  const auto room = port_.memory.most() - port_.lines.most();
  const auto wanted = service.line_memory ? service.line_memory(line) : line.size();
  const bool fits = port_.memory.most() == 0 || wanted <= room;
  const auto memory = fits ? wanted : 0;
  const bool has = has_memory_in_time(memory);
  if (!has && !over_wait()) return false;
  if (!paid_ && service.admit && service.admit(head_)) return false;
  paid_ = true;
  const auto job = job_of(line);
  if (!fits) {
    refuse_line(job->request,
                {ErrorCode::body_too_large, "The line exceeds this replica's free memory."});
  } else if (!has) {
    refuse_line(job->request, {ErrorCode::overloaded, "The memory for jobs is in use."});
  } else {
    job->memory = MemoryShare(port_.memory, memory);
  }
  begin_time(*job, on_.jobs_.size() >= worked_on());
  if (!port_.offer(job)) return false;
  if (!has) ++port_.counters.memory;
  waits_since_.reset();
  ++line_;
  paid_ = false;
  on_.jobs_.push_back(job);
  return true;
}

/// Returns whether the memory for the next line is free. Evicts slow takers only when the wait
/// begins and when it ends, because a scan of all connections each time would block the port.
bool Batch::has_memory_in_time(std::size_t bytes) {
  if (port_.memory.has(bytes)) return true;
  const bool first = !waits_since_;
  if (first) waits_since_ = Clock::now();
  return (first || over_wait()) && port_.make_memory(bytes);
}

/// Whether the next line has waited for memory as long as a job may take.
bool Batch::over_wait() const {
  const auto most = port_.service.budget ? port_.service.budget(head_).cpu : 0ms;
  return most > 0ms && Clock::now() - *waits_since_ >= most;
}

/// Lines already begun need not be kept.
void Batch::forget_begun() {
  if (2 * at_ < lines_.size()) return;
  lines_.erase(0, std::exchange(at_, 0));
  lines_.shrink_to_fit();
  held_.resize(lines_.size());
}

/// A line begun ahead waits for those before it, however long they take: its time begins with its
/// place among those that are worked on.
void Batch::begin_time(Job& job, bool ahead) {
  job.ahead = ahead;
  if (!port_.slots.waits(job)) return port_.hold_to_budget(job);
  port_.set_budget(job);
  if (job.budget.cpu > 0ms)
    job.due = Clock::now() + job.budget.cpu;  // the batch is answered anyway
}

/// Refuses lines that have waited too long for a slot, and limits running ones to their budget. A
/// line that lost its place in the queue may queue again until then.
void Batch::refuse_late() {
  const auto running = on_.jobs_;
  std::size_t place = 0;
  for (const auto& job : running) {
    const bool ahead = place++ >= worked_on();
    const bool late = job->due <= Clock::now();
    if (job->ahead && (late || !ahead)) {
      begin_time(*job, ahead);
    } else if (job->displaced && !late) {
      job->displaced = !port_.offer(job);
    } else if (late) {
      refuse(job);
    }
  }
}

/// Unless it runs.
void Batch::refuse(const std::shared_ptr<Job>& job) {
  if (!job->displaced && !port_.slots.withdraw(job)) return port_.hold_to_budget(*job);
  ++(job->displaced ? port_.counters.queue : port_.counters.wait);
  job->memory = {};
  refuse_line(job->request, {ErrorCode::overloaded, "No slot was free within the job's budget."});
  std::erase(on_.jobs_, job);
  answer_line(port_.service.line(job->request).text, true);
}

void Batch::answer_line(std::string_view text, bool refused) {
  ++(refused ? count_.refused : count_.answered);
  if (chunked_) {
    on_.out_ += print_chunk(text);
  } else {
    on_.out_ += text;
  }
  count_.bytes_out += text.size();
  spoke_ = Clock::now();
}

void Batch::break_silence() {
  if (Clock::now() < spoke_ + kSilence) return;
  on_.out_ += chunked_ ? print_chunk("\n") : "\n";
  ++count_.bytes_out;
  spoke_ = Clock::now();
}

/// The client must take the pending output within the time for an answer; the limit is not per
/// byte.
void Batch::send() {
  const auto size = on_.out_.size();
  if (!on_.send_some()) {
    on_.out_.erase(0, std::exchange(on_.out_at_, 0));
    on_.count_sending();
    on_.wait_writable();
  }
  const auto left = on_.out_.size();
  owed_ -= std::min(owed_, size - left);
  if (owed_ > 0 && Clock::now() >= stalled_) {
    ++port_.counters.over_time;
    throw Session::Gone{};
  }
  if (owed_ > 0) return;
  owed_ = left;
  stalled_ = left == 0 ? Clock::time_point::max() : Clock::now() + port_.options.write;
}

Clock::time_point Batch::due() const {
  auto when = std::min({stalled_, again_, on_.gone_by_, spoke_ + kSilence});
  for (const auto& job : on_.jobs_) when = std::min(when, job->due);
  return when;
}

}  // namespace tubecut::server
