#include "core/part/webs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/base/elementary.hpp"
#include "core/base/stop.hpp"
#include "core/math/rotation.hpp"
#include "core/part/wall_line.hpp"

namespace tubecut::part {
namespace {

/// One of the two walls, developed.
struct Wall {
  double radius;
  bool outer;

  [[nodiscard]] WallLine of(const bevel::Hole& hole) const {
    const auto& phi = outer ? hole.phi : hole.phi_inner;
    const auto& z = outer ? hole.z : hole.z_inner;
    std::vector<WallPoint> out;
    for (std::size_t i = 0; i < phi.size(); ++i) out.emplace_back(radius * phi[i], z[i]);
    return {std::move(out), true};
  }
  /// An end's edge, once round and as far again to both sides: as far as a hole's phases go.
  [[nodiscard]] WallLine of(const bevel::Table& end) const {
    std::vector<WallPoint> out;
    const auto& z = outer ? end.z_outer : end.z_inner;
    for (const double turn : {-kTwoPi, 0.0, kTwoPi})
      for (std::size_t i = 0; i < z.size(); ++i)
        out.emplace_back(radius * (end.phi[i] + turn), z[i]);
    return {std::move(out), false};
  }
  [[nodiscard]] EdgePoint place(const WallPoint& p) const {
    return {math::whole_turn(p.x() / radius), p.y()};
  }
};

/// Finds the narrowest webs on both surfaces.
class Search {
 public:
  Search(const Part& part) : part_(part) {}

  void on(const Wall& wall, Webs& out) const {
    std::vector<WallLine> holes;
    for (const auto& placed : part_.holes) {
      if (stopped()) return;
      holes.push_back(wall.of(placed.hole));
    }
    between(wall, holes, out);
    for (const bool finish : {false, true}) to_end(wall, holes, finish, out);
    to_seam(wall, holes, out);
  }

 private:
  static void keep(const WallWay& way, const Wall& wall, Web web, std::optional<Web>& best) {
    if (way.length == kFar || (best && best->width <= way.length)) return;
    web.width = way.length;
    web.radius = wall.radius;
    web.from = wall.place(way.from);
    web.to = wall.place(way.to);
    best = web;
  }

  void between(const Wall& wall, const std::vector<WallLine>& holes, Webs& out) const {
    for (std::size_t i = 0; i < holes.size(); ++i)
      for (std::size_t j = i + 1; j < holes.size(); ++j) {
        WallWay best{.length = out.between_holes ? out.between_holes->width : kFar};
        bool shorter = false;
        for (int turn = -2; turn <= 2; ++turn) {
          const WallPoint by(turn * kTwoPi * wall.radius, 0.0);
          if (stopped() || !(holes[i].box().apart(holes[j].box(), by) < best.length)) continue;
          const double before = best.length;
          if (nested(holes[i], holes[j], by))
            best = {0.0, holes[j].points().front(), holes[j].points().front()};
          else
            holes[i].shorten(holes[j], by, best);
          shorter = shorter || best.length < before;
        }
        if (shorter) keep(best, wall, {.hole = i, .other = j}, out.between_holes);
      }
  }

  void to_end(const Wall& wall, const std::vector<WallLine>& holes, bool finish, Webs& out) const {
    const auto& table = (finish ? part_.finish : part_.start).table;
    const part::Edge edge{table.phi, wall.outer ? table.z_outer : table.z_inner};
    if (stopped()) return;
    const auto end = wall.of(table);
    for (std::size_t i = 0; i < holes.size() && !stopped(); ++i) {
      WallWay best{.length = out.to_end ? out.to_end->width : kFar};
      const double before = best.length;
      // Beyond the cut, no wall is left.
      const auto p = holes[i].points().front();
      const auto there = edge.at(p.x() / wall.radius);
      if (finish ? p.y() >= there.low : p.y() <= there.high)
        best = {0.0, p, p};
      else if (holes[i].box().apart(end.box(), WallPoint::Zero()) < best.length)
        holes[i].shorten(end, WallPoint::Zero(), best);
      if (best.length < before)
        keep(best, wall, {.hole = i, .beside = finish ? Beside::finish : Beside::start},
             out.to_end);
    }
  }

  static void to_seam(const Wall& wall, const std::vector<WallLine>& holes, Webs& out) {
    const double girth = kTwoPi * wall.radius;
    for (std::size_t i = 0; i < holes.size(); ++i) {
      const double least = holes[i].box().least.x(), most = holes[i].box().most.x();
      const double next = girth * std::ceil(least / girth);
      const double way = next <= most ? 0.0 : std::min(next - most, least - (next - girth));
      if (!out.to_seam || way < out.to_seam->girth) out.to_seam = {way, i};
    }
  }

  const Part& part_;
};

}  // namespace

const std::optional<Web>& Webs::narrowest() const {
  const bool end = to_end && (!between_holes || to_end->width < between_holes->width);
  return end ? to_end : between_holes;
}

Webs webs(const PartSpec& spec, const Part& part) {
  Webs out;
  const Search search(part);
  search.on({spec.target.outer_radius, true}, out);
  search.on({spec.target.inner_radius(), false}, out);
  return out;
}

}  // namespace tubecut::part
