#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace tubecut::server {

struct Job;

/// The values that determine a job's place in the queue.
struct Claim {
  std::string client = {};     // client: a key's owner, or an address
  const void* flow = nullptr;  // of the client's: the connection it came by
  double expected_s = 0.0;     // in a slot
  bool quick = false;          // may take the lane that long jobs cannot fill
  bool trial = false;     // but it is not known to be: its client's first of a kind, or anyone's
  std::size_t order = 0;  // in which it came; the queue's
  double since = 0.0;     // when it began to wait, in seconds
};

/// Jobs that wait for a slot. Clients take turns by the time that their jobs have used, and so do
/// the flows of a client: a client with much work waits only for its own. If a client returns after
/// having no jobs here, it begins at the level of the others (start-time fair queueing, Goyal et
/// al. 1996).
class FairQueue {
 public:
  void push(const std::shared_ptr<Job>& job);

  /// Returns the next job to run; nothing if the queue is empty.
  [[nodiscard]] std::shared_ptr<Job> pop();

  /// Returns the claim of the next job to run; nullptr if the queue is empty.
  [[nodiscard]] const Claim* next() const;

  /// Returns the next quick job that has waited since then; with `trials` also a job that is only
  /// expected to be quick.
  [[nodiscard]] std::shared_ptr<Job> pop_quick(double since, bool trials = true);

  /// Call when a popped job ends. `took` is its run time in seconds.
  void done(const Claim& claim, double took);

  /// The client's jobs of that kind are not quick after all.
  void slow(std::string_view kind, const std::string& client);

  /// Takes a waiting job back; false when it does not wait.
  [[nodiscard]] bool remove(const std::shared_ptr<Job>& job);

  /// Removes and returns the last job of the client with the most waiting jobs, in favour of a
  /// client with fewer; nothing if that would only swap the two.
  [[nodiscard]] std::shared_ptr<Job> give_way(const Claim& newcomer);

  [[nodiscard]] std::size_t size() const { return size_; }

  /// Expected seconds of the work that goes before such a job; `quick_only`: of the quick jobs.
  [[nodiscard]] double before(const Claim& claim, bool quick_only) const;

 private:
  struct Share {
    double used = 0.0;  // seconds, from its start level
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
  double floor_ = 0.0;  // start level of a client that comes now
  std::size_t size_ = 0;
  std::size_t came_ = 0;
};

}  // namespace tubecut::server
