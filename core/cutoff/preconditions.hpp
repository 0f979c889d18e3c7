#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"

namespace tubecut::cutoff {

/// Collects the errors of single numbers, so that one answer names every field. NaN fails every
/// test.
class Preconditions {
 public:
  explicit Preconditions(std::string prefix) : prefix_(std::move(prefix)) {}

  void positive(const std::string& member, double value, const std::string& unit) {
    require(value > 0.0, member, value, "> 0", unit);
  }
  void not_negative(const std::string& member, double value, const std::string& unit) {
    require(value >= 0.0, member, value, ">= 0", unit);
  }
  void require(bool holds, const std::string& member, double value, Shown limit,
               const std::string& unit) {
    const bool finite = std::isfinite(value);
    if (holds && finite) return;
    Issue issue{.code = finite ? ErrorCode::out_of_range : ErrorCode::not_finite,
                .member = prefix_ + member};
    if (finite) issue.got = value;
    issue.limit = std::move(limit);
    issue.unit = unit;
    issues_.push_back(std::move(issue));
  }
  [[nodiscard]] Result<void> met() const { return no_issues(issues_); }

 private:
  std::string prefix_;
  std::vector<Issue> issues_ = {};
};

}  // namespace tubecut::cutoff
