#pragma once

#include <cstddef>
#include <deque>
#include <list>
#include <memory>
#include <string>

namespace tubecut::server {

struct Job;

/// The values that determine a job's place in the queue.
struct Claim {
  std::string client = {};     // client: a key's owner, or an address
  const void* flow = nullptr;  // of the client's: the connection it came by
};

/// Jobs of one class that wait for a thread. Serves clients one after another, and so the flows of
/// a client: a client with much work waits only for its own.
class FairQueue {
 public:
  void push(const std::shared_ptr<Job>& job);

  /// Returns the next job to run; nothing if the queue is empty.
  [[nodiscard]] std::shared_ptr<Job> pop();

  /// Takes a waiting job back; false when it does not wait.
  [[nodiscard]] bool remove(const std::shared_ptr<Job>& job);

  /// Removes and returns the last job of the client with the most waiting jobs, in favour of a
  /// client with fewer; nothing if that would only swap the two.
  [[nodiscard]] std::shared_ptr<Job> give_way(const std::string& newcomer);

  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  struct Flow {
    const void* name;
    std::deque<std::shared_ptr<Job>> jobs = {};
  };
  struct Client {
    std::string name;
    std::list<Flow> flows = {};  // the first is served next
    std::size_t count = 0;
  };

  [[nodiscard]] std::list<Client>::iterator find(const std::string& client);
  void forget_if_idle(std::list<Client>::iterator client, std::list<Flow>::iterator flow);

  std::list<Client> clients_;  // the first is served next
  std::size_t size_ = 0;
};

}  // namespace tubecut::server
