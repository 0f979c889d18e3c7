#include "api/formats/step/section_over.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "api/formats/step/section_curve.hpp"
#include "api/wire/format.hpp"
#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"

namespace tubecut::api {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using section::Station;

constexpr double kSame = 1e-9;  // mm, between two rows at one place
constexpr double kSeam = 1e-6;  // mm, of a row from a seam

Vector3d place(const Station& at, double z) { return {at.point.x(), at.point.y(), z}; }

/// A row of the cut-out's wall.
struct Row {
  double s, z, s_bore, z_bore;
};

std::vector<Row> rows_of(const section::Wall& wall, const cutout::Layout& layout,
                         const cutout::Instance& one) {
  const auto rows = cutout::placed(layout, one);
  const double outer = wall.outer().girth() / kTwoPi, bore = wall.bore().girth() / kTwoPi;
  std::vector<Row> out;
  const auto same = [](const Row& a, const Row& b) {
    return elementary::hypot(a.s - b.s, a.z - b.z) <= kSame &&
           elementary::hypot(a.s_bore - b.s_bore, a.z_bore - b.z_bore) <= kSame;
  };
  for (std::size_t i = 0; i < rows.phi.size(); ++i) {
    const Row row{outer * rows.phi[i], rows.z[i], bore * rows.phi_inner[i], rows.z_inner[i]};
    if (out.empty() || !same(out.back(), row)) out.push_back(row);
  }
  while (out.size() > 1 && same(out.front(), out.back())) out.pop_back();
  // Mirrored, the chain runs the other way round.
  if (rows.far) std::ranges::reverse(out);
  return out;
}

std::size_t add_edge(std::size_t from, std::size_t to, Brep::Points points, Brep& solid) {
  solid.edges.push_back({from, to, std::move(points)});
  return solid.edges.size() - 1;
}

bool is_at(double s, double seam, double girth) {
  return std::abs(std::remainder(s - seam, girth)) <= kSeam;
}

using Use = std::pair<std::size_t, bool>;

std::size_t begin_of(const Use& use, const Brep& solid) {
  const auto& edge = solid.edges[use.first];
  return use.second ? edge.from : edge.to;
}
std::size_t end_of(const Use& use, const Brep& solid) {
  return begin_of({use.first, !use.second}, solid);
}

/// The uses as closed loops, each vertex left once.
std::vector<Brep::Loop> traced(const Brep::Loop& uses, const Brep& solid) {
  std::multimap<std::size_t, std::size_t> leaving;
  for (std::size_t i = 0; i < uses.size(); ++i) leaving.emplace(begin_of(uses[i], solid), i);
  std::vector<bool> used(uses.size(), false);
  std::vector<Brep::Loop> out;
  for (std::size_t first = 0; first < uses.size(); ++first) {
    if (used[first]) continue;
    Brep::Loop loop;
    for (auto i = first; !used[i];) {
      used[i] = true;
      loop.push_back(uses[i]);
      const auto [from, to] = leaving.equal_range(end_of(uses[i], solid));
      for (auto it = from; it != to; ++it)
        if (!used[it->second]) {
          i = it->second;
          break;
        }
    }
    out.push_back(std::move(loop));
  }
  return out;
}

/// Whether a loop on a strip goes round a vertex.
bool is_round(const Brep::Loop& loop, const Vector2d& across, const Vector3d& p,
              const Brep& solid) {
  bool inside = false;
  for (const auto& use : loop) {
    const auto &a = solid.vertices[begin_of(use, solid)], &b = solid.vertices[end_of(use, solid)];
    if ((a.z() > p.z()) == (b.z() > p.z())) continue;
    const double share = (p.z() - a.z()) / (b.z() - a.z());
    const double at = (a + share * (b - a)).head<2>().dot(across);
    if (p.head<2>().dot(across) < at) inside = !inside;
  }
  return inside;
}

}  // namespace

bool goes_round(const Brep::Loop& loop, const Vector2d& across, const Brep::Loop& other,
                const Brep& solid) {
  return is_round(loop, across, solid.vertices[begin_of(other.front(), solid)], solid);
}

