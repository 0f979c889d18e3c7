#include "server/event_loop.hpp"

#include <fmt/format.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <functional>
#include <limits>
#include <system_error>

namespace tubecut::server {
namespace {

using namespace std::chrono_literals;
using State = Connection::State;

constexpr std::size_t kReadBytes = 65536;
constexpr int kReadsPerTurn = 8;      // then another connection's turn
constexpr int kRequestsPerTurn = 32;  // refused at once, by rate or for want of room
constexpr int kEventsPerTurn = 256;
constexpr auto kFirstByteWhileDraining = 500ms;
constexpr auto kTaken = 1s;  // most answers are by then: the others give way when memory is short
/// A client that still sends reads no answer: its bytes are dropped until it pauses, or is done.
constexpr auto kLingerTime = 1s;  // of silence
constexpr std::size_t kLingerBytes = 64u << 20;
/// A client that has closed its side only half still reads a quick answer; one that hung up cannot
/// be told apart until this has passed.
constexpr auto kHangUpGrace = 250ms;
/// A job waits for a slot no longer than this part of its budget: one begun with little time left
/// would be cut off, and its slot wasted.
constexpr int kWaitShare = 2;
constexpr double kLikely = 0.5;   // of that wait, as the mean time of the last jobs foretells
constexpr double kForget = 0.05;  // weight of the last job in that mean
/// Memory of a job by its body: 16 to 31 bytes per byte were measured on bodies of short numbers,
/// empty arrays, empty strings and short keys; the echo of an answer comes on top.
constexpr std::size_t kJobBytesPerByte = 48;
/// Memory of a running job whatever its body: 17 MiB were measured for 20 000 points.
constexpr std::size_t kSlotBytes = 24u << 20;
constexpr std::size_t kLeastMemory = 16u << 20;

/// What is left of the bound for bodies and answers once every slot has its part; 0: no bound.
std::size_t shared_memory(const TransportOptions& options) {
  if (options.memory == 0) return 0;
  const auto slots = kSlotBytes * static_cast<std::size_t>(options.slots);
  return std::max(kLeastMemory, options.memory - std::min(options.memory, slots));
}

double seconds(Clock::time_point time) {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

}  // namespace

std::size_t memory_of(std::size_t body) { return kJobBytesPerByte * body; }

std::size_t room_for_job_body(const TransportOptions& options) {
  if (options.memory == 0) return std::numeric_limits<std::size_t>::max();
  return shared_memory(options) / kJobBytesPerByte;
}

EventLoop::EventLoop(const TransportOptions& options, const Service& service, Print print)
    : options_(options),
      memory_(shared_memory(options)),
      limits_{.head_bytes = options.max_head_bytes, .fields = options.max_fields},
      service_(service),
      print_(std::move(print)),
      epoll_(epoll_create1(EPOLL_CLOEXEC)),
      wake_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      scratch_(kReadBytes, '\0'),
      slots_(std::make_unique<Slots>(
          options.slots, options.queue, [this](const std::shared_ptr<Job>& job) { work(*job); },
          [this](std::shared_ptr<Job> job) {
            {
              const std::lock_guard lock(mutex_);
              finished_.push_back(std::move(job));
            }
            wake();
          })) {
  epoll_event event{.events = EPOLLIN, .data = {.ptr = nullptr}};
  if (epoll_ < 0 || wake_ < 0 || epoll_ctl(epoll_, EPOLL_CTL_ADD, wake_, &event) != 0) {
    throw std::system_error(errno, std::generic_category(), "epoll");
  }
}

/// In a slot's thread.
void EventLoop::work(Job& job) const {
  job.request.times.started = seconds(Clock::now());
  if (job.request.line > 0) {
    BatchReply reply = service_.line(job.request);
    job.answer = std::move(reply.text);
    job.refused = reply.refused;
  } else {
    Printed printed = print_(job.request, job.close);
    job.answer = std::move(printed.bytes);
    job.sent = std::move(printed.sent);
  }
}

EventLoop::~EventLoop() {
  slots_.reset();  // before what its threads wake
  ::close(wake_);
  ::close(epoll_);
}

void EventLoop::wake() const {
  const std::uint64_t one = 1;
  static_cast<void>(!::write(wake_, &one, sizeof one));
}

void EventLoop::adopt(int descriptor) {
  {
    const std::lock_guard lock(mutex_);
    adopted_.push_back(descriptor);
  }
  wake();
}

void EventLoop::drain(std::chrono::milliseconds patience) {
  {
    const std::lock_guard lock(mutex_);
    drain_asked_ = true;
    patience_ = patience;
  }
  wake();
}

void EventLoop::end() {
  {
    const std::lock_guard lock(mutex_);
    end_asked_ = true;
  }
  wake();
}

void EventLoop::cancel_jobs() {
  {
    const std::lock_guard lock(mutex_);
    cancel_asked_ = true;
  }
  wake();
}

TransportStats EventLoop::stats() const {
  const Counters& x = counters_;
  return {.connections = x.connections,
          .waiting = slots_->waiting(),
          .busy = static_cast<std::uint64_t>(slots_->busy()),
          .slots = static_cast<std::uint64_t>(slots_->count()),
          .memory = x.memory,
          .memory_bound = options_.memory,
          .refused_queue = x.queue,
          .refused_wait = x.wait,
          .refused_memory = x.bytes,
          .refused_connections = x.full,
          .hung_up = x.hung_up,
          .over_time = x.over_time};
}

int EventLoop::wait_ms() const {
  if (!again_.empty()) return 0;
  if (soonest_ == Clock::time_point::max()) return -1;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(soonest_ - Clock::now());
  return static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 60'000));
}

void EventLoop::run() {
  std::array<epoll_event, kEventsPerTurn> events{};
  while (!ending_ || !connections_.empty()) {
    const int n = epoll_wait(epoll_, events.data(), kEventsPerTurn, wait_ms());
    bool messages = false;
    for (int i = 0; i < n; ++i) {
      const auto& event = events[static_cast<std::size_t>(i)];
      auto* const c = static_cast<Connection*>(event.data.ptr);
      if (c == nullptr) {
        messages = true;
      } else if (connections_.contains(c)) {
        on_event(*c, event.events);
      }
    }
    for (auto* const c : std::exchange(again_, {})) {
      if (!connections_.contains(c)) continue;
      c->queued_again = false;
      pump(*c);
    }
    if (messages) take_messages();
    if (Clock::now() >= soonest_) expire_all();
    buried_.clear();
  }
  slots_->join();  // jobs whose clients are gone still have a line to log
  take_messages();
}

void EventLoop::take_messages() {
  std::uint64_t count = 0;
  static_cast<void>(!::read(wake_, &count, sizeof count));
  std::unique_lock lock(mutex_);
  const auto adopted = std::exchange(adopted_, {});
  const auto finished = std::exchange(finished_, {});
  const bool drains = std::exchange(drain_asked_, false);
  ending_ = ending_ || end_asked_;
  const bool cancels = std::exchange(cancel_asked_, false);
  lock.unlock();
  for (const auto& job : finished) finish(*job);
  for (const int descriptor : adopted) accept(descriptor);
  if (drains) begin_drain();
  if (!cancels) return;
  for (auto& [c, owned] : connections_) {
    if (c->job) c->job->stop.request_stop();
    if (!c->batch) continue;
    c->batch->stopped = true;
    for (const auto& job : c->batch->running) job->stop.request_stop();
  }
}

/// The connection idle for longest makes room for a new one.
bool EventLoop::make_room() {
  Connection* longest = nullptr;
  for (auto& [c, owned] : connections_) {
    if (c->state != State::idle && c->state != State::lingering) continue;
    if (longest == nullptr || c->deadline < longest->deadline) longest = c;
  }
  if (longest != nullptr) close(*longest);
  return longest != nullptr;
}

void EventLoop::accept(int descriptor) {
  const bool full =
      connections_.size() >= static_cast<std::size_t>(options_.connections) && !make_room();
  auto owned = std::make_unique<Connection>(descriptor, limits_);
  Connection& c = *owned;
  connections_.emplace(&c, std::move(owned));
  counters_.connections = connections_.size();
  epoll_event event{.events = EPOLLIN | EPOLLOUT | EPOLLRDHUP | EPOLLET, .data = {.ptr = &c}};
  if (epoll_ctl(epoll_, EPOLL_CTL_ADD, descriptor, &event) != 0) return close(c);
  if (full) {
    ++counters_.full;
    return refuse_unread(c, {ErrorCode::overloaded, "Too many connections are open."});
  }
  set_deadline(c, draining_ ? kFirstByteWhileDraining : options_.idle);
  pump(c);
}

void EventLoop::on_event(Connection& c, unsigned events) {
  if ((events & (EPOLLHUP | EPOLLERR)) != 0) {
    if (c.state == State::working || c.state == State::batching) ++counters_.hung_up;
    return close(c);
  }
  if ((events & EPOLLIN) != 0) c.readable = true;
  if ((events & EPOLLRDHUP) != 0 && !c.half_closed) {
    c.half_closed = c.readable = true;
    if (c.state == State::working || c.state == State::batching) {
      c.gone_by = Clock::now() + kHangUpGrace;
      set_deadline(c, c.deadline);
    }
  }
  if (c.state == State::batching && (events & EPOLLOUT) != 0) feed(c);
  if (!connections_.contains(&c)) return;
  if (c.state == State::writing && (events & EPOLLOUT) != 0) send(c);
  if (connections_.contains(&c)) pump(c);
}

/// Reads until there is a job, or nothing more to read, or others have waited long enough.
void EventLoop::pump(Connection& c) {
  for (int n = 0; connections_.contains(&c); ++n) {
    if (c.reading() && !c.in.empty()) {
      c.in.erase(0, digest(c, c.in));
      if (c.in.empty()) c.in = {};
      if (!connections_.contains(&c)) return;
      account(c);
      if (c.has_more) return look_again(c);
    }
    if ((!c.reading() && c.state != State::lingering) || !c.readable) return;
    if (n == kReadsPerTurn) return look_again(c);
    const auto got = c.receive(scratch_.data(), scratch_.size());
    if (got == -1) c.readable = false;
    if (got == 0) return on_end(c);
    if (got == -2) return close(c);
    if (got < 0) return;
    const std::string_view bytes(scratch_.data(), static_cast<std::size_t>(got));
    if (c.state == State::lingering) {
      c.lingered += bytes.size();
      if (c.lingered > kLingerBytes) return close(c);
      set_deadline(c, std::min(c.ends_by, Clock::now() + kLingerTime));
    } else if (c.in.empty()) {
      const auto taken = digest(c, bytes);
      if (connections_.contains(&c) && !c.unread) c.in.assign(bytes.substr(taken));
    } else {
      c.in.append(bytes);
    }
    if (!connections_.contains(&c)) return;
    account(c);
    if (c.has_more) return look_again(c);
  }
}

/// In the next turn, after the others'.
void EventLoop::look_again(Connection& c) {
  c.has_more = false;
  if (!std::exchange(c.queued_again, true)) again_.push_back(&c);
}

/// Sets memory aside for what has come of the connection's next requests.
void EventLoop::account(Connection& c) {
  const auto held = (c.reading() ? c.reader.held() : 0) + c.in.size();
  counters_.memory += held - c.held;  // modulo 2^64: less is right too
  arriving_ += held - c.held;
  c.held = held;
}

/// Of requests on their way, the one that holds most makes room for the others.
void EventLoop::bound_arrivals() {
  while (memory_ > 0 && arriving_ > memory_ / kWaiting) {
    Connection* most = nullptr;
    for (const auto& [c, owned] : connections_) {
      if (c->held > 0 && (most == nullptr || c->held > most->held)) most = c;
    }
    if (most == nullptr) return;
    ++counters_.bytes;
    if (most->reading()) {
      refuse_unread(*most, {ErrorCode::overloaded, "The memory for requests is in use."});
    } else {
      drop_pipelined(*most);
    }
  }
}

/// What came behind the request being answered is not read: the connection ends with the answer.
void EventLoop::drop_pipelined(Connection& c) {
  c.closing = c.unread = true;
  if (c.job) c.job->close = true;
  c.in = {};
  account(c);
}

bool EventLoop::has_memory(std::size_t bytes) const {
  return memory_ == 0 || counters_.memory + bytes <= memory_;
}

/// Whether so many bytes more are there, if need be without the clients slowest to take their
/// answers: those that hold most go first, and none in vain.
bool EventLoop::make_memory(std::size_t bytes) {
  if (has_memory(bytes)) return true;
  const auto size = [](const Connection* c) { return c->held + c->out.size(); };
  const auto late = Clock::now() - kTaken;
  std::vector<Connection*> slow;
  std::size_t theirs = 0;
  for (const auto& [c, owned] : connections_) {
    if (c->state != State::writing || c->begun >= late) continue;
    slow.push_back(c);
    theirs += size(c);
  }
  if (counters_.memory + bytes - theirs > memory_) return false;
  std::ranges::sort(slow, std::greater{}, size);
  for (auto* const c : slow) {
    if (has_memory(bytes)) break;
    ++counters_.over_time;
    close(*c);
  }
  return has_memory(bytes);
}

/// Takes requests off the front of `bytes` until one becomes a job or is not whole, or the turn is
/// over. Returns how much was taken.
std::size_t EventLoop::digest(Connection& c, std::string_view bytes) {
  std::size_t taken = 0;
  int whole = 0;
  while (c.reading() && taken < bytes.size()) {
    if (c.state == State::idle) {
      c.state = State::head;
      c.received = Clock::now();
      set_deadline(c, options_.head);
    }
    const auto n = c.reader.take(bytes.substr(taken));
    taken += n;
    account(c);
    switch (c.reader.state()) {
      case RequestReader::State::head:
        break;
      case RequestReader::State::body:
        if (c.state == State::head) {
          on_head(c, taken < bytes.size());
        } else if (n == 0) {
          return taken;
        }
        break;
      case RequestReader::State::whole:
        on_whole(c);
        c.has_more = ++whole == kRequestsPerTurn && taken < bytes.size();
        break;
      case RequestReader::State::faulty:
        refuse_unread(c, c.reader.fault());
        break;
    }
    bound_arrivals();
    if (!connections_.contains(&c) || c.has_more) return taken;
  }
  return taken;
}

/// The largest body of such a request that the memory has room for. A batch's lines are jobs by
/// themselves.
std::size_t EventLoop::room_for_body(const Request& head) const {
  const auto limit = service_.max_body(head.target);
  if (memory_ == 0) return limit;
  const bool batch = service_.is_batch && service_.is_batch(head);
  return std::min(
      limit, batch ? memory_ / kWaiting - options_.max_head_bytes : room_for_job_body(options_));
}

std::optional<Refusal> EventLoop::head_refusal(Connection& c) const {
  const Request& head = c.reader.request();
  if (auto refusal = service_.screen(head)) return refusal;
  const auto limit = service_.max_body(head.target);
  const auto length = c.reader.content_length();
  if (length > limit) {
    return Refusal{ErrorCode::body_too_large,
                   fmt::format("The body is larger than {} bytes.", limit)};
  }
  if (const auto room = room_for_body(head); length > room) {
    return Refusal{ErrorCode::body_too_large,
                   fmt::format("This replica's memory has room for {} bytes of body.", room)};
  }
  return std::nullopt;
}

void EventLoop::on_head(Connection& c, bool more_there) {
  c.reader.request().peer = c.peer;
  if (auto refusal = head_refusal(c)) return refuse_unread(c, *std::move(refusal));
  c.reader.allow_body(room_for_body(c.reader.request()));
  c.state = State::body;
  set_deadline(c, options_.body);
  if (c.reader.expects_continue() && !more_there) c.send_now("HTTP/1.1 100 Continue\r\n\r\n");
}

/// Whether a slot is likely free before the job's wait is over: a refusal now serves the client
/// better than one after the wait.
bool EventLoop::in_time(const Job& job) const {
  if (job.end == Clock::time_point::max()) return true;
  const double wait = static_cast<double>(slots_->waiting()) * mean_s_ / slots_->count();
  return wait <= kLikely * (seconds(job.end) - job.request.times.read) / kWaitShare;
}

/// Sets the job's memory aside and queues it; or tells why not.
std::optional<Refusal> EventLoop::offer(Connection& c, const std::shared_ptr<Job>& job) {
  const auto memory = memory_of(job->request.body.size());
  if (!make_memory(memory)) {
    ++counters_.bytes;
    return Refusal{ErrorCode::overloaded, "The memory for jobs is in use."};
  }
  if (!in_time(*job)) {
    ++counters_.wait;
    return Refusal{ErrorCode::overloaded, "No slot will be free within half of the job's budget."};
  }
  if (service_.admit) {
    if (auto refusal = service_.admit(job->request)) return refusal;
  }
  c.state = State::working;
  c.job = job;
  job->memory = memory;
  counters_.memory += memory;
  if (slots_->offer(job)) return std::nullopt;
  ++counters_.queue;
  c.job = nullptr;
  release(*job);
  return Refusal{ErrorCode::overloaded, "All slots and the queue are full."};
}

void EventLoop::on_whole(Connection& c) {
  c.closing = c.closing || draining_ || !c.reader.keeps_alive();
  auto job = std::make_shared<Job>();
  job->request = std::move(c.reader.request());
  account(c);
  Request& request = job->request;
  request.peer = c.peer;
  request.stop = job->stop.get_token();
  request.times = {.received = seconds(c.received), .read = seconds(Clock::now())};
  request.reports_sending = true;
  job->close = c.closing;
  job->owner = &c;
  if (c.half_closed) c.gone_by = Clock::now() + kHangUpGrace;
  if (service_.is_batch && service_.is_batch(request)) return begin_batch(c, job);
  if (const auto budget = service_.budget ? service_.budget(request) : 0ms; budget > 0ms) {
    job->end = Clock::now() + budget;
    set_deadline(c, budget / kWaitShare);
  } else {
    set_deadline(c, Clock::time_point::max());
  }
  if (auto refusal = offer(c, job)) {
    job->request.refusal = std::move(refusal);
    write(c, print_(job->request, job->close));
  }
}

void EventLoop::on_end(Connection& c) {
  c.readable = false;
  c.half_closed = true;
  if (c.state != State::head && c.state != State::body) return close(c);
  refuse_unread(c, {ErrorCode::bad_request, "The request ended early."});
}

/// Answers what could be read of the request with a refusal.
void EventLoop::refuse(Connection& c, Refusal refusal) {
  Request request = std::move(c.reader.request());
  request.body = {};
  account(c);
  request.peer = c.peer;
  request.refusal = std::move(refusal);
  request.reports_sending = true;
  request.times = {.received = seconds(c.received), .read = seconds(Clock::now())};
  write(c, print_(request, std::atomic<bool>(c.closing)));
}

/// The rest of the request will not be read: the connection ends.
void EventLoop::refuse_unread(Connection& c, Refusal refusal) {
  c.closing = c.unread = true;
  c.in = {};
  refuse(c, std::move(refusal));
  account(c);
}

void EventLoop::release(Job& job) { counters_.memory -= std::exchange(job.memory, 0); }

void EventLoop::finish(Job& job) {
  release(job);
  mean_s_ += kForget * (seconds(Clock::now()) - job.request.times.started - mean_s_);
  auto* const c = static_cast<Connection*>(job.owner);
  if (c == nullptr) {
    if (job.sent) job.sent(false);
    return;
  }
  if (job.request.line > 0) {
    finish_line(*c, job);
  } else {
    c->job = nullptr;
    write(*c, {std::move(job.answer), std::move(job.sent)});
  }
  if (connections_.contains(c)) pump(*c);
}

void EventLoop::write(Connection& c, Printed answer) {
  c.out = std::move(answer.bytes);
  c.out_at = 0;
  c.sent = std::move(answer.sent);
  counters_.memory += c.out.size();
  begin_writing(c);
  static_cast<void>(make_memory(0));  // those who take nothing give way to this one
  if (c.state == State::writing && c.out.capacity() > c.out.size() + kReadBytes) {
    c.out.shrink_to_fit();  // it will wait, and the library has reserved up to twice its size
  }
}

/// What is in `out` is the rest of the answer.
void EventLoop::begin_writing(Connection& c) {
  c.state = State::writing;
  c.begun = Clock::now();
  c.gone_by = Clock::time_point::max();
  set_deadline(c, options_.write);
  send(c);
}

void EventLoop::send(Connection& c) {
  const auto size = c.out.size();
  const auto done = c.send();
  if (!done) return close(c);
  if (!*done) return;
  counters_.memory -= size;
  c.report(true);
  if (c.closing || draining_) return linger(c);
  c.restart(limits_);
  set_deadline(c, options_.idle);
}

/// A socket closed with bytes unread resets the connection, and the answer may be lost with it.
void EventLoop::linger(Connection& c) {
  c.finish_sending();
  c.state = State::lingering;
  c.readable = true;
  c.in = {};
  account(c);
  c.ends_by = Clock::now() + options_.body;
  set_deadline(c, kLingerTime);
}

void EventLoop::close(Connection& c) {
  const auto at = connections_.find(&c);
  if (at == connections_.end()) return;
  if (c.job) {
    c.job->owner = nullptr;
    c.job->stop.request_stop();
    if (slots_->withdraw(c.job)) release(*c.job);
    c.job = nullptr;
  }
  if (c.batch) c.sent = service_.summary(c.batch->head, c.batch->count).sent;  // for the log
  drop_batch(c);
  counters_.memory -= c.held + c.out.size();
  arriving_ -= std::exchange(c.held, 0);
  buried_.push_back(std::move(at->second));
  connections_.erase(at);
  counters_.connections = connections_.size();
}

void EventLoop::set_deadline(Connection& c, Clock::time_point when) {
  when = std::min(when, c.gone_by);
  c.deadline = draining_ && c.state != State::working && c.state != State::batching
                   ? std::min(when, drained_by_)
                   : when;
  soonest_ = std::min(soonest_, c.deadline);
}

void EventLoop::expire_all() {
  const auto now = Clock::now();
  std::vector<Connection*> due;
  for (auto& [c, owned] : connections_) {
    if (c->deadline <= now) due.push_back(c);
  }
  for (auto* const c : due) {
    if (connections_.contains(c)) expire(*c);
  }
  soonest_ = Clock::time_point::max();
  for (auto& [c, owned] : connections_) soonest_ = std::min(soonest_, c->deadline);
}

void EventLoop::expire(Connection& c) {
  switch (c.state) {
    case State::idle:
    case State::lingering:
      return close(c);
    case State::writing:
      ++counters_.over_time;
      return close(c);
    case State::head:
    case State::body:
      if (c.held == 0) return close(c);  // empty lines only: no request
      ++counters_.over_time;
      return refuse_unread(c, {ErrorCode::bad_request, "The request came too slowly."});
    case State::batching:
      expire_batch(c);
      if (connections_.contains(&c)) pump(c);
      return;
    case State::working:
      break;
  }
  if (c.gone_by <= Clock::now()) {
    ++counters_.hung_up;
    return close(c);
  }
  if (!slots_->withdraw(c.job)) {
    if (Clock::now() < c.job->end) return set_deadline(c, c.job->end);
    c.job->stop.request_stop();
    return set_deadline(c, Clock::time_point::max());
  }
  ++counters_.wait;
  release(*c.job);
  const auto job = std::exchange(c.job, nullptr);
  job->request.refusal = {ErrorCode::overloaded,
                          "No slot was free within half of the job's budget."};
  write(c, print_(job->request, job->close));
  if (connections_.contains(&c)) pump(c);
}

void EventLoop::begin_drain() {
  draining_ = true;
  drained_by_ = Clock::now() + patience_;
  std::vector<Connection*> all;
  for (auto& [c, owned] : connections_) all.push_back(c);
  for (auto* const c : all) {
    if (!connections_.contains(c)) continue;
    if (c->job) c->job->close = true;
    c->closing = true;
    // A fresh connection was accepted as work: its request may still be on the wire.
    if (c->state == State::idle && !c->fresh && c->in.empty()) {
      c->readable = true;  // a request may have come since it was looked at
      pump(*c);
      if (connections_.contains(c) && c->state == State::idle) close(*c);
    } else if (c->state == State::idle) {
      set_deadline(*c, kFirstByteWhileDraining);
    } else if (c->batch) {
      c->batch->stopped = true;
      feed(*c);
      if (connections_.contains(c)) pump(*c);
    } else if (c->state != State::working) {
      set_deadline(*c, c->deadline);
    }
  }
}

}  // namespace tubecut::server
