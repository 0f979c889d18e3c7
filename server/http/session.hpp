#pragma once

#include <list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/loop.hpp"
#include "server/http/port.hpp"

namespace tubecut::server {

/// One connection: its life is one coroutine, and a batch on it another (see batch.hpp). The public
/// functions are all that others may do to it; they change its state, and the coroutine sees the
/// change when it resumes.
class Session final : public Strand {
 public:
  enum class State {
    idle,      // between requests
    head,      // a request's head is on its way
    body,      // its body
    working,   // a job waits for a slot or runs, or a batch's lines do
    writing,   // the answer is on its way
    lingering  // sends no more answers; lets the client read the last one
  };
  /// The connection is closed: thrown at the coroutine's current point.
  struct Gone {};
  using InPort = std::list<std::shared_ptr<Session>>::iterator;

  Session(Port& port, Socket socket, std::string peer, ConnectionPermit permit);
  ~Session() override;

  /// Begins its life; `full`: with the refusal that too many connections are open.
  void start(InPort at, bool full);
  [[nodiscard]] InPort at() const { return at_; }

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] const std::string& peer() const { return peer_; }
  /// The first byte of the request on its way.
  [[nodiscard]] Clock::time_point received() const { return received_; }
  /// Deadline for the client's current action.
  [[nodiscard]] Clock::time_point due() const;
  /// Bytes of requests not yet handed on; 0 if these were already evicted.
  [[nodiscard]] std::size_t holds_arriving() const { return arriving_.bytes(); }
  [[nodiscard]] std::size_t holds() const { return arriving_.bytes() + sending_.bytes(); }
  /// Whether its client has been taking an answer since before that.
  [[nodiscard]] bool takes_since(Clock::time_point late) const;
  [[nodiscard]] bool is_cut() const { return cut_; }

  /// Drops the received part of its next request, which is refused.
  void give_way();
  /// Ends the connection at once.
  void cut();
  /// The port will drain: the answers being made are the connection's last.
  void close_after_answer();
  /// The port is draining.
  void end_soon();
  /// Stops its jobs.
  void cancel();

 private:
  friend class Batch;
  enum class Got { bytes, end, late, nothing, no_room };  // nothing: no bytes, and no wait for any

  Task<void> live();
  Task<bool> read_request();
  Task<bool> read_head();
  void screen();
  Task<void> read_body();
  Task<void> answer_request();
  Task<void> await_job(std::shared_ptr<Job> job);
  Task<void> send(Printed answer);
  Task<void> linger();

  Task<Got> advance();
  [[nodiscard]] Chain::Pause yield_to_others();
  bool digest_rest();
  std::size_t digest(std::string_view bytes);
  std::optional<Got> receive();
  void drop_rest();
  void count_arriving();
  void refuse_rest(Got got);
  void refuse(Refusal refusal);
  [[nodiscard]] std::shared_ptr<Job> take_job();
  [[nodiscard]] std::optional<Refusal> offer(const std::shared_ptr<Job>& job);
  [[nodiscard]] std::optional<Refusal> know_client(const Request& request);
  void claim(Job& job) const;
  void check_peer();
  bool send_some();
  void count_sending();
  void say(std::string_view bytes);
  void report(bool whole) noexcept;
  void wait_readable();
  void wait_writable();
  void set_due(std::chrono::milliseconds from_now) { due_ = Clock::now() + from_now; }
  void on_end() override;

  Port& port_;
  Socket socket_;
  std::string peer_;         // numeric address
  std::string client_;       // the client of the last request
  ConnectionPermit permit_;  // among its address's connections
  ConnectionPermit key_;     // permit among its key's connections; empty without keys
  InPort at_;
  State state_ = State::idle;
  bool ends_ = false;  // with the answer being made or sent
  bool cut_ = false;
  bool gives_way_ = false;
  bool awaits_reading_ = false;  // an event is pending
  bool awaits_writing_ = false;
  int reads_ = 0;  // since it yielded to others
  int requests_ = 0;
  RequestReader reader_;
  std::optional<Refusal> refusal_;
  std::string in_;  // received, not yet taken by the reader
  std::size_t in_at_ = 0;
  bool starved_ = false;  // the reader wants more than there is
  std::string out_;
  std::string rest_;        // follows it
  std::string_view fixed_;  // or this does
  std::size_t out_at_ = 0;
  std::function<void(bool)> sent_;
  MemoryShare arriving_;
  MemoryShare sending_;
  std::vector<std::shared_ptr<Job>> jobs_;  // waiting, running, or not yet seen to be done
  Clock::time_point received_;
  Clock::time_point due_ = Clock::time_point::max();
  Clock::time_point begun_;                               // writing
  Clock::time_point gone_by_ = Clock::time_point::max();  // half-closed: taken for gone
};

}  // namespace tubecut::server
