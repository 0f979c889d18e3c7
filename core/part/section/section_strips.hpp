#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/angle.hpp"
#include "core/bevel/section/section_surface.hpp"
#include "core/section/section.hpp"

namespace tubecut::part {

/// Returns into how many parts a strip is divided, because lines bunch on a bore that is not
/// concentric: within one the bore turns by at most a twentieth of a radian.
inline int parts_of_strip(const bevel::SectionSurface& surface, std::size_t row, double from,
                          double to) {
  constexpr double kMostTurn = 0.05;  // rad
  if (surface.wall().concentric()) return 1;
  const auto nu = [&](double share) {
    return surface.wall().across(surface.line(row, share).at).bore.nu;
  };
  const double turn = std::abs(std::remainder(nu(to) - nu(from), kTwoPi));
  return std::max(1, static_cast<int>(std::ceil(turn / kMostTurn)));
}

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
      if (shares[i + 1] - shares[i] > 1e-12) {
        const int parts = parts_of_strip(surface, row, shares[i], shares[i + 1]);
        const double part = (shares[i + 1] - shares[i]) / parts;
        for (int k = 0; k < parts; ++k)
          f(row, shares[i] + k * part, k + 1 == parts ? shares[i + 1] : shares[i] + (k + 1) * part);
      }
  }
}

}  // namespace tubecut::part