OverCutout add_over_cutout(const section::Wall& wall, const cutout::Layout& layout,
                           const cutout::Instance& one, const std::string& name, Brep& solid) {
  const auto rows = rows_of(wall, layout, one);
  const auto n = rows.size(), first = solid.vertices.size();
  OverCutout out;
  std::vector<Station> outer, bore;
  std::vector<std::size_t> sides;
  for (std::size_t i = 0; i < n; ++i) {
    outer.push_back(wall.outer().at(rows[i].s));
    bore.push_back(wall.bore().at(rows[i].s_bore));
    solid.vertices.push_back(place(outer[i], rows[i].z));
    solid.vertices.push_back(place(bore[i], rows[i].z_bore));
    out.outside.s.push_back(rows[i].s);
    out.bore.s.push_back(rows[i].s_bore);
    out.outside.vertices.push_back(first + 2 * i);
    out.bore.vertices.push_back(first + 2 * i + 1);
    sides.push_back(add_edge(first + 2 * i, first + 2 * i + 1,
                             {solid.vertices[first + 2 * i], solid.vertices[first + 2 * i + 1]},
                             solid));
  }
  for (std::size_t i = 0; i < n; ++i) {
    const auto j = (i + 1) % n;
    const auto at = [&](std::size_t row, std::size_t side) {
      return solid.vertices[first + 2 * row + side];
    };
    const auto upper = curve_between(at(i, 0), at(j, 0), outer[i], outer[j], wall.outer().corner());
    const auto lower = curve_between(at(i, 1), at(j, 1), bore[i], bore[j], wall.bore().corner());
    const auto above = add_edge(first + 2 * i, first + 2 * j, upper, solid);
    const auto below = add_edge(first + 2 * i + 1, first + 2 * j + 1, lower, solid);
    out.outside.edges.push_back(above);
    out.bore.edges.push_back(below);
    Brep::Face face{
        .name = name,
        .surface = {},
        .cut = true,
        .loops = {{{above, false}, {sides[i], true}, {below, true}, {sides[j], false}}}};
    const bool straight = upper.size() == 2 && lower.size() == 2;
    const auto plane = straight ? plane_of({upper[1], upper[0], lower[0], lower[1]}) : std::nullopt;
    if (plane)
      face.surface = *plane;
    else
      face.surface = Brep::Patch{as_cubic(lower), as_cubic(upper)};
    solid.faces.push_back(std::move(face));
  }
  return out;
}

std::vector<std::size_t> SeamPieces::add(double s, std::size_t start, std::size_t finish,
                                         Brep& solid) const {
  std::vector<std::size_t> between;
  for (const auto& border : borders_) {
    const auto n = border.s.size();
    for (std::size_t i = 0; i < n; ++i) {
      if (!is_at(border.s[i], s, girth_)) continue;
      const double before = std::remainder(border.s[(i + n - 1) % n] - s, girth_);
      const double after = std::remainder(border.s[(i + 1) % n] - s, girth_);
      if (std::abs(before) <= kSeam || std::abs(after) <= kSeam)
        throw UnfitOption{"format",
                          "step prints no cut-out with an edge along the line where a "
                          "flat and a corner meet, as of " +
                              names_ + "; move it by 0.01 mm round"};
      if (before * after < 0.0) between.push_back(border.vertices[i]);
    }
  }
  std::ranges::sort(between, {}, [&](std::size_t v) { return solid.vertices[v].z(); });
  std::vector<std::size_t> out;
  auto from = start;
  between.push_back(finish);
  for (std::size_t k = 0; k < between.size(); k += 2) {
    const auto to = between[k];
    out.push_back(add_edge(from, to, {solid.vertices[from], solid.vertices[to]}, solid));
    if (k + 1 < between.size()) from = between[k + 1];
  }
  return out;
}

std::vector<std::vector<Brep::Loop>> SeamPieces::faces_of(const Strip& strip,
                                                          const std::vector<std::size_t>& before,
                                                          const std::vector<std::size_t>& after,
                                                          const Brep& solid) const {
  Brep::Loop uses = strip.low;
  for (const auto edge : after) uses.emplace_back(edge, true);
  for (auto use = strip.high.rbegin(); use != strip.high.rend(); ++use)
    uses.emplace_back(use->first, false);
  for (auto edge = before.rbegin(); edge != before.rend(); ++edge) uses.emplace_back(*edge, false);
  const auto ours = uses.size();
  std::vector<std::size_t> cut;
  for (const auto& border : borders_) {
    const auto n = border.s.size();
    for (std::size_t i = 0; i < n; ++i) {
      const double way = border.s[(i + 1) % n] - border.s[i];
      const double middle = border.s[i] + 0.5 * way;
      const double off = middle - strip.from;
      if (off - girth_ * std::floor(off / girth_) >= strip.to - strip.from) continue;
      uses.emplace_back(border.edges[i], true);
      cut.push_back(border.edges[i]);
    }
  }
  if (uses.size() == ours) return {{uses}};
  std::ranges::sort(cut);
  const auto is_hole = [&](const Brep::Loop& loop) {
    return std::ranges::all_of(
        loop, [&](const Use& use) { return std::ranges::binary_search(cut, use.first); });
  };
  std::vector<std::vector<Brep::Loop>> out;
  const auto loops = traced(uses, solid);
  for (const auto& loop : loops)
    if (!is_hole(loop)) out.push_back({loop});
  for (const auto& loop : loops) {
    if (!is_hole(loop)) continue;
    const auto& p = solid.vertices[begin_of(loop.front(), solid)];
    for (auto& face : out)
      if (out.size() == 1 || is_round(face.front(), strip.across, p, solid)) {
        face.push_back(loop);
        break;
      }
  }
  return out;
}

}  // namespace tubecut::api
