#pragma once

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"

namespace tubecut::part {

/// The worst check of each name, relative to its limit.
class WorstChecks {
 public:
  void see(const std::vector<Check>& checks, const std::string& prefix) {
    for (auto check : checks) {
      check.name = prefix + check.name;
      const auto [place, fresh] = places_.emplace(check.name, checks_.size());
      if (fresh)
        checks_.push_back(std::move(check));
      else if (auto& worst = checks_[place->second];
               !std::isnan(worst.value) &&
               !(check.value * worst.limit <= worst.value * check.limit))
        worst = std::move(check);
    }
  }
  std::vector<Check> take() { return std::move(checks_); }

 private:
  std::map<std::string, std::size_t> places_;
  std::vector<Check> checks_;
};

}  // namespace tubecut::part
