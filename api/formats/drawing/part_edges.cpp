#include "api/formats/drawing/part_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/angle.hpp"

namespace tubecut::api {

double turned_from(double from, double phi) {
  return phi - kTwoPi * std::floor((phi - from) / kTwoPi);
}

RoundEdge::RoundEdge(const std::vector<double>& phi, const std::vector<double>& z, double opened)
    : opened_(opened) {
  for (std::size_t i = 0; i < phi.size(); ++i)
    points_.emplace_back(turned_from(opened, phi[i]), z[i]);
  std::ranges::stable_sort(points_, {}, &std::pair<double, double>::first);
  if (points_.empty()) return;
  const auto first = points_.front(), last = points_.back();
  const double ahead = first.first + kTwoPi - last.first;
  const double share = ahead > 0.0 ? (first.first - opened) / ahead : 0.0;
  const double z_opened = first.second + share * (last.second - first.second);
  if (first.first > opened) points_.insert(points_.begin(), {opened, z_opened});
  points_.emplace_back(opened + kTwoPi, z_opened);
}

double RoundEdge::at(double phi) const {
  const double here = turned_from(opened_, phi);
  const auto after = std::ranges::upper_bound(points_, here, {}, &std::pair<double, double>::first);
  if (after == points_.begin()) return points_.front().second;
  if (after == points_.end()) return points_.back().second;
  const auto [p, z] = *(after - 1);
  return z + (here - p) / (after->first - p) * (after->second - z);
}

SurfaceRange surface_range(const bevel::Hole& hole) {
  const auto z = std::ranges::minmax(hole.z), phi = std::ranges::minmax(hole.phi);
  return {.z_from = z.min, .z_to = z.max, .phi_from = phi.min, .phi_to = phi.max};
}

SurfaceRange surface_range(const bevel::Table& end) {
  const auto outer = std::ranges::minmax(end.z_outer), inner = std::ranges::minmax(end.z_inner);
  return {.z_from = std::min(outer.min, inner.min),
          .z_to = std::max(outer.max, inner.max),
          .phi_from = 0.0,
          .phi_to = kTwoPi};
}

std::string_view partner_color(std::size_t i) {
  static constexpr std::array<std::string_view, 6> kColors{"#a98545", "#5c8a5a", "#8a5f8f",
                                                           "#3f8a9a", "#b0646a", "#7a7f3c"};
  return kColors[i % kColors.size()];
}

std::string hole_tag(std::size_t i) { return "H" + std::to_string(i + 1); }

std::string cutout_tag(const cutout::Layout& layout, std::size_t i) {
  return cutout::title_of(layout, layout.instances[i]);
}

std::vector<Opening> openings(const part::Part& part) {
  std::vector<Opening> out;
  for (std::size_t i = 0; i < part.holes.size(); ++i)
    out.push_back({part.holes[i].hole, hole_tag(i), true});
  const auto& layout = part.cutouts;
  const bool tagged = layout.instances.size() <= kMostTagged;
  for (std::size_t i = 0; i < layout.instances.size(); ++i) {
    const auto& one = layout.instances[i];
    out.push_back({cutout::placed(layout, one), cutout_tag(layout, i),
                   tagged && !layout.mould_of(one).cone});  // its circle has the tag
  }
  return out;
}

std::vector<SurfaceRange> joined(const std::vector<SurfaceRange>& ranges, double room) {
  std::vector<SurfaceRange> out;
  for (auto range : ranges) {
    range.z_from -= room;
    range.z_to += room;
    if (!out.empty() && range.z_from <= out.back().z_to)
      out.back().z_to = std::max(out.back().z_to, range.z_to);
    else
      out.push_back(range);
  }
  return out;
}

double phase_off_openings(const part::Part& part) {
  const auto all = openings(part);
  const auto off = [&](double phi) {
    double least = kPi;
    for (const auto& one : all) {
      const auto range = surface_range(one.rows);
      const double after = turned_from(range.phi_from, phi) - range.phi_from;
      const double width = range.phi_to - range.phi_from;
      least = std::min(least, after <= width ? -1.0 : std::min(after - width, kTwoPi - after));
    }
    return least;
  };
  constexpr double kStep = 15.0 * kRadPerDeg;
  double best = 0.0;
  if (off(0.0) > 0.0) return best;
  for (int i = 1; i < 24; ++i)
    if (off(kStep * i) > off(best) + 1e-9) best = kStep * i;
  return best;
}

}  // namespace tubecut::api
