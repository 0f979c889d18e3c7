#pragma once

#include <algorithm>
#include <array>
#include <functional>

namespace tubecut::groove::testing {

/// A slow, plain simplex search in two variables: an oracle that knows no derivative.
struct Simplex {
  using Point = std::array<double, 2>;
  std::function<double(Point)> objective;
  int evaluations = 0;

  double at(Point p) {
    ++evaluations;
    return objective(p);
  }

  Point descend(Point start, Point size, int steps) {
    struct Vertex {
      Point p;
      double f;
    };
    std::array<Vertex, 3> s;
    for (std::size_t k = 0; k < 3; ++k) {
      Point p = start;
      if (k > 0) p[k - 1] += size[k - 1];
      s[k] = {p, at(p)};
    }
    for (int i = 0; i < steps; ++i) {
      std::sort(s.begin(), s.end(), [](const Vertex& a, const Vertex& b) { return a.f < b.f; });
      const Point centre = {0.5 * (s[0].p[0] + s[1].p[0]), 0.5 * (s[0].p[1] + s[1].p[1])};
      const auto along = [&](double k) {
        const Point p = {centre[0] + k * (centre[0] - s[2].p[0]),
                         centre[1] + k * (centre[1] - s[2].p[1])};
        return Vertex{p, at(p)};
      };
      const Vertex reflected = along(1.0);
      if (reflected.f < s[0].f) {
        const Vertex further = along(2.0);
        s[2] = further.f < reflected.f ? further : reflected;
      } else if (reflected.f < s[1].f) {
        s[2] = reflected;
      } else if (const Vertex drawn = along(reflected.f < s[2].f ? 0.5 : -0.5);
                 drawn.f < std::min(reflected.f, s[2].f)) {
        s[2] = drawn;
      } else {
        for (std::size_t k = 1; k < 3; ++k) {
          const Point p = {0.5 * (s[k].p[0] + s[0].p[0]), 0.5 * (s[k].p[1] + s[0].p[1])};
          s[k] = {p, at(p)};
        }
      }
    }
    return std::min_element(s.begin(), s.end(),
                            [](const Vertex& a, const Vertex& b) { return a.f < b.f; })
        ->p;
  }
};

}  // namespace tubecut::groove::testing
