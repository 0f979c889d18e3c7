#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/session.hpp"

namespace tubecut::server {

/// A batch on a connection: its lines become jobs like others, a few at a time, and are answered in
/// chunks as they finish. The lines come from a request's body or from a job's output.
class Batch {
 public:
  Batch(Session& session, std::shared_ptr<Job> whole);

  /// From its head to its summary.
  Task<void> live();

 private:
  [[nodiscard]] std::optional<Refusal> refusal();
  Task<void> follow();
  [[nodiscard]] std::optional<Refusal> memory_refusal(std::size_t bytes);
  Task<void> stream(Response head, std::string lines);
  Task<void> count_lines();
  [[nodiscard]] std::optional<std::string_view> next_line();
  Task<void> answer_lines();
  void take_finished();
  void begin_lines();
  [[nodiscard]] std::size_t worked_on() const;
  [[nodiscard]] std::size_t ahead() const;
  [[nodiscard]] bool begin_line(std::string_view line);
  [[nodiscard]] std::shared_ptr<Job> job_of(std::string_view line) const;
  [[nodiscard]] bool has_memory_in_time(std::size_t bytes);
  [[nodiscard]] bool over_wait() const;
  void forget_begun();
  void refuse_late();
  void begin_time(Job& job, bool ahead);
  void refuse(const std::shared_ptr<Job>& job);
  void answer_line(std::string_view text, bool refused);
  /// Sends a blank line if nothing was sent for long.
  void break_silence();
  void send();
  [[nodiscard]] Clock::time_point due() const;

  Session& on_;
  Port& port_;
  std::shared_ptr<Job> whole_;
  Request head_;               // the head common to every line's request
  std::string lines_;          // the body
  MemoryShare held_;           // for it
  std::size_t at_ = 0;         // of the next line
  std::size_t line_ = 0;       // lines begun
  std::size_t malformed_ = 0;  // lines that were not jobs
  bool stopped_ = false;       // no further line begins
  bool chunked_ = true;        // the answer; else the connection's end ends it (HTTP/1.0)
  BatchCount count_;
  double pace_s_ = 0.0;                     // from one line's end to the next's; 0: not known yet
  Clock::time_point ended_ = Clock::now();  // when a line last did
  bool paid_ = true;      // its key's rate has let the next line in; the first came with the batch
  std::size_t owed_ = 0;  // bytes the client has to take until `stalled_`
  std::optional<Clock::time_point> waits_since_;          // for memory
  Clock::time_point stalled_ = Clock::time_point::max();  // when a client too slow is cut off
  Clock::time_point spoke_ = Clock::now();                // when the last line was sent
  Clock::time_point again_ = Clock::time_point::max();    // when a full queue is asked again
};

}  // namespace tubecut::server
