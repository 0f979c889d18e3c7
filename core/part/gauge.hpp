#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/stop.hpp"
#include "core/part/dimensions.hpp"

/// Dimensions that reveal mistakes, of any kind of part.
namespace tubecut::part {

inline constexpr double kSeen = 1.0;                      // mm: visible with a tape
inline constexpr double kWallOff = 2.0, kPivotOff = 5.0;  // mm, of the mistakes

/// One dimension, and its measurement on any shape.
template <class S>
struct Gauge {
  CheckDimension about;
  std::function<double(const S&)> read;
  bool around = false;  // a position on the circumference: modulo the circumference
};

template <class S>
[[nodiscard]] Gauge<S> gauge(std::string name, Tool tool, std::string from,
                             std::function<double(const S&)> read, bool around = false) {
  return {.about = {.name = std::move(name),
                    .value = 0.0,
                    .tool = tool,
                    .measured_from = std::move(from),
                    .changes_with = {}},
          .read = std::move(read),
          .around = around};
}

/// Measures the shape, and lists for each dimension the mistakes that change it visibly.
/// `with(mistake, shape)` returns the shapes that one mistake can produce. If cancelled, some
/// mistakes are not listed.
template <class S, class Mistakes, class With>
[[nodiscard]] std::vector<CheckDimension> measured(std::vector<Gauge<S>> all, const S& shape,
                                                   const Mistakes& mistakes, const With& with,
                                                   double girth) {
  const auto seen = [girth](const Gauge<S>& g, const S& bad) {
    double off = std::abs(g.read(bad) - g.about.value);
    if (g.around) off = std::min(off, girth - off);
    return off > kSeen;
  };
  for (auto& g : all) g.about.value = g.read(shape);
  for (const auto mistake : mistakes) {
    if (stopped()) break;
    const auto bad = with(mistake, shape);
    for (auto& g : all)
      if (std::ranges::any_of(bad, [&](const S& b) { return seen(g, b); }))
        g.about.changes_with.push_back(mistake);
  }
  std::vector<CheckDimension> out;
  for (auto& g : all) out.push_back(std::move(g.about));
  return out;
}

}  // namespace tubecut::part
