#include "server/http/fair_queue.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "server/jobs/slots.hpp"

namespace tubecut::server {
namespace {

/// Returns the share with the least use of those that satisfy `may`; of equal ones, the one whose
/// job came first; nullptr if no share does.
template <class Shares, class May, class Came>
auto* least_used(Shares& shares, May may, Came came) {
  decltype(&shares.begin()->second) least = nullptr;
  for (auto& [name, share] : shares) {
    if (!may(share)) continue;
    if (least == nullptr ||
        std::pair(share.used, came(share)) < std::pair(least->used, came(*least)))
      least = &share;
  }
  return least;
}

}  // namespace

std::size_t FairQueue::came(const Flow& flow) {
  return flow.jobs.empty() ? std::numeric_limits<std::size_t>::max()
                           : flow.jobs.front()->claim.order;
}

std::size_t FairQueue::came(const Client& client) {
  auto first = std::numeric_limits<std::size_t>::max();
  for (const auto& [name, flow] : client.flows) first = std::min(first, came(flow));
  return first;
}

void FairQueue::push(const std::shared_ptr<Job>& job) {
  Claim& claim = job->claim;
  claim.order = ++came_;
  const auto [client, new_client] = clients_.try_emplace(claim.client);
  Client& theirs = client->second;
  if (new_client) theirs.used = floor_;
  const auto [found, new_flow] = theirs.flows.try_emplace(claim.flow);
  Flow& flow = found->second;
  if (new_flow) flow.used = theirs.floor;
  flow.jobs.push_back(job);
  flow.waiting += claim.expected_s;
  theirs.waiting += claim.expected_s;
  ++theirs.count;
  ++size_;
}

std::shared_ptr<Job> FairQueue::pop() {
  return pop_where([](const Claim&) { return true; });
}

std::shared_ptr<Job> FairQueue::pop_quick(double since, bool trials) {
  return pop_where([since, trials](const Claim& first) {
    return first.quick && first.since <= since && (trials || !first.trial);
  });
}

/// Returns the client and flow whose turn is next, of those whose first job satisfies `may`;
/// nullptr if no job does.
template <class Clients, class May>
auto FairQueue::turn_of(Clients& clients, May may) {
  const auto flow_may = [&may](const Flow& flow) {
    return !flow.jobs.empty() && may(flow.jobs.front()->claim);
  };
  const auto client_may = [&](const Client& client) {
    return std::ranges::any_of(client.flows,
                               [&](const auto& flow) { return flow_may(flow.second); });
  };
  const auto when = [](const auto& share) { return came(share); };
  auto* const client = least_used(clients, client_may, when);
  using Turn = std::pair<decltype(client), decltype(least_used(client->flows, flow_may, when))>;
  return client == nullptr ? Turn{} : Turn{client, least_used(client->flows, flow_may, when)};
}

const Claim* FairQueue::next() const {
  const auto [client, flow] = turn_of(clients_, [](const Claim&) { return true; });
  return client == nullptr ? nullptr : &flow->jobs.front()->claim;
}

template <class May>
std::shared_ptr<Job> FairQueue::pop_where(May may) {
  const auto [client, flow] = turn_of(clients_, may);
  if (client == nullptr) return nullptr;
  auto job = std::move(flow->jobs.front());
  flow->jobs.pop_front();
  take_out(*client, *flow, *job);
  floor_ = std::max(floor_, client->used);
  client->floor = std::max(client->floor, flow->used);
  for (Share* share : {static_cast<Share*>(client), static_cast<Share*>(flow)}) {
    share->used += job->claim.expected_s;
    ++share->running;
  }
  return job;
}

void FairQueue::take_out(Client& client, Flow& flow, const Job& job) {
  flow.waiting -= job.claim.expected_s;
  client.waiting -= job.claim.expected_s;
  --client.count;
  --size_;
}

void FairQueue::done(const Claim& claim, double took) {
  Client& client = clients_.at(claim.client);
  Flow& flow = client.flows.at(claim.flow);
  for (Share* share : {static_cast<Share*>(&client), static_cast<Share*>(&flow)}) {
    share->used += took - claim.expected_s;
    --share->running;
  }
  forget_idle(claim.client, claim.flow);
}

void FairQueue::forget_idle(const std::string& client, const void* flow) {
  auto& flows = clients_.at(client).flows;
  const auto found = flows.find(flow);
  if (found->second.running == 0 && found->second.jobs.empty()) flows.erase(found);
  if (flows.empty()) clients_.erase(client);
}

void FairQueue::slow(std::string_view kind, const std::string& client) {
  const auto its = clients_.find(client);
  if (its == clients_.end()) return;
  for (auto& [flow_name, flow] : its->second.flows)
    for (const auto& job : flow.jobs) job->claim.quick = job->claim.quick && job->kind != kind;
}

bool FairQueue::remove(const std::shared_ptr<Job>& job) {
  const Claim claim = job->claim;
  const auto client = clients_.find(claim.client);
  if (client == clients_.end()) return false;
  const auto flow = client->second.flows.find(claim.flow);
  if (flow == client->second.flows.end()) return false;
  auto& jobs = flow->second.jobs;
  const auto at = std::ranges::find(jobs, job);
  if (at == jobs.end()) return false;
  jobs.erase(at);
  take_out(client->second, flow->second, *job);
  forget_idle(claim.client, claim.flow);
  return true;
}

std::shared_ptr<Job> FairQueue::give_way(const Claim& newcomer) {
  const auto most = std::ranges::max_element(
      clients_, {}, [](const auto& client) { return client.second.count; });
  const auto mine = clients_.find(newcomer.client);
  const std::size_t own = mine == clients_.end() ? 0 : mine->second.count;
  if (most == clients_.end() || most->second.count < own + 2) return nullptr;
  const auto flow = std::ranges::max_element(
      most->second.flows, {}, [](const auto& one) { return one.second.jobs.size(); });
  const auto last = flow->second.jobs.back();
  static_cast<void>(remove(last));
  return last;
}

double FairQueue::before(const Claim& claim, bool quick_only) const {
  double theirs = 0.0;  // each other client and flow has as much before it as it has itself
  double own = claim.expected_s;
  const auto mine = clients_.find(claim.client);
  if (mine != clients_.end()) {
    for (const auto& [name, flow] : mine->second.flows) {
      if (quick_only && !flow.jobs.empty() && !flow.jobs.front()->claim.quick) continue;
      own += name == claim.flow ? flow.waiting : std::min(flow.waiting, claim.expected_s);
    }
  }
  for (const auto& [name, client] : clients_) {
    if (name == claim.client) continue;
    double waits = 0.0;
    for (const auto& [flow_name, flow] : client.flows) {
      const bool counts = !quick_only || (!flow.jobs.empty() && flow.jobs.front()->claim.quick);
      waits += counts ? flow.waiting : 0.0;
    }
    theirs += std::min(waits, own);
  }
  return own - claim.expected_s + theirs;
}

}  // namespace tubecut::server
