#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>

namespace tubecut::server {

class ConnectionPermit;

/// Counts the open connections of each client, up to a limit per client. Only for the loop's
/// thread.
class ConnectionQuota {
 public:
  explicit ConnectionQuota(std::size_t most) : most_(most) {}
  ConnectionQuota(const ConnectionQuota&) = delete;
  ConnectionQuota& operator=(const ConnectionQuota&) = delete;

  [[nodiscard]] bool full(const std::string& client) const {
    const auto found = count_.find(client);
    return found != count_.end() && found->second >= most_;
  }

 private:
  friend class ConnectionPermit;
  std::size_t most_;
  std::map<std::string, std::size_t> count_;
};

/// One of a client's connections, given back at the end of its life.
class ConnectionPermit {
 public:
  ConnectionPermit() = default;
  ConnectionPermit(ConnectionQuota& of, const std::string& client)
      : of_(&of), at_(of.count_.try_emplace(client, 0).first) {
    ++at_->second;
  }
  ConnectionPermit(ConnectionPermit&& other) noexcept
      : of_(std::exchange(other.of_, nullptr)), at_(other.at_) {}
  ConnectionPermit& operator=(ConnectionPermit&& other) noexcept {
    std::swap(of_, other.of_);
    std::swap(at_, other.at_);
    return *this;
  }
  ~ConnectionPermit() {
    if (of_ != nullptr && --at_->second == 0) of_->count_.erase(at_);
  }

  [[nodiscard]] bool is_of(const std::string& client) const {
    return of_ != nullptr && at_->first == client;
  }

 private:
  ConnectionQuota* of_ = nullptr;
  std::map<std::string, std::size_t>::iterator at_ = {};
};

}  // namespace tubecut::server
