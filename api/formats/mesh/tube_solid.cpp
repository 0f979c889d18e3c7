#include "api/formats/mesh/tube_solid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "api/formats/step/tube_seams.hpp"
#include "api/stop.hpp"
#include "core/base/angle.hpp"
#include "core/base/elementary.hpp"
#include "core/math/rotation.hpp"

namespace tubecut::api {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using RowPosition = WallCurve::RowPosition;

constexpr double kApart = 3e-4;  // mm along a cut: nearer places are one
/// If few rows are corners, a corner is a vertex of both edges, some 0.6 kB; else it is within
/// them, and the file also has the edges on their cylinders, some 0.1 kB a row.
constexpr std::size_t kRowsPerCorner = 6;

/// An edge used by a face.
using Use = std::pair<std::size_t, bool>;

/// A point of a cut at which some or all of its edges have a vertex.
struct Station {
  RowPosition position;
  double along = 0.0;
  std::vector<bool> vertex;                              // of each edge
  bool across = false;                                   // the wall is parted here by a line
  std::vector<std::pair<std::size_t, std::size_t>> met;  // seam, edge
};

/// A cut wall as it lies in the solid.
struct LaidWall {
  const std::string& name;
  std::size_t wall, edges;
  bool along;  // its rows run counter-clockwise round the kept metal below them, seen from outside
  std::vector<Station> stations;
  std::vector<std::vector<std::size_t>> at, span;  // vertex at, edge behind, [edge][station]
};

struct Seam {
  double phi = 0.0;
  std::array<std::vector<std::size_t>, 2> met;  // vertices on the bore, on the outside
};

class Builder {
 public:
  Builder(double inner, double outer, const std::vector<TubeCut>& cuts)
      : radius_{inner, outer}, cuts_(cuts) {}

  TubeSolid build() {
    out_.wall = radius_[1] - radius_[0];
    const auto phi = tube_seams(radius_[0], radius_[1], cuts_);
    for (const std::size_t s : {0U, 1U}) seams_[s].phi = phi[s];
    for (const auto& cut : cuts_) {
      ask();
      if (const auto* z = std::get_if<double>(&cut.shape))
        add_plane(cut, *z);
      else
        add_wall(cut, std::get<WallCurve>(cut.shape));
    }
    for (const std::size_t side : {1U, 0U}) add_cylinder(side);
    return std::move(out_);
  }

 private:
  void add_plane(const TubeCut& cut, double z);
  void add_wall(const TubeCut& cut, const WallCurve& curve);
  [[nodiscard]] std::vector<Station> stations(const TubeCut& cut, const WallCurve& curve) const;
  void lay_edges(LaidWall& wall);
  void rule_faces(const LaidWall& wall);
  [[nodiscard]] std::size_t knot(const LaidWall& wall, std::size_t station) const;
  void add_seams(std::size_t side);
  struct Region {
    std::size_t right = 0;  // the seam to its right, as it goes up
    std::vector<std::size_t> border;
  };
  struct Regions {
    std::vector<Region> halves, holes;  // holes: those that no seam meets
  };
  [[nodiscard]] Regions regions(std::size_t side) const;
  [[nodiscard]] TubeSolid::Loop loop(std::size_t side, const Region& region) const;
  [[nodiscard]] std::size_t around(std::size_t side, const Regions& all, const Region& hole) const;
  void add_cylinder(std::size_t side);
  std::size_t vertex(const Vector3d& p) {
    out_.vertices.push_back(p);
    return out_.vertices.size() - 1;
  }
  std::size_t edge(std::size_t from, std::size_t to, decltype(TubeSolid::Edge::curve) curve) {
    out_.edges.push_back({from, to, curve});
    return out_.edges.size() - 1;
  }
  [[nodiscard]] std::size_t head(const Use& use) const {
    const auto& e = out_.edges[use.first];
    return use.second ? e.to : e.from;
  }
  [[nodiscard]] std::size_t tail(const Use& use) const { return head({use.first, !use.second}); }

