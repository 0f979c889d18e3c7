#include "server/http/port.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

#include "core/base/stop.hpp"
#include "server/http/session.hpp"

namespace tubecut::server {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kReadBytes = 65536;
/// Arriving requests hold at most one such fraction of the memory, and lines of batches another, so
/// that jobs find memory whatever clients begin.
constexpr std::size_t kWaiting = 2;
constexpr auto kHeadTaken = 100ms;  // one that takes longer makes room for others
constexpr auto kTaken = 1s;  // most answers are by then: the others give way when memory is short
/// A job waits for a slot no longer than this part of its budget.
constexpr int kWaitShare = 2;
/// Minimum time between two checks of a job's CPU, because a job without CPU may stay just below
/// its budget for long.
constexpr std::chrono::nanoseconds kLeastCheck = 500us;
/// Fraction of the remaining budget after which a job is checked again, because its memory may grow
/// and freeing it takes time too.
constexpr double kCheckShare = 0.6;
/// Part of the memory that is kept free of answers which slow clients have not taken.
constexpr std::size_t kKeptFree = 4;
/// Memory of each thread for its job, in addition to the memory reserved for the job: everyday jobs
/// need no more.
constexpr std::size_t kThreadBytes = 8u << 20;
constexpr std::size_t kLeastMemory = 16u << 20;

/// Returns the bound for bodies and answers after each thread has its part; 0: no bound.
std::size_t shared_memory(const TransportOptions& options) {
  if (options.memory == 0) return 0;
  const auto threads = kThreadBytes * Slots::threads(options.slots);
  return std::max(kLeastMemory, options.memory - std::min(options.memory, threads));
}

/// Numeric.
std::string address_of(const Socket& socket) {
  boost::system::error_code error;
  const auto end = socket.remote_endpoint(error);
  return error ? std::string() : end.address().to_string(error);
}

/// Its client is gone.
void report(const Job& job) noexcept {
  try {
    if (job.answer.sent) job.answer.sent(false);
  } catch (const std::exception&) {  // a log line that memory is short for
  }
}

}  // namespace

