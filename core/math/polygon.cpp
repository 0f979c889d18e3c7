#include "core/math/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/base/stop.hpp"

namespace tubecut::math {
namespace {

/// An edge that is not vertical, from left to right.
struct Side {
  double x0, y0, x1, y1;
  std::size_t polygon;

  [[nodiscard]] double at(double x) const {
    if (x <= x0) return y0;
    if (x >= x1) return y1;
    return y0 + (x - x0) / (x1 - x0) * (y1 - y0);
  }
};

std::vector<Side> sides(std::span<const Polygon> polygons, const Window& window) {
  std::vector<Side> out;
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    const auto& [x, y] = polygons[p];
    for (std::size_t i = 0; i < x.size() && !stops(i); ++i) {
      const auto j = (i + 1) % x.size();
      const auto [a, b] = x[i] <= x[j] ? std::pair{i, j} : std::pair{j, i};
      if (x[a] < x[b] && x[b] > window.x_from && x[a] < window.x_to)
        out.push_back({x[a], y[a], x[b], y[b], p});
    }
  }
  std::ranges::sort(out, {}, &Side::x0);
  return out;
}

/// Heights of a side at both ends of a strip.
struct Rise {
  double left, right;
};

/// Returns the x between `from` and `to` where two sides cross, or where one crosses the window's
/// floor or ceiling.
std::vector<double> crossings(const std::vector<Side>& over, double from, double to,
                              const Window& window) {
  std::vector<Rise> rises;
  rises.reserve(over.size() + 2);
  for (const auto& side : over) rises.push_back({side.at(from), side.at(to)});
  for (const double level : {window.y_from, window.y_to})
    if (std::isfinite(level)) rises.push_back({level, level});
  std::ranges::sort(rises, {}, &Rise::left);
  std::vector<double> out{from, to};
  if (std::ranges::is_sorted(rises, {}, &Rise::right)) return out;  // true for most strips
  for (std::size_t i = 0; i < rises.size(); ++i)
    for (std::size_t j = i + 1; j < rises.size(); ++j) {
      const double left = rises[i].left - rises[j].left, right = rises[i].right - rises[j].right;
      if ((left < 0.0) != (right < 0.0) && left != right)
        out.push_back(std::clamp(from + (to - from) * left / (left - right), from, to));
    }
  std::ranges::sort(out);
  return out;
}

/// Returns the length of the union at x, from each polygon's sides in pairs from below.
double covered(const std::vector<Side>& over, double x, const Window& window) {
  std::vector<std::pair<std::size_t, double>> hits;
  hits.reserve(over.size());
  for (const auto& side : over) hits.emplace_back(side.polygon, side.at(x));
  std::ranges::sort(hits);
  std::vector<std::pair<double, double>> spans;
  for (std::size_t i = 0; i + 1 < hits.size(); i += 2)
    spans.emplace_back(std::max(hits[i].second, window.y_from),
                       std::min(hits[i + 1].second, window.y_to));
  std::ranges::sort(spans);
  double sum = 0.0, reached = -std::numeric_limits<double>::infinity();
  for (const auto& [low, high] : spans) {
    if (high > std::max(low, reached)) sum += high - std::max(low, reached);
    reached = std::max(reached, high);
  }
  return sum;
}

}  // namespace

double area(const Polygon& polygon) {
  const auto& [x, y] = polygon;
  double twice = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto j = (i + 1) % x.size();
    twice += (x[i] - x[0]) * (y[j] - y[0]) - (x[j] - x[0]) * (y[i] - y[0]);
  }
  return 0.5 * std::abs(twice);
}

double union_area(std::span<const Polygon> polygons, const Window& window) {
  const auto all = sides(polygons, window);
  std::vector<double> corners;
  corners.reserve(2 * all.size());
  for (const auto& side : all)
    for (const double x : {side.x0, side.x1})
      corners.push_back(std::clamp(x, window.x_from, window.x_to));
  std::ranges::sort(corners);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());

  double sum = 0.0;
  std::vector<Side> over;
  std::size_t next = 0;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    if (stopped()) break;  // because a strip may have hundreds of sides
    const double from = corners[k], to = corners[k + 1];
    std::erase_if(over, [&](const Side& side) { return side.x1 <= from; });
    while (next < all.size() && all[next].x0 <= from) {
      if (all[next].x1 > from) over.push_back(all[next]);
      ++next;
    }
    const auto strips = crossings(over, from, to, window);
    for (std::size_t i = 0; i + 1 < strips.size(); ++i)
      if (strips[i + 1] > strips[i])
        sum +=
            (strips[i + 1] - strips[i]) * covered(over, 0.5 * (strips[i] + strips[i + 1]), window);
  }
  return sum;
}

double crossed_area(const Polygon& polygon) {
  return std::abs(union_area({&polygon, 1}, {}) - area(polygon));
}

}  // namespace tubecut::math