  std::array<double, 2> radius_;
  const std::vector<TubeCut>& cuts_;
  TubeSolid out_;
  std::array<Seam, 2> seams_;
  struct Border {
    Use use;
    bool cut;  // else a seam
    std::size_t seam;
  };
  std::array<std::vector<Border>, 2> borders_;  // counter-clockwise as seen from outside
};

/// The same loop seen from the other side.
void flip(TubeSolid::Loop& loop) {
  std::ranges::reverse(loop);
  for (auto& use : loop) use.second = !use.second;
}

void Builder::add_plane(const TubeCut& cut, double z) {
  const bool start = cut.kind == TubeCut::Kind::start;
  TubeSolid::Face face{
      .name = cut.name, .surface = TubeSolid::Plane{z}, .same = !start, .cut = true, .loops = {}};
  for (const std::size_t side : {1U, 0U}) {
    std::array<std::size_t, 2> at{};
    for (const std::size_t s : {0U, 1U}) {
      const auto [sin, cos] = elementary::sincos(seams_[s].phi);
      at[s] = vertex({radius_[side] * cos, radius_[side] * sin, z});
      seams_[s].met[side].push_back(at[s]);
    }
    TubeSolid::Loop loop;
    for (const std::size_t s : {0U, 1U}) {
      const auto arc = edge(at[s], at[1 - s], TubeSolid::Arc{radius_[side], z});
      borders_[side].push_back({{arc, start}, true, 0});
      loop.emplace_back(arc, side == 1 ? !start : start);
    }
    face.loops.push_back(std::move(loop));
  }
  out_.faces.push_back(std::move(face));
}

/// Adds two points at which the wall of a hole is split, far from each other and from all others.
void part_across(const WallCurve& curve, std::vector<Station>& out) {
  for (int part = 0; part < 2; ++part) {
    double best = -1.0;
    RowPosition position;
    for (std::size_t i = 0; i < curve.rows(); ++i) {
      double clear = curve.around();
      for (const auto& other : out) {
        const double d = std::abs(curve.along({i, 0.0}) - other.along);
        clear = std::min({clear, d, curve.around() - d});
      }
      if (clear <= best) continue;
      best = clear;
      position = {i, 0.0};
    }
    out.push_back(
        {position, curve.along(position), std::vector<bool>(curve.edges(), true), true, {}});
  }
}

/// Returns the station at a point, or a new one.
Station& station_at(const WallCurve& curve, const RowPosition& position, bool across,
                    std::vector<Station>& out) {
  const double along = curve.along(position);
  const auto known = std::ranges::find_if(out, [&](const Station& s) {
    const double d = std::abs(s.along - along);
    return std::min(d, curve.around() - d) <= kApart;
  });
  if (known != out.end()) return *known;
  return out.emplace_back(position, along, std::vector<bool>(curve.edges(), across), across,
                          decltype(Station::met){});
}

std::vector<Station> Builder::stations(const TubeCut& cut, const WallCurve& curve) const {
  std::vector<Station> out;
  const bool hole = cut.kind == TubeCut::Kind::hole;
  for (const std::size_t seam : {0U, 1U})
    for (const std::size_t k : {std::size_t{0}, curve.edges() - 1})
      for (const auto& position : curve.crossings(k, seams_[seam].phi)) {
        auto& station = station_at(curve, position, !hole, out);
        station.vertex[k] = true;
        station.met.emplace_back(seam, k);
      }
  if (hole) part_across(curve, out);
  const auto corners = curve.corners();
  if (corners.size() * kRowsPerCorner <= curve.rows())
    for (const auto& corner : corners) {
      auto& station = station_at(curve, corner, false, out);
      station.vertex.front() = station.vertex.back() = true;
    }
  std::ranges::sort(out, {}, &Station::along);
  // Begins at a point at which every edge has a vertex.
  std::ranges::rotate(out, std::ranges::find_if(out, &Station::across));
  return out;
}

/// Whether a cut's rows run round the tube's kept wall against the clock, seen from outside.
bool against_the_clock(const TubeCut& cut, const WallCurve& curve) {
  if (cut.kind != TubeCut::Kind::hole) return cut.kind == TubeCut::Kind::start;
  double area = 0.0;
  for (std::size_t i = 0; i < curve.rows(); ++i) {
    const Vector2d a = curve.at(curve.edges() - 1, {i, 0.0});
    const Vector2d b = curve.at(curve.edges() - 1, {(i + 1) % curve.rows(), 0.0});
    area += a.x() * b.y() - a.y() * b.x();
  }
  return area < 0.0;
}

void Builder::add_wall(const TubeCut& cut, const WallCurve& curve) {
  LaidWall wall{.name = cut.name,
                .wall = out_.walls.size(),
                .edges = curve.edges(),
                .along = against_the_clock(cut, curve),
                .stations = stations(cut, curve),
                .at = {},
                .span = {}};
  std::vector<RowPosition> positions;
  for (const auto& s : wall.stations) positions.push_back(s.position);
  out_.walls.push_back(curve.spline(positions));
  lay_edges(wall);
  for (std::size_t s = 0; s < wall.stations.size(); ++s)
    for (const auto& [seam, k] : wall.stations[s].met)
      seams_[seam].met[k == 0 ? 0 : 1].push_back(wall.at[k][s]);
  rule_faces(wall);
}

std::size_t Builder::knot(const LaidWall& wall, std::size_t station) const {
  const auto& spline = out_.walls[wall.wall];
  return station < spline.stations.size() ? spline.stations[station] : spline.knots.size() - 1;
}

void Builder::lay_edges(LaidWall& wall) {
  const auto& spline = out_.walls[wall.wall];
  const auto n = wall.stations.size();
  wall.at.assign(wall.edges, std::vector<std::size_t>(n + 1));
  wall.span.assign(wall.edges, std::vector<std::size_t>(n));
  for (std::size_t k = 0; k < wall.edges; ++k) {
    std::vector<std::size_t> with;
    for (std::size_t s = 0; s < n; ++s) {
      if (!wall.stations[s].vertex[k]) continue;
      with.push_back(s);
      wall.at[k][s] = vertex(spline.points[k][spline.knots[spline.stations[s]].control]);
    }
    wall.at[k].back() = wall.at[k].front();
    with.push_back(n);
    for (std::size_t i = 0; i + 1 < with.size(); ++i) {
      const auto from = with[i], to = with[i + 1];
      const TubeSolid::EdgeSpan curve{wall.wall, k, knot(wall, from), knot(wall, to)};
      wall.span[k][from] = edge(wall.at[k][from], wall.at[k][to], curve);
      if (k == 0 || k + 1 == wall.edges)
        borders_[k == 0 ? 0 : 1].push_back({{wall.span[k][from], wall.along}, true, 0});
    }
  }
}

void Builder::rule_faces(const LaidWall& wall) {
  std::vector<std::size_t> across;
  for (std::size_t s = 0; s < wall.stations.size(); ++s)
    if (wall.stations[s].across) across.push_back(s);
  for (std::size_t k = 0; k + 1 < wall.edges; ++k) {
    std::vector<std::size_t> lines;
    for (const auto s : across)
      lines.push_back(edge(wall.at[k][s], wall.at[k + 1][s], TubeSolid::Line{}));
    for (std::size_t i = 0; i < across.size(); ++i) {
      const auto next = (i + 1) % across.size();
      const auto from = across[i], to = next == 0 ? wall.stations.size() : across[next];
      TubeSolid::Loop loop;
      for (auto s = from; s < to; ++s)
        if (wall.stations[s].vertex[k]) loop.emplace_back(wall.span[k][s], true);
      loop.emplace_back(lines[next], true);
      for (auto s = to; s-- > from;)
        if (wall.stations[s].vertex[k + 1]) loop.emplace_back(wall.span[k + 1][s], false);
      loop.emplace_back(lines[i], false);
      if (!wall.along) flip(loop);
      const TubeSolid::Ruled surface{wall.wall, k, knot(wall, from), knot(wall, to)};
      out_.faces.push_back({wall.name, surface, wall.along, true, {std::move(loop)}});
    }
  }
}

void Builder::add_seams(std::size_t side) {
  for (const std::size_t s : {0U, 1U}) {
    auto& met = seams_[s].met[side];
    std::ranges::sort(met, {}, [&](std::size_t v) { return out_.vertices[v].z(); });
    for (std::size_t i = 0; i + 1 < met.size(); i += 2) {
      const auto line = edge(met[i], met[i + 1], TubeSolid::Line{});
      borders_[side].push_back({{line, true}, false, s});
      borders_[side].push_back({{line, false}, false, s});
    }
  }
}

Builder::Regions Builder::regions(std::size_t side) const {
  const auto& borders = borders_[side];
  std::map<std::size_t, std::size_t> cut_from, seam_from;  // a vertex: the border that leaves it
  for (std::size_t i = 0; i < borders.size(); ++i)
    (borders[i].cut ? cut_from : seam_from)[tail(borders[i].use)] = i;
  std::vector<bool> seen(borders.size(), false);
  Regions out;
  for (std::size_t first = 0; first < borders.size(); ++first) {
    if (seen[first]) continue;
    Region region;
    bool island = true;
    for (auto i = first; !seen[i];) {
      ask();
      seen[i] = true;
      region.border.push_back(i);
      const auto& b = borders[i];
      if (!b.cut) {
        island = false;
        region.right = b.use.second ? b.seam : 1 - b.seam;
      }
      const auto at = head(b.use);
      const auto seam = seam_from.find(at);
      i = b.cut && seam != seam_from.end() ? seam->second : cut_from.at(at);
    }
    (island ? out.holes : out.halves).push_back(std::move(region));
  }
  return out;
}

TubeSolid::Loop Builder::loop(std::size_t side, const Region& region) const {
  TubeSolid::Loop out;
  for (const auto i : region.border) out.push_back(borders_[side][i].use);
  if (side == 0) flip(out);
  return out;
}

/// Of the regions of a half, the one around a hole: its border is the next below.
std::size_t Builder::around(std::size_t side, const Regions& all, const Region& hole) const {
  const Vector3d& p = out_.vertices[tail(borders_[side][hole.border.front()].use)];
  const double from_first = math::whole_turn(elementary::atan2(p.y(), p.x()) - seams_[0].phi);
  const std::size_t right = from_first < seams_[1].phi - seams_[0].phi ? 1 : 0;
  double best = -std::numeric_limits<double>::infinity();
  std::size_t out = 0;
  for (std::size_t r = 0; r < all.halves.size(); ++r) {
    if (all.halves[r].right != right) continue;
    double below = -std::numeric_limits<double>::max();
    for (const auto i : all.halves[r].border) {
      const double z = out_.vertices[tail(borders_[side][i].use)].z();
      if (z < p.z()) below = std::max(below, z);
    }
    if (below > best) {
      best = below;
      out = r;
    }
  }
  return out;
}

void Builder::add_cylinder(std::size_t side) {
  add_seams(side);
  const auto all = regions(side);
  const auto first = out_.faces.size();
  const double half = 0.5 * (seams_[0].phi + seams_[1].phi);  // between the first and the second
  for (const auto& region : all.halves)
    out_.faces.push_back(
        {.name = side == 1 ? "outside" : "bore",
         .surface = TubeSolid::Cylinder{radius_[side], region.right == 1 ? half + kPi : half},
         .same = side == 1,
         .cut = false,
         .loops = {loop(side, region)}});
  for (const auto& hole : all.holes)
    out_.faces[first + around(side, all, hole)].loops.push_back(loop(side, hole));
}

}  // namespace

TubeSolid tube_solid(double inner, double outer, const std::vector<TubeCut>& cuts) {
  return Builder(inner, outer, cuts).build();
}

}  // namespace tubecut::api
