#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/bevel/section/section_surface.hpp"
#include "core/section/section.hpp"

namespace tubecut::part {

/// Calls f(row, from, to) for the parts of every gap between rows, as shares of the gap, within
/// which the wall is smooth: a gap is divided at the seams of both outlines.
template <class F>
void each_smooth_strip(const bevel::SectionSurface& surface, F f) {
  const auto& wall = surface.wall();
  const double girth = wall.outer().girth();
  std::vector<double> seams = wall.outer().seams();
  for (const double s : wall.bore().seams()) seams.push_back(wall.outside_of(wall.bore().at(s)));
  for (std::size_t row = 0; row < surface.rows(); ++row) {
    const double wide = surface.width(row);
    if (!(wide > 0.0)) continue;
    const double from = surface.line(row, 0.0).at.s;
    std::vector<double> shares{0.0, 1.0};
    for (const double seam : seams) {
      double off = seam - from;
      if (off < 0.0) off += girth;
      if (off < wide) shares.push_back(off / wide);
    }
    std::ranges::sort(shares);
    for (std::size_t i = 0; i + 1 < shares.size(); ++i)
      if (shares[i + 1] - shares[i] > 1e-12) f(row, shares[i], shares[i + 1]);
  }
}

}  // namespace tubecut::part
