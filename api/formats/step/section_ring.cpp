#include "api/formats/step/section_ring.hpp"

#include <algorithm>
#include <cmath>

#include "api/formats/step/section_curve.hpp"
#include "core/base/angle.hpp"

namespace tubecut::api {
namespace {

using bevel::SectionSurface;
using Eigen::Vector3d;

constexpr double kInLine = 1e-8;  // mm, of a row that is left out of a flat
constexpr double kWidest = 0.2;   // rad, of a cubic: 2e-9 of the radius off its arc

bool in_line(const Across& before, const Across& row, const Across& after) {
  for (const auto* one : {&before, &row, &after})
    for (const auto& station : one->stations)
      if (station.on_corner || station.face != row.stations.front().face) return false;
  const double wide = after.s - before.s;
  if (!(row.s - before.s > kSamePlace) || !(after.s - row.s > kSamePlace)) return false;
  const double share = (row.s - before.s) / wide;
  for (std::size_t k = 0; k < row.points.size(); ++k)
    if ((before.points[k] + share * (after.points[k] - before.points[k]) - row.points[k]).norm() >
        kInLine)
      return false;
  return true;
}

/// Returns true if one row comes twice: of a jump of the other wall.
bool again(const Across& a, const Across& b) {
  for (std::size_t k = 0; k < a.points.size(); ++k)
    if ((a.points[k] - b.points[k]).norm() > kSamePlace) return false;
  return true;
}

}  // namespace

SectionRing::SectionRing(const section::Wall& wall, const bevel::TableSpec& spec,
                         const bevel::SectionTable& table, const std::vector<double>& seams)
    : wall_(wall), surface_(wall, spec, table), land_(spec.root_face) {
  std::size_t k = 0;
  const auto add_seams = [&](double to) {
    for (; k < seams.size() && seams[k] < to - kSamePlace; ++k) rows_.push_back(between(seams[k]));
    while (k < seams.size() && seams[k] <= to + kSamePlace) ++k;  // a row is there
  };
  for (std::size_t i = 0; i < table.at.size(); ++i) {
    add_seams(table.at[i].s);
    rows_.push_back(across(surface_.line(i, 0.0)));
  }
  add_seams(table.girth + 2.0 * kSamePlace);
  leave_out_rows_again();
  divide_arcs(table.girth);
  leave_out_rows_in_line(seams);
}

bool SectionRing::square() const {
  const double z = rows_.front().points.front().z();
  return std::ranges::all_of(rows_, [&](const Across& row) {
    return std::ranges::all_of(
        row.points, [&](const Vector3d& p) { return std::abs(p.z() - z) <= kSamePlace; });
  });
}

Across SectionRing::between(double s) const {
  return across(surface_.line_at(surface_.row_before(s), s));
}

Across SectionRing::across(const SectionSurface::Line& line) const {
  Across out{.s = line.at.s,
             .points = {SectionSurface::place(line, 0.0, line.outer)},
             .stations = {line.at, wall_.across(line.at).bore}};
  if (land_ > 0.0) out.points.push_back(SectionSurface::place(line, line.wall - land_, line.face));
  out.points.push_back(SectionSurface::place(line, line.wall, line.inner));
  return out;
}

void SectionRing::leave_out_rows_again() {
  rows_.erase(std::ranges::unique(rows_, again).begin(), rows_.end());
}

void SectionRing::divide_arcs(double girth) {
  std::vector<Across> all;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto& a = rows_[i];
    const auto& b = rows_[next(i)];
    all.push_back(a);
    double angle = 0.0;
    for (const auto k : {0U, 1U})
      angle = std::max(angle, std::abs(turned(a.stations[k], b.stations[k])));
    const int parts = static_cast<int>(std::ceil(angle / kWidest));
    const double wide = b.s - a.s + (next(i) == 0 ? girth : 0.0);
    for (int part = 1; part < parts && wide > kSamePlace; ++part) {
      const double s = a.s + wide * part / parts;
      all.push_back(between(s < girth ? s : s - girth));
    }
  }
  rows_ = std::move(all);
}

void SectionRing::leave_out_rows_in_line(const std::vector<double>& seams) {
  std::vector<Across> kept;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto& row = rows_[i];
    const bool seam =
        std::ranges::any_of(seams, [&](double s) { return std::abs(s - row.s) <= kSamePlace; });
    const bool first = kept.empty(), last = i + 1 == rows_.size();
    if (seam || first || last || !in_line(kept.back(), row, rows_[i + 1])) kept.push_back(row);
  }
  rows_ = std::move(kept);
}

}  // namespace tubecut::api