double seconds(Clock::time_point time) {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

std::size_t memory_for_jobs(const TransportOptions& options) {
  return options.memory == 0 ? std::numeric_limits<std::size_t>::max() : shared_memory(options);
}

Port::Port(const TransportOptions& of, Service service_of)
    : options(of),
      service(std::move(service_of)),
      limits{.head_bytes = of.max_head_bytes, .fields = of.max_fields},
      memory(shared_memory(of)),
      arriving(memory.most() / kWaiting, &memory),
      lines(memory.most() / kWaiting, &memory),
      quota(static_cast<std::size_t>(of.per_client > 0 ? of.per_client
                                                       : std::max(1, of.connections / 2))),
      scratch(kReadBytes, '\0'),
      slots(
          of.slots, of.queue, [this](const std::shared_ptr<Job>& job) { work(*job); },
          [this](std::shared_ptr<Job> job) { hand_over(std::move(job)); }) {}

Port::~Port() { slots.join(); }

Response Port::respond(const Request& request) const {
  try {
    return service.handle(request);
  } catch (const std::exception&) {
    return {.status = 500,
            .content_type = "text/plain; charset=utf-8",
            .body = "The service failed.\n"};
  }
}

Printed Port::answer(const Request& request, const std::atomic<bool>& close) const {
  return printed(respond(request), request, close);
}

Printed Port::printed(Response response, const Request& request,
                      const std::atomic<bool>& close) const {
  const auto idle = std::chrono::ceil<std::chrono::seconds>(options.idle);
  return print(std::move(response), request.method, close ? 0s : idle);
}

/// Grants more memory to a running job, only from the free memory.
JobMemory::Grant Port::grow(Job& job, std::size_t bytes) const {
  const std::lock_guard lock(job.growing);
  if (job.memory.grow(bytes)) return JobMemory::Grant::given;
  const bool fits = job.memory.bytes() + bytes <= memory.most();
  return fits ? JobMemory::Grant::in_use : JobMemory::Grant::never;
}

/// Runs in the job's thread, whose memory takes over the helpers' memory, because their results
/// belong to the job.
void Port::run_parallel(Job& job, std::size_t count, const ParallelTask& task) {
  JobMemory::Taken all;
  const auto within = [&](const Helpers::Stint& stint) {
    const StopScope scope(job.stop.get_token());
    const HelpersCpu::Share counted(job.helped);
    const JobMemory own(0, [&](std::size_t bytes) { return grow(job, bytes); });
    stint();
    const auto taken = own.taken();
    const auto unused = taken.given - std::min(taken.given, taken.live);
    const std::lock_guard lock(job.growing);
    job.memory.resize(job.memory.bytes() - unused);
    all.given += taken.given - unused;
    all.live += taken.live;
  };
  try {
    slots.run_parallel(count, task, within);
  } catch (...) {
    JobMemory::take_over(all);
    throw;
  }
  JobMemory::take_over(all);
}

/// In a slot's thread.
void Port::work(Job& job) {
  job.request.times.started = seconds(Clock::now());
  job.request.used_cpu = [&job] { return used(job); };
  job.request.parallel_for = [this, &job](std::size_t count, const ParallelTask& task) {
    run_parallel(job, count, task);
  };
  const auto body = std::min(job.request.body.size(), job.memory.bytes());
  const auto given = kThreadBytes + job.memory.bytes() - body;
  {
    const JobMemory taken(given, [&](std::size_t bytes) { return grow(job, bytes); });
    answer(job);
  }
  give_back(job.request.body);  // a client that is slow to take its answer holds only the answer
  job.request.parallel_for = run_in_order;  // the remaining threads no longer work for this job
  job.request.used_cpu = nullptr;
}

void Port::answer(Job& job) const {
  try {
    if (job.request.line > 0) {
      BatchReply reply = service.line(job.request);
      job.answer.bytes = std::move(reply.text);
      job.refused = reply.refused;
      job.malformed = reply.malformed;
    } else if (auto response = respond(job.request); response.lines.empty()) {
      job.answer = printed(std::move(response), job.request, job.close);
    } else {
      job.begins = std::move(response);
    }
  } catch (const std::exception&) {  // no memory for the bytes: no answer, and its connection ends
    give_back(job.answer.bytes);
  }
}

/// In a slot's thread.
void Port::hand_over(std::shared_ptr<Job> job) {
  bool first = false;
  {
    const std::lock_guard lock(mutex_);
    first = !finished_;
    job->next = std::move(finished_);
    finished_ = std::move(job);
  }
  if (first) loop.interrupt();
}

void Port::tell(std::function<void()> what) {
  {
    const std::lock_guard lock(mutex_);
    told_.push_back(std::move(what));
  }
  loop.interrupt();
}

void Port::run() {
  loop.run([this] { return ending_ && sessions_.empty(); }, [this] { take_messages(); });
  slots.join();  // jobs whose clients are gone still write a log line
  take_messages();
}

void Port::take_messages() {
  std::unique_lock lock(mutex_);
  auto job = std::exchange(finished_, nullptr);
  const auto told = std::exchange(told_, {});
  lock.unlock();
  while (job) {
    const auto done = std::exchange(job, job->next);
    done->next = nullptr;
    done->finished = true;
    if (const auto owner = done->owner.lock()) {
      owner->wake();
    } else {
      report(*done);
    }
  }
  for (const auto& what : told) what();
}

bool Port::offer(const std::shared_ptr<Job>& job) {
  const auto [taken, displaced] = slots.offer(job);
  if (displaced) {
    displaced->displaced = true;
    if (const auto owner = displaced->owner.lock()) owner->wake();
  }
  return taken;
}

void Port::set_budget(Job& job) const {
  if (service.budget) job.budget = service.budget(job.request);
  const auto now = Clock::now();
  if (job.budget.wall > 0ms) job.end = now + job.budget.wall;
  if (job.budget.cpu > 0ms) job.due = now + job.budget.cpu / kWaitShare;
}

/// A thread cannot use more CPU than elapsed time, so no check is needed until `due`.
void Port::hold_to_budget(Job& job) const {
  const auto now = Clock::now();
  const auto left = job.budget.cpu - slots.cpu(job);
  const bool used = job.budget.cpu > 0ms && left <= 0ns;
  if (used || now >= job.end) {
    job.stop.request_stop();
    job.due = Clock::time_point::max();
  } else {
    const auto until_check = std::chrono::ceil<std::chrono::nanoseconds>(
        kCheckShare * left / (1 + job.helped.threads()));
    job.due = std::min(job.end, job.budget.cpu > 0ms ? now + std::max(until_check, kLeastCheck)
                                                     : Clock::time_point::max());
  }
}

/// If an address has its maximum of connections, it must close one of its own.
void Port::open(Socket socket) {
  const auto peer = address_of(socket);
  const bool shared = service.is_shared && service.is_shared(peer);
  bool full = false;
  if (!shared && quota.full(peer)) full = !make_room(peer);
  if (!full && sessions_.size() >= static_cast<std::size_t>(options.connections)) {
    full = !make_room("");
  }
  auto permit = shared ? ConnectionPermit() : ConnectionPermit(quota, peer);
  auto session = std::make_shared<Session>(*this, std::move(socket), peer, std::move(permit));
  sessions_.push_back(session);
  counters.connections = sessions_.size();
  try {
    session->start(std::prev(sessions_.end()), full);
  } catch (...) {
    forget(*session);
    throw;
  }
}

void Port::forget(Session& session) {
  sessions_.erase(session.at());
  counters.connections = sessions_.size();
}

/// The connection idle for longest makes room for a new one, else the one that has been longest at
/// a request's head. Of that address, when one is named.
bool Port::make_room(const std::string& of_peer) {
  using State = Session::State;
  const auto late = Clock::now() - kHeadTaken;
  std::shared_ptr<Session> longest;
  const auto rank = [](const Session& one) {
    return std::pair(one.state() == State::head, one.due());
  };
  for (const auto& session : sessions_) {
    if (session->is_cut() || (!of_peer.empty() && session->peer() != of_peer)) continue;
    const bool idle = session->state() == State::idle || session->state() == State::lingering;
    if (!idle && !(session->state() == State::head && session->received() < late)) continue;
    if (!longest || rank(*session) < rank(*longest)) longest = session;
  }
  if (longest) longest->cut();
  return longest != nullptr;
}

std::size_t Port::room_for_body(const Request& head) const {
  const auto limit = service.max_body(head.target);
  if (memory.most() == 0) return limit;
  const bool batch = service.is_batch && service.is_batch(head);
  if (batch) return std::min(limit, lines.most() - options.max_head_bytes);
  return std::min(limit, service.room ? service.room(head.target) : memory.most());
}

std::size_t Port::memory_of(const Request& request) const {
  return service.memory ? service.memory(request) : request.body.size();
}

void Port::bound_arrivals() {
  while (!arriving.has(0)) {
    const auto most = std::ranges::max_element(
        sessions_, {}, [](const auto& session) { return session->holds_arriving(); });
    if (most == sessions_.end() || (*most)->holds_arriving() == 0) return;
    ++counters.memory;
    (*most)->give_way();
  }
}

/// Closes the largest holders first, and only if that frees enough.
bool Port::make_memory(std::size_t bytes) {
  if (memory.has(bytes)) return true;
  const auto late = Clock::now() - kTaken;
  std::vector<Session*> slow;
  std::size_t theirs = 0;
  for (const auto& session : sessions_) {
    if (!session->takes_since(late)) continue;
    slow.push_back(session.get());
    theirs += session->holds();
  }
  if (memory.used() + bytes - theirs > memory.most()) return false;
  std::ranges::sort(slow, std::greater{}, &Session::holds);
  for (auto* const session : slow) {
    if (memory.has(bytes)) break;
    ++counters.over_time;
    session->cut();
  }
  return memory.has(bytes);
}

void Port::keep_memory_free() { static_cast<void>(make_memory(memory.most() / kKeptFree)); }

void Port::close_connections() {
  stopping = true;
  for (const auto& session : sessions_) session->close_after_answer();
}

void Port::drain(std::chrono::milliseconds patience) {
  stopping = true;
  draining = true;
  drain_began = Clock::now();
  drained_by = drain_began + patience;
  for (const auto& session : sessions_) session->end_soon();
}

void Port::cancel_jobs() {
  for (const auto& session : sessions_) session->cancel();
}

TransportStats Port::stats() const {
  const PortCounters& x = counters;
  return {.connections = x.connections,
          .waiting = slots.waiting(),
          .busy = static_cast<std::uint64_t>(slots.busy()),
          .slots = static_cast<std::uint64_t>(slots.count()),
          .memory = memory.used(),
          .memory_bound = options.memory,
          .refused_queue = x.queue,
          .refused_wait = x.wait,
          .refused_memory = x.memory,
          .refused_connections = x.full,
          .hung_up = x.hung_up,
          .over_time = x.over_time};
}

}  // namespace tubecut::server
