#include "core/bevel/section/section_beam.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/math/dome.hpp"
#include "core/math/mixed.hpp"

namespace tubecut::bevel {

using Eigen::Vector3d;

namespace {

/// The beam as a cylinder about the table's torch axis, in space.
class Beam {
 public:
  Beam(const SectionSurface& surface, const SectionTable& table, std::size_t row, double share,
       double kerf)
      : surface_(surface), half_(0.5 * kerf), own_(surface.line(row, share)) {
    const auto next = surface.next(row);
    const auto laid = [&](const std::vector<double>& z) {
      return math::mixed(z[row], z[next], share);
    };
    head_ = SectionSurface::place(own_, 0.0, laid(table.torch_outer));
    const Vector3d foot = SectionSurface::place(own_, own_.wall, laid(table.torch_inner));
    side_ = {-own_.at.normal.y(), own_.at.normal.x(), 0.0};
    up_ = (head_ - foot).normalized().cross(side_);
    deepest_ = -(own_.wall + kerf);
  }

  [[nodiscard]] double worst() const { return worst_; }
  [[nodiscard]] const SectionSurface::Line& own() const { return own_; }

  /// Sees all of a straight line in space.
  void see(const Vector3d& from, const Vector3d& to) {
    const Vector3d off = from - head_, way = to - from;
    const math::Dome dome{-way.dot(up_), 1.0, off.dot(side_), way.dot(side_), half_};
    const auto at = math::highest(dome, 0.0, 1.0);
    if (!at) return;
    const Vector3d there = off + *at * way;
    if (there.x() * own_.at.normal.x() + there.y() * own_.at.normal.y() < deepest_) return;
    worst_ = std::max(worst_, dome.at(*at) - off.dot(up_));
  }
  /// Sees a line across the wall.
  void see(const SectionSurface::Line& line) {
    const auto place = [&](double depth, double z) {
      return SectionSurface::place(line, depth, z);
    };
    const auto face = place(line.wall - surface_.land(), line.face);
    see(place(0.0, line.outer), face);
    if (surface_.land() > 0.0) see(face, place(line.wall, line.inner));
  }
  /// Sees the edges of a gap on a flat, straight in space: on lines from edge to edge the beam is
  /// deepest at one of them, because they run square to `side`.
  void see_flat(const SectionSurface::Line& from, const SectionSurface::Line& to) {
    const auto edge = [&](double depth, double z_from, double z_to) {
      see(SectionSurface::place(from, depth, z_from), SectionSurface::place(to, depth, z_to));
    };
    edge(0.0, from.outer, to.outer);
    // A row may lie beyond the flat, where the wall is thicker.
    edge(own_.wall - surface_.land(), from.face, to.face);
    if (surface_.land() > 0.0) edge(own_.wall, from.inner, to.inner);
  }

 private:
  const SectionSurface& surface_;
  double half_;
  SectionSurface::Line own_;
  Vector3d head_, side_, up_;
  double deepest_ = 0.0, worst_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

double beam_depth(const SectionSurface& surface, const SectionTable& table, std::size_t row,
                  double share, double kerf) {
  constexpr int kAlong = 20;
  static const auto kSines = [] {
    std::array<double, 2 * kAlong + 1> sines{};
    for (int k = -kAlong; k <= kAlong; ++k)
      sines[static_cast<std::size_t>(k + kAlong)] = elementary::sin(0.5 * kPi * k / kAlong);
    return sines;
  }();
  const double half = 0.5 * kerf;
  Beam beam(surface, table, row, share, kerf);
  const auto& own = beam.own();
  if (surface.flat_around(own.at, half)) {
    surface.rows_near(row, half, [&](std::size_t i) {
      const auto from = surface.line(i, 0.0), to = surface.line(i, 1.0);
      if (from.at.normal == own.at.normal && to.at.normal == own.at.normal) beam.see_flat(from, to);
    });
    return beam.worst();
  }
  const double reach = surface.beam_reach(kerf);
  const auto see_s = [&](double s) {
    const double there = s - table.girth * std::floor(s / table.girth);
    beam.see(surface.line_at(surface.row_before(there), there));
  };
  surface.rows_near(row, reach, [&](std::size_t i) { beam.see(surface.line(i, 0.0)); });
  for (const double sine : kSines) {
    see_s(own.at.s + half * sine);
    if (reach * std::abs(sine) > half) see_s(own.at.s + reach * sine);
  }
  return beam.worst();
}

}  // namespace tubecut::bevel
