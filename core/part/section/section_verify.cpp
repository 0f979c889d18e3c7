#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/base/error.hpp"
#include "core/base/stop.hpp"
#include "core/math/mixed.hpp"
#include "core/part/section/section_part.hpp"
#include "core/part/section/section_strips.hpp"
#include "core/part/section/section_tabs.hpp"
#include "core/part/square_holes.hpp"
#include "core/part/text_clearance.hpp"
#include "core/part/worst_checks.hpp"

namespace tubecut::part {
namespace {

using bevel::SectionSurface;
using bevel::SectionTable;
using Eigen::Vector3d;

constexpr double kPlacedOff = 1e-9;  // mm
constexpr double kVolumeOff = 1e-9;  // relative
/// rad that facets go round at once; coarse rows leave a whole corner between two of them, where
/// their extrapolation would be off by more than kVolumeOff.
constexpr double kMostTurn = 0.4;

/// Transforms from the part's frame to the end's own.
struct RigidMotion {
  Vector3d axes;  // of a half revolution about x, or none
  Vector3d shift;
  Vector3d operator()(const Vector3d& p) const { return axes.cwiseProduct(p) + shift; }
};

/// The points and the beam of one row in space.
std::array<Vector3d, 5> row_in_space(const SectionTable& t, std::size_t i) {
  const auto at = [&](double depth, double z) {
    const Eigen::Vector2d p = t.at[i].point - depth * t.at[i].normal;
    return Vector3d(p.x(), p.y(), z);
  };
  const auto beam = elementary::sincos(t.b[i]);
  const auto& n = t.at[i].normal;
  return {at(t.wall[i], t.z_inner[i]), at(0.0, t.z_outer[i]), at(t.wall[i], t.torch_inner[i]),
          at(0.0, t.torch_outer[i]), Vector3d(beam.cos * n.x(), beam.cos * n.y(), beam.sin)};
}

/// Checks that every row of the part's table holds the points of a row of the end's own.
double misplaced(const SectionEnd& end, bool finish, const RigidMotion& place) {
  const auto n = end.own.at.size();
  if (end.table.at.size() != n) return 1.0;
  // The rows on the datum line come first both ways; one may lie just before it, by rounding.
  std::size_t zeros = 0;
  while (zeros < n && std::abs(std::remainder(end.own.at[zeros].s, end.own.girth)) < 1e-9) ++zeros;
  double worst = 0.0;
  for (std::size_t k = 0; k < n && !stopped(); ++k) {
    const auto i = !finish ? k : k < zeros ? zeros - 1 - k : n - 1 - (k - zeros);
    const auto here = row_in_space(end.table, k), own = row_in_space(end.own, i);
    for (std::size_t p = 0; p < 4; ++p) worsen(worst, (place(here[p]) - own[p]).norm());
    worsen(worst, (place.axes.cwiseProduct(here[4]) - own[4]).norm());
  }
  return worst;
}

/// The volume below the cut of one strip by facets: prisms of three sides over a grid of places,
/// extrapolated from three widths of the grid.
double by_facets(const SectionSurface& surface, std::size_t row, double from, double to) {
  const auto once = [&](int parts) {
    double sum = 0.0;
    const auto prism = [&](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
      const Eigen::Vector2d u = (b - a).head<2>(), v = (c - a).head<2>();
      sum += 0.5 * (u.x() * v.y() - u.y() * v.x()) * (a.z() + b.z() + c.z()) / 3.0;
    };
    const auto places = [&](double share) {
      const auto line = surface.line(row, share);
      std::vector<double> depths{line.wall, line.wall - surface.land(), 0.0};
      std::vector<Vector3d> out;
      for (std::size_t k = 0; k + 1 < depths.size(); ++k) {
        if (!(depths[k] > depths[k + 1])) continue;
        for (int i = 0; i < parts; ++i) {
          const double depth = depths[k] + i * (depths[k + 1] - depths[k]) / parts;
          out.push_back(SectionSurface::place(line, depth, surface.z(line, depth)));
        }
      }
      out.push_back(SectionSurface::place(line, 0.0, line.outer));
      return out;
    };
    auto before = places(from);
    for (int j = 1; j <= parts; ++j) {
      auto here = places(from + j * (to - from) / parts);
      for (std::size_t k = 0; k + 1 < here.size(); ++k) {
        // From the bore outwards, then along the girth: counter-clockwise.
        prism(before[k], before[k + 1], here[k + 1]);
        prism(before[k], here[k + 1], here[k]);
      }
      before = std::move(here);
    }
    return sum;
  };
  const double a = once(4), b = once(8), c = once(16);
  const double ab = b + (b - a) / 3.0, bc = c + (c - b) / 3.0;
  return bc + (bc - ab) / 15.0;
}

double volume_of(const section::Wall& wall, const SectionEnd& end) {
  const SectionSurface surface(wall, end.spec, end.table);
  double sum = 0.0;
  each_smooth_strip(surface, [&](std::size_t row, double from, double to) {
    const double curvature = surface.line(row, 0.5 * (from + to)).at.curvature;
    const double turn = std::abs(curvature) * (to - from) * surface.width(row);
    const int pieces = std::max(1, static_cast<int>(std::ceil(turn / kMostTurn)));
    for (int i = 0; i < pieces && !stopped(); ++i)
      sum += by_facets(surface, row, math::mixed(from, to, static_cast<double>(i) / pieces),
                       math::mixed(from, to, static_cast<double>(i + 1) / pieces));
  });
  return sum;
}

/// The lengths of the faces by a separate search in the rows of the answer.
double faces_off(const SectionPartSpec& spec, const SectionPart& p) {
  const auto curve = spec.section.outer();
  const auto height = [&](const SectionTable& t, double s, bool high) {
    double best = high ? -1e300 : 1e300;
    for (std::size_t i = 0; i < t.at.size(); ++i) {
      const auto j = (i + 1) % t.at.size();
      double from = t.at[i].s;
      if (i == 0 && t.at.size() > 1 && from > t.at[1].s) from -= t.girth;
      const double to = t.at[j].s + (j == 0 ? t.girth : 0.0);
      for (const double here : {s, s + t.girth}) {
        if (here < from || here > to) continue;
        const double share = to > from ? (here - from) / (to - from) : 0.0;
        const double z = t.z_outer[i] + share * (t.z_outer[j] - t.z_outer[i]);
        best = high ? std::max(best, z) : std::min(best, z);
      }
    }
    return best;
  };
  double worst = 0.0;
  for (int face = 1; face <= 4; ++face) {
    const auto& got = p.faces[static_cast<std::size_t>(face - 1)];
    for (const bool corner : {false, true}) {
      const double s = corner ? curve.on_corner(face, 0.25 * kPi) : curve.on_face(face, 0.0);
      worsen(worst, std::abs(height(p.finish.table, s, false) - height(p.start.table, s, true) -
                             (corner ? got.corner : got.length)));
    }
  }
  return worst;
}

}  // namespace

std::vector<Check> verify(const SectionPartSpec& spec, const SectionPart& part) {
  WorstChecks all;
  const section::Wall wall(spec.section);
  for (const bool finish : {false, true}) {
    const auto& end = finish ? part.finish : part.start;
    all.see(bevel::verify(spec.section, end.spec, end.shoulder ? *end.shoulder : end.own), "");
    if (end.shoulder)
      all.see(
          verify_tabs({wall, end.spec, finish ? spec.finish_tabs : spec.start_tabs, finish}, end),
          "");
  }
  auto out = all.take();
  const double start =
      spec.start_frame.rows.row(2).dot(part.frame.origin - spec.start_frame.origin);
  const double limit = kPlacedOff * std::max(1.0, 1e-3 * (wall.outer().reach() + spec.length));
  double placed = 0.0;
  worsen(placed, misplaced(part.start, false, {{1.0, 1.0, 1.0}, {0.0, 0.0, start}}));
  worsen(placed,
         misplaced(part.finish, true, {{1.0, -1.0, -1.0}, {0.0, 0.0, spec.length - start}}));
  out.push_back({"placed", placed, limit, "mm"});
  if (!part.cutouts.empty())
    for (auto& check : cutout::verify(part.cutouts, cutout_ground(spec, part)))
      out.push_back(std::move(check));
  for (auto& check : verify_square_holes(spec, part)) out.push_back(std::move(check));
  for (auto& check : verify_texts(part)) out.push_back(std::move(check));
  const double volume = volume_of(wall, part.finish) - volume_of(wall, part.start) -
                        cutout::volume_by_rings(part.cutouts);
  out.push_back(
      {"volume", std::abs(part.lengths.volume - volume) / std::abs(volume), kVolumeOff, ""});
  out.push_back({"check_dimensions", faces_off(spec, part), limit, "mm"});
  return out;
}

}  // namespace tubecut::part
