#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>

namespace tubecut::server {

class Place;

/// Counts the open connections of each client, up to a limit per client. Only for the loop's
/// thread.
class Places {
 public:
  explicit Places(std::size_t most) : most_(most) {}
  Places(const Places&) = delete;
  Places& operator=(const Places&) = delete;

  [[nodiscard]] bool full(const std::string& client) const {
    const auto found = count_.find(client);
    return found != count_.end() && found->second >= most_;
  }

 private:
  friend class Place;
  std::size_t most_;
  std::map<std::string, std::size_t> count_;
};

/// One of a client's places, given back at the end of its life.
class Place {
 public:
  Place() = default;
  Place(Places& of, const std::string& client)
      : of_(&of), at_(of.count_.try_emplace(client, 0).first) {
    ++at_->second;
  }
  Place(Place&& other) noexcept : of_(std::exchange(other.of_, nullptr)), at_(other.at_) {}
  Place& operator=(Place&& other) noexcept {
    std::swap(of_, other.of_);
    std::swap(at_, other.at_);
    return *this;
  }
  ~Place() {
    if (of_ != nullptr && --at_->second == 0) of_->count_.erase(at_);
  }

  [[nodiscard]] bool is_of(const std::string& client) const {
    return of_ != nullptr && at_->first == client;
  }

 private:
  Places* of_ = nullptr;
  std::map<std::string, std::size_t>::iterator at_ = {};
};

}  // namespace tubecut::server
