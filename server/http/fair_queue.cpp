#include "server/http/fair_queue.hpp"

#include <algorithm>
#include <utility>

#include "server/jobs/slots.hpp"

namespace tubecut::server {

std::list<FairQueue::Client>::iterator FairQueue::find(const std::string& client) {
  return std::ranges::find(clients_, client, &Client::name);
}

/// If memory is short, nothing has changed, because a client without flows or a flow without jobs
/// would be served and have nothing to run.
void FairQueue::push(const std::shared_ptr<Job>& job) {
  const Claim& claim = job->claim;
  if (const auto client = find(claim.client); client == clients_.end()) {
    clients_.push_back(
        {.name = claim.client, .flows = {{.name = claim.flow, .jobs = {job}}}, .count = 1});
  } else {
    const auto flow = std::ranges::find(client->flows, claim.flow, &Flow::name);
    if (flow == client->flows.end()) {
      client->flows.push_back({.name = claim.flow, .jobs = {job}});
    } else {
      flow->jobs.push_back(job);
    }
    ++client->count;
  }
  ++size_;
}

std::shared_ptr<Job> FairQueue::pop() {
  if (clients_.empty()) return nullptr;
  const auto client = clients_.begin();
  const auto flow = client->flows.begin();
  auto job = std::move(flow->jobs.front());
  flow->jobs.pop_front();
  clients_.splice(clients_.end(), clients_, client);
  client->flows.splice(client->flows.end(), client->flows, flow);
  forget_if_idle(client, flow);
  return job;
}

/// One job of the flow was taken out.
void FairQueue::forget_if_idle(std::list<Client>::iterator client, std::list<Flow>::iterator flow) {
  --size_;
  --client->count;
  if (flow->jobs.empty()) client->flows.erase(flow);
  if (client->flows.empty()) clients_.erase(client);
}

bool FairQueue::remove(const std::shared_ptr<Job>& job) {
  const auto client = find(job->claim.client);
  if (client == clients_.end()) return false;
  const auto flow = std::ranges::find(client->flows, job->claim.flow, &Flow::name);
  if (flow == client->flows.end() || std::erase(flow->jobs, job) == 0) return false;
  forget_if_idle(client, flow);
  return true;
}

std::shared_ptr<Job> FairQueue::give_way(const std::string& newcomer) {
  const auto most = std::ranges::max_element(clients_, {}, &Client::count);
  const auto mine = find(newcomer);
  const std::size_t own = mine == clients_.end() ? 0 : mine->count;
  if (most == clients_.end() || most->count < own + 2) return nullptr;
  const auto flow =
      std::ranges::max_element(most->flows, {}, [](const Flow& one) { return one.jobs.size(); });
  const auto last = flow->jobs.back();
  static_cast<void>(remove(last));
  return last;
}

}  // namespace tubecut::server
