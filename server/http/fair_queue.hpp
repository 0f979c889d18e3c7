#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace tubecut::server {

struct Job;

/// What a job's place in the queue goes by.
struct Claim {
  std::string client = {};     // whose it is: a key's owner, or an address
  const void* flow = nullptr;  // of the client's: the connection it came by
  double expected_s = 0.0;     // in a slot
  bool quick = false;          // may take the lane that long jobs cannot fill
  bool trial = false;     // but it is not known to be: its client's first of a kind, or anyone's
  std::size_t order = 0;  // in which it came; the queue's
  double since = 0.0;     // when it began to wait, in seconds
};

/// Jobs that wait for a slot. Clients take turns by the time their jobs have had, and so do the
/// flows of a client: whoever asks for much waits for it, and for nobody else's. One that comes
/// back from having nothing here begins where the others are (start-time fair queueing, Goyal et
/// al. 1996).
class FairQueue {
 public:
  void push(const std::shared_ptr<Job>& job);

  /// The next to run; nothing when none waits.
  [[nodiscard]] std::shared_ptr<Job> pop();

  /// What the next to run claims; nullptr when none waits.
  [[nodiscard]] const Claim* next() const;

  /// The next of the quick that have waited since then; `trials`: or of those believed to be.
  [[nodiscard]] std::shared_ptr<Job> pop_quick(double since, bool trials = true);

  /// `took` seconds were had by a job popped, and no more will be.
  void done(const Claim& claim, double took);

  /// The client's jobs of that kind are not quick after all.
  void slow(std::string_view kind, const std::string& client);

  /// Takes a waiting job back; false when it does not wait.
  [[nodiscard]] bool remove(const std::shared_ptr<Job>& job);

  /// The last job of the client with most waiting, taken out for one of a client with fewer;
  /// nothing when that would only turn them round.
  [[nodiscard]] std::shared_ptr<Job> give_way(const Claim& newcomer);

  [[nodiscard]] std::size_t size() const { return size_; }

  /// Expected seconds of the work that goes before such a job; `quick_only`: of the quick jobs.
  [[nodiscard]] double before(const Claim& claim, bool quick_only) const;

 private:
  struct Share {
    double used = 0.0;  // seconds, from where it began
    double waiting = 0.0;
    std::size_t running = 0;
  };
  struct Flow : Share {
    std::deque<std::shared_ptr<Job>> jobs;
  };
  struct Client : Share {
    std::map<const void*, Flow> flows;
    double floor = 0.0;
    std::size_t count = 0;
  };

  template <class May>
  [[nodiscard]] std::shared_ptr<Job> pop_where(May may);
  template <class Clients, class May>
  [[nodiscard]] static auto turn_of(Clients& clients, May may);
  [[nodiscard]] static std::size_t came(const Flow& flow);
  [[nodiscard]] static std::size_t came(const Client& client);
  void take_out(Client& client, Flow& flow, const Job& job);
  void forget_idle(const std::string& client, const void* flow);

  std::map<std::string, Client> clients_;
  double floor_ = 0.0;  // what one that comes now has used
  std::size_t size_ = 0;
  std::size_t came_ = 0;
};

}  // namespace tubecut::server
