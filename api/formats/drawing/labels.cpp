#include "api/formats/drawing/labels.hpp"

#include <algorithm>
#include <numeric>

namespace tubecut::api {
namespace {

/// Labels that touch each other; `middle` is the desired position of their middle.
struct Group {
  std::size_t count;
  double middle;

  [[nodiscard]] double low(double apart) const {
    return middle - 0.5 * apart * static_cast<double>(count - 1);
  }
  [[nodiscard]] double high(double apart) const {
    return middle + 0.5 * apart * static_cast<double>(count - 1);
  }
  void keep_within(double apart, double least, double most) {
    middle = std::min(middle, most - 0.5 * apart * static_cast<double>(count - 1));
    middle = std::max(middle, least + 0.5 * apart * static_cast<double>(count - 1));
  }
};

}  // namespace

std::vector<double> spread(const std::vector<double>& wanted, double apart, double low,
                           double high) {
  std::vector<std::size_t> order(wanted.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return wanted[i]; });
  if (wanted.size() > 1)
    apart = std::min(apart, (high - low) / static_cast<double>(wanted.size() - 1));
  std::vector<Group> groups;
  for (const auto i : order) {
    groups.push_back({.count = 1, .middle = wanted[i]});
    groups.back().keep_within(apart, low, high);
    while (groups.size() > 1) {
      auto& before = groups[groups.size() - 2];
      const auto& last = groups.back();
      if (before.high(apart) + apart <= last.low(apart)) break;
      const auto count = before.count + last.count;
      before.middle = (before.middle * static_cast<double>(before.count) +
                       last.middle * static_cast<double>(last.count)) /
                      static_cast<double>(count);
      before.count = count;
      before.keep_within(apart, low, high);
      groups.pop_back();
    }
  }
  std::vector<double> out(wanted.size());
  auto next = order.begin();
  for (const auto& group : groups)
    for (std::size_t k = 0; k < group.count; ++k)
      out[*next++] = group.low(apart) + apart * static_cast<double>(k);
  return out;
}

}  // namespace tubecut::api
