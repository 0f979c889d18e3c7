#include "server/http/session.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>

#include "server/http/batch.hpp"

namespace tubecut::server {
namespace {

using namespace std::chrono_literals;
namespace asio = boost::asio;

constexpr int kReadsBeforeYield = 8;        // then other connections go on
constexpr int kRequestsBeforeYield = 32;    // refused at once, by rate or for want of room
constexpr auto kNextWhileDraining = 500ms;  // a request may be on its way on an idle connection
/// A client that still sends reads no answer: its bytes are dropped until it pauses, or is done.
constexpr auto kLingerTime = 1s;  // of silence
constexpr std::size_t kLingerBytes = 64u << 20;
/// If a client has closed only its sending side, it still reads a quick answer; during this time it
/// looks the same as a client that hung up.
constexpr auto kHangUpGrace = 250ms;
constexpr auto kCheckPeer = 20ms;  // whether the client is still there, while its job is worked on

constexpr std::string_view kFull = "All slots and the queue are full.";

/// Refuses a job that waited for a slot and gets no slot.
void refuse_waiting(Job& job, PortCounters& counters) {
  ++(job.displaced ? counters.queue : counters.wait);
  job.request.refusal = {
      ErrorCode::overloaded,
      job.displaced ? std::string(kFull) : "No slot was free within half of the job's budget."};
}

}  // namespace

Session::Session(Port& port, Socket socket, std::string peer, ConnectionPermit permit)
    : Strand(port.loop),
      port_(port),
      socket_(std::move(socket)),
      peer_(std::move(peer)),
      permit_(std::move(permit)),
      reader_(port.limits),
      arriving_(port.arriving),
      sending_(port.memory) {
  boost::system::error_code gone;
  socket_.non_blocking(true, gone);
  socket_.set_option(Tcp::no_delay(true), gone);
}

Session::~Session() { drop(); }

void Session::start(InPort at, bool full) {
  at_ = at;
  if (full) {
    ++port_.counters.full;
    refuse({ErrorCode::overloaded, "Too many connections are open."});
  }
  begin(live());
}

/// Head, screen, body; job and answer; again.
Task<void> Session::live() {
  try {
    while (co_await read_request()) {
      co_await answer_request();
      if (ends_) {  // as the answer says, whatever the port does since it was made
        co_await linger();
        break;
      }
      if (++requests_ == kRequestsBeforeYield) co_await yield_to_others();
    }
  } catch (const Gone&) {
  } catch (const std::exception&) {  // out of memory: this connection ends, the others go on
  }
}

/// Lets the others go on.
Chain::Pause Session::yield_to_others() {
  reads_ = requests_ = 0;
  return yield();
}

/// Reads the next request, or the reason to refuse it. Returns false if no request comes.
Task<bool> Session::read_request() {
  if (refusal_) co_return true;  // before it came
  reader_ = RequestReader(port_.limits);
  const bool comes = co_await read_head();
  if (!comes) co_return false;
  if (!refusal_ && reader_.state() == RequestReader::State::body) screen();
  if (!refusal_ && reader_.state() == RequestReader::State::body) co_await read_body();
  if (!refusal_ && reader_.state() == RequestReader::State::faulty) {
    refuse(reader_.fault());
  }
  co_return true;
}

Task<bool> Session::read_head() {
  state_ = State::idle;
  set_due(port_.draining ? kNextWhileDraining : port_.options.idle);
  while (reader_.state() == RequestReader::State::head && !refusal_) {
    const Got got = co_await advance();
    if (got == Got::bytes) continue;
    const bool empty_lines = got == Got::late && arriving_.bytes() == 0;
    if (got != Got::no_room && (state_ == State::idle || empty_lines)) co_return false;
    refuse_rest(got);
  }
  co_return true;
}

/// Whether the body is worth reading.
void Session::screen() {
  Request& head = reader_.request();
  head.peer = peer_;
  if (auto refusal = port_.service.screen(head)) return refuse(*std::move(refusal));
  if (auto refusal = know_client(head)) return refuse(*std::move(refusal));  // before its body
  const auto limit = port_.service.max_body(head.target);
  const auto room = port_.room_for_body(head);
  const auto length = reader_.content_length();
  if (length > limit) {
    refuse({ErrorCode::body_too_large, fmt::format("The body is larger than {} bytes.", limit)});
  } else if (length > room) {
    refuse({ErrorCode::body_too_large,
            fmt::format("The body exceeds this replica's free memory of {} bytes.", room)});
  } else {
    reader_.allow_body(room);
  }
}

Task<void> Session::read_body() {
  state_ = State::body;
  set_due(port_.options.body);
  if (reader_.expects_continue() && in_at_ == in_.size()) say("HTTP/1.1 100 Continue\r\n\r\n");
  while (reader_.state() == RequestReader::State::body && !refusal_) {
    const Got got = co_await advance();
    if (got != Got::bytes) refuse_rest(got);
  }
}

/// Gives the reader the available bytes, or waits for more.
Task<Session::Got> Session::advance() {
  for (;;) {
    if (digest_rest()) co_return Got::bytes;
    port_.bound_arrivals();
    if (gives_way_) co_return Got::no_room;
    if (++reads_ > kReadsBeforeYield) co_await yield_to_others();
    if (const auto got = receive()) co_return *got;
    if (Clock::now() >= due()) co_return Got::late;
    wait_readable();
    co_await pause(due());
    reads_ = requests_ = 0;
  }
}

/// Gives the reader the remaining bytes. Returns false if it needs more.
bool Session::digest_rest() {
  if (in_.empty() || starved_) return false;
  in_at_ += digest(std::string_view(in_).substr(in_at_));
  if (in_at_ == in_.size()) drop_rest();
  count_arriving();
  return !starved_;
}

std::size_t Session::digest(std::string_view bytes) {
  if (state_ == State::idle) {
    state_ = State::head;
    received_ = Clock::now();
    set_due(port_.options.head);
  }
  const auto taken = reader_.take(bytes);
  const bool wants = reader_.state() == RequestReader::State::head ||
                     reader_.state() == RequestReader::State::body;
  starved_ = taken == 0 && wants;
  return taken;
}

/// Takes the bytes that the socket has; nothing if it has no bytes now.
std::optional<Session::Got> Session::receive() {
  boost::system::error_code error;
  const auto n = socket_.read_some(asio::buffer(port_.scratch), error);
  if (error == asio::error::would_block || error == asio::error::interrupted) return std::nullopt;
  if (error == asio::error::eof) return Got::end;
  if (error) throw Gone{};
  const std::string_view bytes(port_.scratch.data(), n);
  if (in_.empty()) {
    const auto taken = digest(bytes);
    in_.assign(bytes.substr(taken));
  } else {
    in_.erase(0, std::exchange(in_at_, 0)).append(bytes);
    starved_ = false;
    in_at_ = digest(in_);
    if (in_at_ == in_.size()) drop_rest();
  }
  count_arriving();
  return Got::bytes;
}

void Session::drop_rest() {
  give_back(in_);
  in_at_ = 0;
  starved_ = false;
}

/// Reserves memory for the received bytes of the next requests.
void Session::count_arriving() {
  const bool reading = state_ == State::head || state_ == State::body;
  arriving_.resize((reading && !gives_way_ ? reader_.held() : 0) + in_.size() - in_at_);
}

void Session::give_way() {
  gives_way_ = state_ == State::head || state_ == State::body;
  drop_rest();
  if (gives_way_) {
    give_back(reader_.request().body);
  } else {  // bytes behind the current request are not read
    ends_ = true;
    for (const auto& job : jobs_) job->close = true;
  }
  arriving_.resize(0);
  wake();
}

/// Of a request that did not come whole.
void Session::refuse_rest(Got got) {
  if (got == Got::late) ++port_.counters.over_time;
  switch (got) {
    case Got::late:
      return refuse({ErrorCode::bad_request, "The request came too slowly."});
    case Got::no_room:
      return refuse({ErrorCode::overloaded, "The memory for requests is in use."});
    default:
      return refuse({ErrorCode::bad_request, "The request ended early."});
  }
}

/// The rest of the request will not be read: the connection ends with the answer.
void Session::refuse(Refusal refusal) {
  refusal_ = std::move(refusal);
  ends_ = true;
  drop_rest();
}

std::shared_ptr<Job> Session::take_job() {
  auto job = std::make_shared<Job>();
  ends_ = ends_ || port_.stopping || !reader_.keeps_alive();
  Request& request = job->request;
  request = std::move(reader_.request());
  request.refusal = std::exchange(refusal_, std::nullopt);
  if (request.refusal) give_back(request.body);
  request.peer = peer_;
  request.stop = job->stop.get_token();
  request.times = {.received = seconds(received_), .read = seconds(Clock::now())};
  request.reports_sending = true;
  job->close = ends_;
  job->owner = weak_from_this();
  state_ = State::working;
  gives_way_ = false;
  count_arriving();
  port_.bound_arrivals();
  return job;
}

Task<void> Session::answer_request() {
  const auto job = take_job();
  const bool batch = port_.service.is_batch && port_.service.is_batch(job->request);
  if (!job->request.refusal) job->request.refusal = know_client(job->request);
  job->close = ends_;
  if (!job->request.refusal && !batch) {
    claim(*job);
    job->request.refusal = offer(job);
  }
  if (!job->request.refusal && !batch) co_await await_job(job);
  if (job->begins || (batch && !job->request.refusal)) {
    Batch lines(*this, job);
    co_await lines.live();
    co_return;
  }
  if (job->request.refusal) job->answer = port_.answer(job->request, job->close);
  // Of its memory the answer keeps its own: it was counted, whether or not its client is slow.
  if (job->memory.bytes() > 0) sending_ = std::exchange(job->memory, {});
  if (job->answer.bytes.empty()) throw Gone{};
  co_await send(std::move(job->answer));
}

/// Reserves the job's memory and queues it. Returns a refusal if that fails.
std::optional<Refusal> Session::offer(const std::shared_ptr<Job>& job) {
  const Request& request = job->request;
  port_.set_budget(*job);
  const auto memory = port_.memory_of(request);
  if (!port_.make_memory(memory)) {
    ++port_.counters.memory;
    return Refusal{ErrorCode::overloaded, "The memory for jobs is in use."};
  }
  if (port_.service.admit) {
    if (auto refusal = port_.service.admit(request)) return refusal;
  }
  job->memory = MemoryShare(port_.memory, memory);
  if (port_.offer(job)) return std::nullopt;
  ++port_.counters.queue;
  return Refusal{ErrorCode::overloaded, std::string(kFull)};
}

/// Whose the request is, and that it has not too many connections.
std::optional<Refusal> Session::know_client(const Request& request) {
  client_ = port_.service.client ? port_.service.client(request) : peer_;
  if (client_ == peer_ || key_.is_of(client_)) return std::nullopt;
  if (!port_.quota.full(client_)) {
    key_ = ConnectionPermit(port_.quota, client_);
    return std::nullopt;
  }
  ++port_.counters.full;
  ends_ = true;
  return Refusal{ErrorCode::overloaded, "Too many connections of this client are open."};
}

void Session::claim(Job& job) const {
  job.claim.client = client_;
  job.claim.flow = this;
  job.is_short = port_.service.is_short && port_.service.is_short(job.request);
}

/// Waits for the job's slot, and its end; or refuses it.
Task<void> Session::await_job(std::shared_ptr<Job> job) {
  jobs_.push_back(job);
  gone_by_ = Clock::time_point::max();
  bool waits = true;
  while (!job->finished) {
    const auto until = std::min(std::min(job->due, gone_by_), Clock::now() + kCheckPeer);
    co_await pause(until);
    if (job->finished) break;
    check_peer();
    if (Clock::now() < job->due && !job->displaced) continue;
    if (waits && (job->displaced || port_.slots.withdraw(job))) {
      refuse_waiting(*job, port_.counters);
      break;
    }
    waits = false;
    port_.hold_to_budget(*job);
  }
  std::erase(jobs_, job);
}

/// Ends the connection if the client is gone.
void Session::check_peer() {
  pollfd who{.fd = socket_.native_handle(), .events = POLLRDHUP, .revents = 0};
  ::poll(&who, 1, 0);
  const bool half = (who.revents & POLLRDHUP) != 0;
  if (half && gone_by_ == Clock::time_point::max()) gone_by_ = Clock::now() + kHangUpGrace;
  const bool broken = cut_ || (who.revents & (POLLERR | POLLHUP)) != 0;
  if (!broken && Clock::now() < gone_by_) return;
  ++port_.counters.hung_up;
  throw Gone{};
}

Task<void> Session::send(Printed answer) {
  out_ = std::move(answer.bytes);
  rest_ = std::move(answer.rest);
  fixed_ = answer.fixed;
  sent_ = std::move(answer.sent);
  count_sending();
  state_ = State::writing;
  begun_ = Clock::now();
  set_due(port_.options.write);
  port_.keep_memory_free();
  while (!send_some()) {
    if (Clock::now() >= due()) {
      ++port_.counters.over_time;
      throw Gone{};
    }
    wait_writable();
    co_await pause(due());
  }
  report(true);
}

/// Sends as much as the socket takes. Returns true when all is sent.
bool Session::send_some() {
  const std::string_view front = out_, tail = rest_.empty() ? fixed_ : std::string_view(rest_);
  const auto all = front.size() + tail.size();
  boost::system::error_code error;
  while (out_at_ < all && !error) {
    const auto first = std::min(out_at_, front.size()), then = out_at_ - first;
    const std::array left{asio::buffer(front.substr(first)), asio::buffer(tail.substr(then))};
    out_at_ += socket_.write_some(left, error);
    if (error == asio::error::interrupted) error = {};
  }
  if (error && error != asio::error::would_block) throw Gone{};
  if (out_at_ < all) return false;
  give_back(out_);
  give_back(rest_);
  fixed_ = {};
  out_at_ = 0;
  count_sending();
  return true;
}

/// Reserves memory for the bytes still to be sent.
void Session::count_sending() { sending_.resize(out_.size() + rest_.size()); }

/// A few bytes that fit any socket's buffer.
void Session::say(std::string_view bytes) {
  boost::system::error_code error;
  socket_.write_some(asio::buffer(bytes), error);
}

/// Reports the outcome of the answer once. If memory is short for the log line, the line is lost.
void Session::report(bool whole) noexcept {
  try {
    if (const auto tell = std::exchange(sent_, nullptr)) tell(whole);
  } catch (const std::exception&) {
  }
}

/// A socket closed with bytes unread resets the connection, and the answer may be lost with it.
Task<void> Session::linger() {
  state_ = State::lingering;
  drop_rest();
  count_arriving();
  boost::system::error_code error;
  socket_.shutdown(Socket::shutdown_send, error);
  const auto ends_by = Clock::now() + port_.options.body;
  set_due(kLingerTime);
  std::size_t dropped = 0;
  while (dropped <= kLingerBytes) {
    if (++reads_ > kReadsBeforeYield) co_await yield_to_others();
    const auto n = socket_.read_some(asio::buffer(port_.scratch), error);
    dropped += n;
    if (!error) {
      due_ = std::min(ends_by, Clock::now() + kLingerTime);
    } else if (error != asio::error::would_block || Clock::now() >= due()) {
      co_return;
    } else {
      wait_readable();
      co_await pause(due());
    }
  }
}

bool Session::takes_since(Clock::time_point late) const {
  return state_ == State::writing && begun_ < late && !cut_;
}

Clock::time_point Session::due() const {
  return port_.draining && state_ != State::working ? std::min(due_, port_.drained_by) : due_;
}

void Session::close_after_answer() {
  for (const auto& job : jobs_) job->close = true;
}

void Session::end_soon() {
  close_after_answer();
  if (state_ == State::idle) due_ = std::min(due_, Clock::now() + kNextWhileDraining);
  wake();
}

void Session::cancel() {
  for (const auto& job : jobs_) job->stop.request_stop();
  wake();
}

void Session::cut() {
  cut_ = true;
  boost::system::error_code error;
  socket_.close(error);
  drop_rest();
  give_back(out_);
  give_back(rest_);
  arriving_.resize(0);
  sending_.resize(0);
  wake();
}

/// Nobody waits for its jobs any more.
void Session::on_end() {
  cut();
  permit_ = {};
  key_ = {};
  report(false);
  for (const auto& job : std::exchange(jobs_, {})) {
    if (!job || job->finished) continue;
    job->owner.reset();
    job->stop.request_stop();
    static_cast<void>(port_.slots.withdraw(job));
  }
  port_.forget(*this);
}

void Session::wait_readable() {
  if (std::exchange(awaits_reading_, true)) return;
  socket_.async_wait(Socket::wait_read, [this, self = shared_from_this()](const auto&) {
    awaits_reading_ = false;
    wake();
  });
}

void Session::wait_writable() {
  if (std::exchange(awaits_writing_, true)) return;
  socket_.async_wait(Socket::wait_write, [this, self = shared_from_this()](const auto&) {
    awaits_writing_ = false;
    wake();
  });
}

}  // namespace tubecut::server
